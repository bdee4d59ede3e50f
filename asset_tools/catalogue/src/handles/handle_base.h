// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "family.h"

namespace doorforge::internal {

/// What is fixed to the leaf under a lever or a knob.
struct RoseParameters {
  /// "round", "square", "octagon", "oval", "plate" (a long plate), "stadium" (its ends are half
  /// circles), "tablet" (its corners are cut), "lens" (an ellipse) or "none".
  std::string shape = "round";
  double width_m = 0.052;     ///< Along y.
  double height_m = 0.22;     ///< Only a plate, stadium, tablet or lens has it; it is along z.
  double center = -0.14;      ///< Their middle is so far above the axis, as a share of the height.
  std::string face = "flat";  ///< "flat", "domed" or "stepped".
  double thickness_m = 0.009;
  bool keyhole = false;  ///< A plate's cylinder boss below the handle.
  /// "none", "cylinder" or "thumb_turn": on the plate, or on an escutcheon of its own.
  std::string lock = "none";
  double lock_drop_m = 0.075;  ///< From the axis down to the lock; negative: above it.
  std::string finish = "brushed_steel";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("shape", self.shape);
    visit("width_m", self.width_m);
    visit("height_m", self.height_m);
    visit("center", self.center);
    visit("face", self.face);
    visit("thickness_m", self.thickness_m);
    visit("keyhole", self.keyhole);
    visit("lock", self.lock);
    visit("lock_drop_m", self.lock_drop_m);
    visit("finish", self.finish);
  }
};

/// Adds the piece "rose" and returns the x at which the grip may begin.
double AddRose(const RoseParameters& rose, const std::string& path, Part& part);

/// Grasp pose at a point: approach against x, fingers closing along z (levers, knobs) or along y
/// (vertical bars).
enum class Closing { kVertical, kHorizontal };
RigidTransform GraspAt(const Eigen::Vector3d& position_m, Closing closing);

/// Turns about x through the mount from 0 to 45 degrees (UniDoorManip's override), or not at all.
PartJoint HandleJoint(bool turns);

}  // namespace doorforge::internal
