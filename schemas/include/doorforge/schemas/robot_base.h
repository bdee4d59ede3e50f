// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/core/named_enum.h"

namespace doorforge {

/// What the arm stands on, or the hand flies on.
enum class RobotBase {
  kSliders,   ///< Two sliders of 1 m to each side carry it, as in UniDoorManip.
  kFixed,     ///< It is bolted to the floor.
  kYaw,       ///< The sliders carry a turntable, and that the arm.
  kFloating,  ///< There is no arm: three sliders and three turns carry the hand itself.
};
inline constexpr NamedValue<RobotBase> kRobotBases[] = {{RobotBase::kSliders, "sliders"},
                                                        {RobotBase::kFixed, "fixed"},
                                                        {RobotBase::kYaw, "yaw"},
                                                        {RobotBase::kFloating, "floating"}};
constexpr std::span<const NamedValue<RobotBase>> ValuesOf(RobotBase) { return kRobotBases; }

}  // namespace doorforge
