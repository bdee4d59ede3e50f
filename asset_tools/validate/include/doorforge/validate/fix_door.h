// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// One fault that was mended, or would be.
struct Fix {
  std::string code;
  std::string where;  ///< It is the finding's.
  std::string done;   ///< With numbers.
};

struct FixReport {
  std::filesystem::path folder;
  std::vector<Fix> fixes;
  /// Findings that are left, and why those of fixable rules are.
  std::vector<Finding> left;
  bool written = false;
};

enum class FixMode { kWrite, kDryRun };

/// Mends what ValidationRule::fixable names in a folder of a door or a part:
///
/// - MSH006, MSH007, COL002 in the folder's own meshes: triangles turned, degenerate ones dropped,
/// a
///   collision shape replaced by its convex hull if that adds at most 5 % to its volume;
/// - INR001 to INR004: centre and inertia of uniform density from the meshes, the mass as it is, or
///   of the usual construction where there is none;
/// - MEC001, MEC005: axes normalised, the limits that `doorforge compose` writes;
/// - URD: model.urdf written again from door.json, whatever else it held.
///
/// Hashes of changed meshes are written again, too. The folder is replaced as a whole, and only if
/// the mended copy has no fault that the old one did not have; in a dry run the copy is thrown
/// away. Both need to write beside the folder. A mesh pool is never written to: other doors share
/// it.
///
/// Throws Error(kMissing) if the folder holds no record, Error(kIo) if it cannot be written.
FixReport FixFolder(const std::filesystem::path& folder, FixMode mode);

}  // namespace doorforge
