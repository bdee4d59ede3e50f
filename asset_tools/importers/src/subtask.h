// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/schemas/names.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge::internal {

/// One of the seven task modules of UniDoorManip.
struct Subtask {
  std::string name;  ///< "LeverDoor", ...
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;
};

/// Name of an object's folder, also for "." and paths that end in a slash.
std::string ObjectNameOf(const std::filesystem::path& folder);

/// `category` decides if given, else the folder that the object lies in, else mesh names and ids.
/// Throws Error(kInvalidArgument) if `category` is no category or none of these tells.
Subtask SubtaskOf(const std::filesystem::path& folder, const UrdfModel& model,
                  const std::string& category);

}  // namespace doorforge::internal
