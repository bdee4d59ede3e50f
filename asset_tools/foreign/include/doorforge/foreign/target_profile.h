// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/core/named_enum.h"

namespace doorforge {

/// A program that a file is for, with demands beyond its format's.
enum class TargetProfile { kNone, kMujoco, kIsaac, kGazebo, kSapien };
inline constexpr NamedValue<TargetProfile> kTargetProfiles[] = {{TargetProfile::kNone, "none"},
                                                                {TargetProfile::kMujoco, "mujoco"},
                                                                {TargetProfile::kIsaac, "isaac"},
                                                                {TargetProfile::kGazebo, "gazebo"},
                                                                {TargetProfile::kSapien, "sapien"}};
constexpr std::span<const NamedValue<TargetProfile>> ValuesOf(TargetProfile) {
  return kTargetProfiles;
}

}  // namespace doorforge
