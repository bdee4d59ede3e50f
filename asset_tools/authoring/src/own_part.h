// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/importers/foreign_object.h"
#include "doorforge/schemas/part.h"

namespace doorforge {

/// A handle or body that a user has as something `doorforge import` reads.
struct OwnPartRequest {
  std::filesystem::path source;  ///< A mesh file, a URDF, a folder of some data set.
  PartRole role = PartRole::kHandle;
  Category category = Category::kInterior;  ///< It is made for doors of this category.
  LooseMeshConfig mesh = {};                ///< Its role is not looked at.
};

/// That part, imported into a hidden folder that is gone with this object unless it was moved.
class OwnPart {
 public:
  /// @param beside The hidden folder is made in the folder of this path.
  /// @param max_seconds As ImportConfig::max_seconds.
  /// @throws Error(kMissing) if the source is not there or holds nothing that import reads;
  ///     Error(kInvalidArgument or kFormat) with import's message, or if it holds none or several
  ///     of the role, or a handle that is not as long as handles are.
  OwnPart(const OwnPartRequest& request, const std::filesystem::path& beside, double max_seconds);
  OwnPart(const OwnPart&) = delete;
  OwnPart& operator=(const OwnPart&) = delete;

  const Part& part() const { return part_; }
  /// What was assumed, and how large the part came out; for people.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Puts the part's folder there; nothing may be there yet.
  void MoveTo(const std::filesystem::path& folder);

 private:
  void Import(const OwnPartRequest& request, double max_seconds);
  void CheckLength() const;

  StagedBatch scratch_;  // never committed
  std::filesystem::path folder_;
  Part part_;
  std::vector<std::string> notes_;
};

}  // namespace doorforge
