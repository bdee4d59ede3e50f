// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

/// Which of two ways a stage's motion takes where a door's shape does not say it. A door and its
/// mirror image take the same way.
enum class MotionWay {
  kUsual,  ///< The door is pulled; the handle unlocks as a lever goes down.
  kOther,  ///< The door is pushed; the handle unlocks as a lever is lifted.
};
inline constexpr NamedValue<MotionWay> kMotionWays[] = {{MotionWay::kUsual, "usual"},
                                                        {MotionWay::kOther, "other"}};
constexpr std::span<const NamedValue<MotionWay>> ValuesOf(MotionWay) { return kMotionWays; }

constexpr MotionWay Opposite(MotionWay way) {
  return way == MotionWay::kUsual ? MotionWay::kOther : MotionWay::kUsual;
}

/// Which way it is at this door: at the stage "open" by its `opening`; at the stage "handle" by
/// whether a lever's grip goes down, and of other handles by whether they turn as a lever that
/// points to the hinge and goes down. An axis that lies in the leaf, as a flap's, has one way
/// only, kUsual, and so has the stage "grasp".
MotionWay WayOf(const DoorAsset& door, Stage stage);

}  // namespace doorforge
