// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/surface_deviation.h"

#include <array>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/mesh/solid_overlap.h"

#include "measure/triangle_tree.h"
#include "shapes.h"

namespace doorforge {
namespace {

TriangleMesh Sheet(double z) {
  return {{{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(SurfaceDeviation, OfParallelSheetsIsTheirDistance) {
  const SurfaceDeviation deviation = DeviationOf(Sheet(0), Sheet(0.25));
  EXPECT_NEAR(deviation.mean_m, 0.25, 1e-15);
  EXPECT_NEAR(deviation.max_m, 0.25, 1e-15);
  EXPECT_NEAR(deviation.samples, 4000, 2);
}

TEST(SurfaceDeviation, OfASurfaceToItselfIsZero) {
  EXPECT_LT(DeviationOf(Torus(1, 0.3, 40, 20), Torus(1, 0.3, 40, 20)).max_m, 1e-15);
}

TEST(SurfaceDeviation, OfADoubledSheetIsTheMeanOverItsArea) {
  // the half beyond x = 1 lies 0..1 from the unit sheet: mean 1/4 over both, largest 1 at the
  // corner
  TriangleMesh wide = Sheet(0);
  for (Eigen::Vector3d& vertex : wide.vertices) vertex.x() *= 2;
  const SurfaceDeviation deviation = DeviationOf(wide, Sheet(0));
  EXPECT_NEAR(deviation.mean_m, 0.25, 2e-3);
  EXPECT_EQ(deviation.max_m, 1);
}

TEST(SurfaceDeviation, LeavesOutWhatNoRayFromOutsideReaches) {
  const TriangleMesh outer = UnitBox();
  const TriangleMesh nested =
      Together(outer, Box(Eigen::Vector3d(0.4, 0.4, 0.4), Eigen::Vector3d(0.6, 0.6, 0.6)));
  EXPECT_GT(DeviationOf(nested, outer).max_m, 0.35);
  const SurfaceDeviation visible = DeviationOf(nested, outer, {.visible_only = true});
  EXPECT_LT(visible.max_m, 1e-12);
  EXPECT_GT(visible.samples, 3000);
}

TEST(SurfaceDeviation, NeedsASurfaceToMeasureTo) {
  EXPECT_THROW(DeviationOf(UnitBox(), {}), Error);
}

TEST(SurfaceDeviation, OfNothingHasNoSamples) { EXPECT_EQ(DeviationOf({}, UnitBox()).samples, 0); }

double OverlapOf(const RigidTransform& pose, const TriangleMesh& region) {
  const SolidOverlap solids(UnitBox(), UnitBox());
  const std::vector<Eigen::Vector3d> surface = solids.CommonSurface(pose, {&region, 1}, 0.02);
  for (const Eigen::Vector3d& point : surface)
    EXPECT_TRUE((point.array() > -1e-9).all() && (point.array() < 1 + 1e-9).all());
  return LeastExtent(surface, {});
}

// what two boxes have in common is a box
TEST(SolidOverlap, IsAsWideAsTheCommonVolume) {
  const TriangleMesh everywhere = Box({-2, -2, -2}, {3, 3, 3});
  EXPECT_NEAR(OverlapOf(Translation({0.9, 0.301, 0.202}), everywhere), 0.1, 1e-9);
  EXPECT_NEAR(OverlapOf(Translation({0.5, -0.301, 0.8}), everywhere), 0.2, 1e-9);
  EXPECT_EQ(OverlapOf(Translation({1.01, 0, 0}), everywhere), 0);
}

TEST(SolidOverlap, CountsWithinTheRegionAlone) {
  const RigidTransform pose = Translation({0.9, 0.301, 0.202});
  EXPECT_EQ(OverlapOf(pose, Box({-1, -1, -1}, {0.89, 2, 2})), 0);
  EXPECT_NEAR(OverlapOf(pose, Box({0, 0, 0.51}, {2, 2, 0.55})), 0.04, 0.021);
}

// the regions' faces are the surfaces themselves, moved by a rounding error
TEST(SolidOverlap, CountsSurfacesThatLieOnTheRegionsFaces) {
  const double rounding_m = 1e-7;
  const TriangleMesh region =
      Box({0.9, 0.301, 0.202}, {1 - rounding_m, 1 - rounding_m, 1 - rounding_m});
  EXPECT_NEAR(OverlapOf(Translation({0.9 - rounding_m, 0.301, 0.202}), region), 0.1, 1e-3);
}

// turned by an eighth, a box comes into the other with an edge of (sqrt 2 - 1) / 2 beyond its face
TEST(SolidOverlap, FollowsTheMovingSolid) {
  RigidTransform pose = Translation({1.5 + 0.1, 0.5, 0.1});
  pose.linear() = Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitZ()).matrix();
  pose.translation() -= pose.linear() * Eigen::Vector3d(0.5, 0.5, 0);
  EXPECT_NEAR(OverlapOf(pose, Box({-2, -2, -2}, {3, 3, 3})), (std::sqrt(2.0) - 1) / 2 - 0.1, 2e-3);
}

// Points of a lattice that holds corners, edges and faces of the unit box, beside others.
std::vector<Eigen::Vector3d> Lattice() {
  std::vector<Eigen::Vector3d> points;
  for (int x = -2; x <= 10; ++x) {
    for (int y = -2; y <= 10; ++y) {
      for (int z = -2; z <= 10; ++z) points.push_back(Eigen::Vector3d(x, y, z) / 8);
    }
  }
  return points;
}

// The answer of rays against the sum over all triangles.
TEST(TriangleTree, TellsInsideAsTheWindingNumberDoes) {
  const TriangleMesh cavity = InsideOut(Box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}));
  TriangleMesh sliver = UnitBox();  // a triangle without area on an edge
  sliver.triangles.emplace_back(0, 1, 1);
  for (const TriangleMesh& mesh : {UnitBox(), Together(UnitBox(), cavity),
                                   Together(UnitBox(), Box({0.5, 0.4, 0.3}, {2, 1, 1})),
                                   Torus(0.7, 0.3, 48, 24), sliver, TriangleMesh{}}) {
    SCOPED_TRACE(mesh.triangles.size());
    const TriangleTree tree(mesh);
    int inside = 0;
    for (const Eigen::Vector3d& point : Lattice()) {
      EXPECT_EQ(tree.IsInside(point), tree.WindingNumber(point) > 0.5) << point.transpose();
      inside += tree.IsInside(point) ? 1 : 0;
    }
    EXPECT_EQ(inside > 0, !mesh.triangles.empty());
  }
}

// Rays that meet edges and corners head on.
TEST(TriangleTree, TellsInsideWhereTheRayMeetsACorner) {
  const TriangleTree tree(Torus(0.7, 0.3, 48, 24));
  const TriangleMesh torus = Torus(0.7, 0.3, 48, 24);
  const Eigen::Vector3d ray = Eigen::Vector3d(0.8377, 0.4211, 0.3479).normalized();
  for (std::size_t i = 0; i < torus.vertices.size(); i += 7) {
    const Eigen::Vector3d middle = (torus.vertices[i] + torus.vertices[i + 1]) / 2;
    for (const double back_m : {0.0, 0.05, 0.4, 1.1}) {
      for (const Eigen::Vector3d& target : {torus.vertices[i], middle}) {
        const Eigen::Vector3d point = target - back_m * ray;
        EXPECT_EQ(tree.IsInside(point), tree.WindingNumber(point) > 0.5);
      }
    }
  }
}

// A bar in a slab comes out below, by 30 mm; its own surface is 10 mm wide.
TEST(SolidOverlap, AlongALineIsAsDeepAsASmallSolidLiesInALargeOne) {
  const TriangleMesh slab = Box({0, 0, 0}, {1, 1, 0.1});
  const TriangleMesh bar = Box({0.4, 0.4, 0.02}, {0.6, 0.41, 0.03});
  const std::array<TriangleMesh, 2> pieces = {slab, bar};
  const SolidOverlap solids(slab, bar);
  const RigidTransform still = RigidTransform::Identity();
  const std::vector<Eigen::Vector3d> common = solids.CommonSurface(still, pieces, 0.012);
  EXPECT_NEAR(LeastExtent(common, {}), 0.01, 1e-9);
  for (const double sign : {1.0, -1.0})
    EXPECT_NEAR(solids.DepthAlong(still, pieces, {0, 0, sign}, common), 0.03, 1e-9);
}

// Two plates whose piece spans the air between them: only the plate that the bar is in counts.
TEST(SolidOverlap, AlongALineEndsWhereTheSolidDoes) {
  const TriangleMesh plates =
      Together(Box({0, 0, 0}, {1, 1, 0.01}), Box({0, 0, 0.09}, {1, 1, 0.1}));
  const TriangleMesh bar = Box({0.4, 0.4, 0.007}, {0.6, 0.41, 0.06});
  const std::array<TriangleMesh, 2> pieces = {Box({0, 0, 0}, {1, 1, 0.1}), bar};
  const SolidOverlap solids(bar, plates);
  const std::array<TriangleMesh, 2> swapped = {pieces[1], pieces[0]};
  const RigidTransform still = RigidTransform::Identity();
  const std::vector<Eigen::Vector3d> common = solids.CommonSurface(still, swapped, 0.012);
  ASSERT_FALSE(common.empty());
  // the bar leaves the pieces below, by 60 mm: of these 53 are its own, 7 the plate's
  EXPECT_NEAR(solids.DepthAlong(still, swapped, {0, 0, 1}, common), 0.06, 1e-9);
  const std::array<TriangleMesh, 2> thin = {bar, Box({0, 0, 0}, {1, 1, 0.01})};
  EXPECT_NEAR(solids.DepthAlong(still, thin, {0, 0, 1}, common), 0.003, 1e-9);
}

}  // namespace
}  // namespace doorforge
