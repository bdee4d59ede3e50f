// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace doorforge {

inline constexpr int kSplitSchemaVersion = 2;  ///< 2: `validation`, which may be absent.

/// Which parts are trained on and which are held out, as ids. No part is on two sides, so a door of
/// one side shares neither body nor handle with a door of another.
struct Split {
  std::string schema;
  int schema_version = 0;
  std::vector<std::string> train;
  std::vector<std::string> validation;  ///< Settings are chosen by these, and by no others.
  std::vector<std::string> test;        ///< They are of categories that are trained on.
  std::vector<std::string>
      unseen_categories;  ///< They are of categories that are never trained on.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("schema", self.schema);
    visit("schema_version", self.schema_version);
    visit("train", self.train);
    visit("validation", self.validation);
    visit("test", self.test);
    visit("unseen_categories", self.unseen_categories);
  }
};

/// Reads a YAML or JSON file of schema "doorforge.split". Throws Error(kMissing), Error(kFormat) on
/// another schema or version, or Error(kInvalidConfig) on an unknown key or a part named twice.
Split ReadSplit(const std::filesystem::path& path);

/// The sides by the names that `--split FILE:SIDE` takes: train, validation, test and
/// unseen_categories.
std::map<std::string, const std::vector<std::string>*> SidesOf(const Split& split);

/// All ids, sorted.
std::vector<std::string> PartsOf(const Split& split);

}  // namespace doorforge
