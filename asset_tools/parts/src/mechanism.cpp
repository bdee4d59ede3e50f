// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/mechanism.h"

#include <numbers>

namespace doorforge {
namespace {

double UnlockFraction(Category category) {
  switch (category) {
    case Category::kWindow:
    case Category::kSafe:
      return 0.5;
    case Category::kCar:
      return 0.9;
    case Category::kInterior:
    case Category::kStorageFurniture:
    case Category::kRefrigerator:
      break;
  }
  return 0.65;
}

}  // namespace

double HandleRange(Category category) {
  const double degrees = category == Category::kCar ? 10 : 45;
  return degrees * std::numbers::pi / 180;
}

Latch LatchOf(Category category, Mechanism mechanism, double handle_range_rad) {
  Latch latch;
  if (mechanism == Mechanism::kNone) {
    latch.lock_effort_nm = 0;
    latch.handle_spring_nm_per_rad = 0;
    return latch;
  }
  latch.type = LatchType::kEffort;
  latch.unlock_angle_rad = UnlockFraction(category) * handle_range_rad;
  latch.handle_done_angle_rad = (category == Category::kCar ? 0.95 : 0.75) * handle_range_rad;
  return latch;
}

}  // namespace doorforge
