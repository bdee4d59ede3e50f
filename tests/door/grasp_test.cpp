// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/grasp.h"

#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "small_parts.h"

namespace doorforge {
namespace {

// approach along -x, fingers closing along z, at this point
RigidTransform GraspAt(const Eigen::Vector3d& point) {
  RigidTransform grasp = Translation(point);
  grasp.linear() << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  return grasp;
}

const TriangleMesh& Bar() {
  // 12 cm along y, 2 cm high, 1.5 cm deep, its middle 5 cm in front of the leaf
  static const TriangleMesh kBar = BoxMesh({0.0425, -0.12, -0.01}, {0.0575, 0, 0.01});
  return kBar;
}

TEST(Grasp, ABarBetweenThePadsHolds) {
  const GraspFit fit = MeasureGrasp(Bar(), Bar(), GraspAt({0.05, -0.06, 0}));
  EXPECT_TRUE(fit.holds);
  EXPECT_NEAR(fit.width_m, 0.02, 1e-9);
  EXPECT_NEAR(fit.off_center_m, 0, 1e-9);
  EXPECT_NEAR(fit.tip_clearance_m, 0.041, 1e-9);
  EXPECT_GT(fit.contact, 0.8);
}

TEST(Grasp, EmptyAirABlockedFingerAndTheLeafDoNotHold) {
  EXPECT_FALSE(MeasureGrasp(Bar(), Bar(), GraspAt({0.05, 0.05, 0})).holds);
  const TriangleMesh wide = BoxMesh({0.04, -0.05, -0.05}, {0.06, 0.05, 0.05});
  EXPECT_FALSE(MeasureGrasp(wide, wide, GraspAt({0.05, 0, 0})).holds);
  const GraspFit at_leaf = MeasureGrasp(Bar(), Bar(), GraspAt({0.008, -0.06, 0}));
  EXPECT_LT(at_leaf.tip_clearance_m, 0);
  EXPECT_FALSE(at_leaf.holds);
  // something of the handle where a finger goes
  const TriangleMesh handle = Together(Bar(), BoxMesh({0, -0.08, 0.045}, {0.1, -0.04, 0.05}));
  EXPECT_FALSE(MeasureGrasp(Bar(), handle, GraspAt({0.05, -0.06, 0})).fingers_free);
}

TEST(Grasp, AMeshThatIsFarTooLargeIsRefusedAndNotCut) {
  for (const double far : {343598.0, 1e9, 1e300}) {
    const TriangleMesh plate = BoxMesh({0.2, -far, -far}, {0.21, far, far});
    const TriangleMesh handle = Together(Bar(), plate);
    try {
      MeasureGrasp(Bar(), handle, GraspAt({0.05, -0.06, 0}));
      ADD_FAILURE() << far << " m were cut into columns";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      EXPECT_NE(std::string(error.what()).find("30000000 allowed"), std::string::npos);
    }
  }
  // what a door may have at most still is measured
  const TriangleMesh large = Together(Bar(), BoxMesh({0.2, -5, -5}, {0.21, 5, 5}));
  EXPECT_TRUE(MeasureGrasp(Bar(), Bar(), GraspAt({0.05, -0.06, 0})).holds);
  EXPECT_FALSE(MeasureGrasp(Bar(), large, GraspAt({0.05, -0.06, 0})).fingers_free);
}

TEST(Grasp, AGraspFarFromEverythingHoldsNothing) {
  for (const double far : {1e6, 1e12, 1e300})
    EXPECT_FALSE(MeasureGrasp(Bar(), Bar(), GraspAt({0.05, far, 0})).holds);
}

TEST(Grasp, AHoldingProposalIsKeptButCentred) {
  const RefinedGrasp refined = RefineGrasp(Bar(), Bar(), GraspAt({0.05, -0.06, 0.006}));
  EXPECT_TRUE(refined.fit.holds);
  EXPECT_NEAR(refined.part_from_grasp.translation().z(), 0, 1e-3);
  EXPECT_LT(refined.moved_m, 0.01);
  EXPECT_EQ(refined.turned_rad, 0);
  // 6 cm of bar to one side, 6 to the other, of which the pads need some
  EXPECT_GT(refined.half_extent_m.x(), 0.03);
  EXPECT_NEAR(refined.half_extent_m.y(), 0.028, 0.003);
}

TEST(Grasp, AProposalBesideTheMaterialIsMovedOntoIt) {
  const RefinedGrasp refined = RefineGrasp(Bar(), Bar(), GraspAt({0.05, 0.03, 0}));
  EXPECT_TRUE(refined.fit.holds);
  EXPECT_LT(refined.part_from_grasp.translation().y(), 0.002);
}

TEST(Grasp, AProposalAlongTheLongSideIsTurned) {
  // an upright plate: 9 cm high, 1 cm wide; fingers that close along z cannot span it
  const TriangleMesh plate = BoxMesh({0.02, -0.005, -0.045}, {0.06, 0.005, 0.045});
  const RefinedGrasp refined = RefineGrasp(plate, plate, GraspAt({0.05, 0, 0}));
  EXPECT_TRUE(refined.fit.holds);
  EXPECT_NEAR(std::abs(refined.turned_rad), std::numbers::pi / 2, 0.27);
  EXPECT_LT(refined.fit.width_m, 0.02);
}

TEST(Grasp, NothingToHoldIsReported) {
  const TriangleMesh block = BoxMesh({0, -0.1, -0.1}, {0.06, 0.1, 0.1});
  EXPECT_FALSE(RefineGrasp(block, block, GraspAt({0.05, 0, 0})).fit.holds);
}

}  // namespace
}  // namespace doorforge
