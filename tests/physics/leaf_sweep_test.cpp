// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/leaf_sweep.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "primitive_door.h"

namespace doorforge {
namespace {

/// A leaf of 0.04 x 1 x 1 m that turns about z at its corner towards x > 0, without a handle.
DoorAsset Plate() {
  DoorAsset door;
  const TriangleMesh leaf = BoxMesh({-0.04, 0, 0}, {0, 1, 1});
  door.links[kLeafLink].geometry.push_back({"leaf", leaf, {leaf}});
  door.hinge.axis = -Eigen::Vector3d::UnitZ();
  door.hinge.upper_rad = std::numbers::pi / 2;
  return door;
}

void AddFrame(const std::string& name, const TriangleMesh& box, DoorAsset& door) {
  door.links[kBaseLink].geometry.push_back({name, box, {box}});
}

TEST(LeafSweep, FindsNothingWhereTheWayIsFree) {
  DoorAsset door = Plate();
  AddFrame("behind", BoxMesh({-0.2, -0.1, 0}, {-0.041, 1.1, 1}), door);
  AddFrame("beside", BoxMesh({-0.04, 1.002, 0}, {0.04, 1.1, 1}), door);
  const LeafSweep sweep = SweepLeaf(door);
  EXPECT_EQ(sweep.closed.depth_m, 0);
  EXPECT_EQ(sweep.opening.depth_m, 0);
  EXPECT_TRUE(sweep.opening.moving.empty());
}

// At 90 degrees the leaf's front lies in the plane y = 0, and what it covers lies at y > 0.
TEST(LeafSweep, MeasuresHowDeepTheOpenLeafGoes) {
  DoorAsset door = Plate();
  AddFrame("wall", BoxMesh({0.9, -1, 0}, {1.5, 0.015, 1}), door);
  const LeafSweep sweep = SweepLeaf(door);
  EXPECT_EQ(sweep.closed.depth_m, 0);
  EXPECT_NEAR(sweep.opening.depth_m, 0.015, 1e-5);
  EXPECT_NEAR(sweep.opening.hinge_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(sweep.opening.moving, "leaf");
  EXPECT_EQ(sweep.opening.fixed, "wall");
}

TEST(LeafSweep, CountsWhatOverlapsOnTheClosedDoorApart) {
  DoorAsset door = Plate();
  AddFrame("rebate", BoxMesh({-0.1, 0.5, 0.2}, {-0.033, 1.1, 0.8}), door);
  const LeafSweep sweep = SweepLeaf(door);
  EXPECT_NEAR(sweep.closed.depth_m, 0.007, 1e-5);
  EXPECT_EQ(sweep.closed.fixed, "rebate");
  EXPECT_LT(sweep.opening.depth_m, 1e-5);
}

TEST(LeafSweep, MovesTheHandleToo) {
  DoorAsset door = Plate();
  // a bar that hangs down from its axis and turns up towards y > 1
  const TriangleMesh bar = BoxMesh({0.04, -0.01, -0.1}, {0.05, 0.01, 0});
  door.links[kHandleLink].geometry.push_back({"grip", bar, {bar}});
  door.handle_joint.parent_from_child_at_zero = Translation({0, 0.95, 0.5});
  door.handle_joint.axis = Eigen::Vector3d::UnitX();
  door.handle_joint.upper_rad = std::numbers::pi / 2;
  AddFrame("stop", BoxMesh({-0.2, 1.02, 0}, {0.2, 1.3, 1}), door);
  const SweepOverlap found = SweepLeaf(door).opening;
  EXPECT_EQ(found.moving, "grip");
  EXPECT_EQ(found.fixed, "stop");
  EXPECT_EQ(found.hinge_rad, 0);
  EXPECT_GT(found.depth_m, 0.005);
}

}  // namespace
}  // namespace doorforge
