// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/surface_deviation.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

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

}  // namespace
}  // namespace doorforge
