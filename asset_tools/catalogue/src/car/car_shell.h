// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "car/car_leaf.h"

namespace doorforge::internal {

enum class CarStyle { kSedan, kHatch, kCoupe, kRoadster, kVan, kPickup, kBox };

/// The body of the car around a leaf, on its wheels.
struct CarShellShape {
  double width_m = 1.75;       ///< Across the car, along x.
  double nose_m = 1.2;         ///< From the hinge line to the front end.
  double nose_top_m = 0.66;    ///< Height of the bonnet's front edge.
  double tail_top_m = 0.85;    ///< Height of the rear end: boot lid, bed wall, cargo box.
  double wheel_m = 0.31;       ///< Radius of the wheels.
  double clearance_m = 0.2;    ///< Under the body.
  double nose_taper_m = 0.09;  ///< The sides draw in by this much at both ends.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("width_m", self.width_m);
    visit("nose_m", self.nose_m);
    visit("nose_top_m", self.nose_top_m);
    visit("tail_top_m", self.tail_top_m);
    visit("wheel_m", self.wheel_m);
    visit("clearance_m", self.clearance_m);
    visit("nose_taper_m", self.nose_taper_m);
  }
};

/// Length of every car with its shell [m], as the released objects are scaled.
inline constexpr double kCarLengthM = 4.0;

/// Throws Error(kInvalidConfig) on a number out of range or one that does not fit the leaf.
void CheckCarShell(const CarShellShape& shell, const CarLeafShape& leaf, const std::string& path);

/// Leaves the leaf's place free, with gaps that it clears when it swings.
Solid CarShellSolid(CarStyle style, const CarShellShape& shell, const CarLeafShape& leaf);

}  // namespace doorforge::internal
