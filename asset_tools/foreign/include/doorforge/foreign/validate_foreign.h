// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "doorforge/foreign/target_profile.h"
#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// How files from outside are checked.
struct ForeignChecks {
  /// Nothing outside is opened; empty: the nearest folder above a file with package.xml,
  /// model.config or .git, else the folder in which the file was found, else its own.
  std::filesystem::path root = {};
  /// What package://NAME/ and model://NAME/ stand for, beside folders of that name above the file.
  std::map<std::string, std::filesystem::path> packages = {};
  std::string hinge = {};   ///< Joint; empty: it is looked for.
  std::string handle = {};  ///< Link; empty: it is looked for.
  /// Programs that are asked as well: "urdfdom", "mujoco", "sdformat", "assimp".
  std::vector<std::string> ask = {"urdfdom", "mujoco", "sdformat", "assimp"};
  TargetProfile target = TargetProfile::kNone;  ///< PRF is asked for it.
};

/// Checks files of URDF, MJCF, SDF, USDA, GLB, glTF and meshes that others made.
///
/// Readers are strict about the text and go on where they can, so that a report has every fault. A
/// file is judged by its content and ending. Findings have their place as numbers
/// (Finding::place). Whatever a file holds, nothing is thrown: a file that cannot be read is
/// finding FIL001, one that takes more than the time of a WorkBudget around the call FIL012.
/// Meshes that several files name are measured once. Deterministic; for several threads.
class ForeignValidator {
 public:
  explicit ForeignValidator(ForeignChecks checks = {});
  ~ForeignValidator();
  ForeignValidator(const ForeignValidator&) = delete;
  ForeignValidator& operator=(const ForeignValidator&) = delete;

  /// The report's `folder` is the file's path; its `kind` is "urdf", "mjcf", "sdf", "usda", "gltf",
  /// "mesh" or "unknown".
  /// `searched` is the folder in which the file was found; it may be empty.
  ValidationReport Validate(const std::filesystem::path& file,
                            const std::filesystem::path& searched = {}) const;

 private:
  struct Memory;

  ForeignChecks checks_;
  std::unique_ptr<Memory> memory_;
};

/// Files at or below a folder that Validate() reads, sorted; a file stands for itself. Folders of
/// doors and parts, and those whose name begins with a dot, are left out. Files of URDF, MJCF, SDF
/// and USD stand for the meshes that they name; where there is none, meshes stand for themselves.
/// Throws Error(kIo) where the folder cannot be searched; nothing there is an empty answer.
std::vector<std::filesystem::path> FindForeignFiles(const std::filesystem::path& path);

}  // namespace doorforge
