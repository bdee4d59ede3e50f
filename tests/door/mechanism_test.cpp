// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/mechanism.h"

#include <numbers>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Mechanism, UnlocksAtTheAnglesOfTheReleasedCode) {
  const auto unlock = [](Category category, Mechanism mechanism) {
    return LatchOf(category, mechanism, HandleRange(category)).unlock_angle_rad / kDegree;
  };
  EXPECT_NEAR(unlock(Category::kInterior, Mechanism::kLever), 29.25, 1e-9);
  EXPECT_NEAR(unlock(Category::kInterior, Mechanism::kRound), 29.25, 1e-9);
  EXPECT_NEAR(unlock(Category::kStorageFurniture, Mechanism::kRound), 29.25, 1e-9);
  EXPECT_NEAR(unlock(Category::kRefrigerator, Mechanism::kLever), 29.25, 1e-9);
  EXPECT_NEAR(unlock(Category::kWindow, Mechanism::kLever), 22.5, 1e-9);
  EXPECT_NEAR(unlock(Category::kSafe, Mechanism::kValve), 22.5, 1e-9);
  EXPECT_NEAR(unlock(Category::kCar, Mechanism::kFlap), 9, 1e-9);
}

TEST(Mechanism, HandleDoneLiesBetweenUnlockingAndTheStop) {
  for (const Category category :
       {Category::kInterior, Category::kWindow, Category::kCar, Category::kSafe,
        Category::kStorageFurniture, Category::kRefrigerator}) {
    const double range = HandleRange(category);
    const Latch latch = LatchOf(category, Mechanism::kLever, range);
    EXPECT_GT(latch.handle_done_angle_rad, latch.unlock_angle_rad) << NameOf(category);
    EXPECT_LT(latch.handle_done_angle_rad, range) << NameOf(category);
  }
}

TEST(Mechanism, APlainPullHasNoLatch) {
  const Latch latch = LatchOf(Category::kStorageFurniture, Mechanism::kNone, 0);
  EXPECT_EQ(latch.type, LatchType::kNone);
  EXPECT_DOUBLE_EQ(latch.lock_effort_nm, 0);
}

}  // namespace
}  // namespace doorforge
