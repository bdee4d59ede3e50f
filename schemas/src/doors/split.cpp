// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/split.h"

#include <algorithm>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"

namespace doorforge {

Split ReadSplit(const std::filesystem::path& path) {
  Split split;
  const std::string name = path.string();
  Assign(ParseYaml(ReadFile(path), name), split, name);
  if (split.schema != "doorforge.split" || split.schema_version < 1 ||
      split.schema_version > kSplitSchemaVersion)
    throw Error(ErrorCode::kFormat, name + ": schema is \"" + split.schema + "\" version " +
                                        std::to_string(split.schema_version) +
                                        ", expected \"doorforge.split\" version 1 to " +
                                        std::to_string(kSplitSchemaVersion));
  const std::vector<std::string> ids = PartsOf(split);
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw Error(ErrorCode::kInvalidConfig,
                name + ": part \"" + *twice + "\" is named twice; a part is on one side only");
  return split;
}

std::map<std::string, const std::vector<std::string>*> SidesOf(const Split& split) {
  return {{"train", &split.train},
          {"validation", &split.validation},
          {"test", &split.test},
          {"unseen_categories", &split.unseen_categories}};
}

std::vector<std::string> PartsOf(const Split& split) {
  std::vector<std::string> ids;
  for (const auto& [name, side] : SidesOf(split)) ids.insert(ids.end(), side->begin(), side->end());
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace doorforge
