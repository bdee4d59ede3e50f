// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "family.h"

namespace doorforge::internal {

/// What is fixed to the leaf under a lever or a knob.
struct RoseParameters {
  std::string shape = "round";  ///< "round", "square", "plate" (a long plate) or "none".
  double width_m = 0.052;       ///< Along y.
  double height_m = 0.22;       ///< Of a plate only, along z.
  double thickness_m = 0.009;
  bool keyhole = false;  ///< A plate's cylinder boss below the handle.
  std::string finish = "brushed_steel";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("shape", self.shape);
    visit("width_m", self.width_m);
    visit("height_m", self.height_m);
    visit("thickness_m", self.thickness_m);
    visit("keyhole", self.keyhole);
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
