// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/cut_surface.h"

#include <array>

#include <gtest/gtest.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/rng.h"

#include "shapes.h"

namespace doorforge {
namespace {

CutSurface SurfaceOfMesh(const TriangleMesh& mesh) {
  CutSurface surface;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    for (int k = 0; k < 3; ++k)
      corners[static_cast<std::size_t>(k)] = mesh.vertices[static_cast<std::size_t>(t[k])];
    surface.AddPolygon(corners, 1);
  }
  surface.Weld();
  return surface;
}

const CutSurface::IsNotedFor kNone = [](const Eigen::Vector3d&) { return false; };

TEST(CutSurface, HasAllOfItsAreaOnItsTwoSides) {
  const TriangleMesh torus = Torus(0.5, 0.2, 24, 16);
  const double area_m2 = MeasureTopology(torus).area_m2;
  Rng rng(5, "cut");
  for (int round = 0; round < 50; ++round) {
    const CutSurface surface = SurfaceOfMesh(torus);
    const int axis = static_cast<int>(rng.Index(3));
    const AxisCut cut{axis, rng.Uniform(axis == 2 ? -0.19 : -0.6, axis == 2 ? 0.19 : 0.6)};
    double sum_m2 = 0;
    for (const int sign : {-1, 1}) {
      CutSurface::SideContent content;
      surface.FindSide({cut, sign}, 0, kNone, content);
      sum_m2 += content.area_m2;
      for (const Eigen::Vector3d& point : content.points)
        EXPECT_GE(sign * (point[axis] - cut.position_m), 0);
      // what is made of it holds the same points
      const CutSurface side = surface.Side({cut, sign}, 0, kNone);
      const Eigen::AlignedBox3d box = [&] {
        Eigen::AlignedBox3d around;
        for (const Eigen::Vector3d& point : content.points) around.extend(point);
        return around;
      }();
      for (const Eigen::Vector3d& point : side.points()) EXPECT_TRUE(box.contains(point));
    }
    EXPECT_NEAR(sum_m2, area_m2, 1e-12);
  }
}

TEST(CutSurface, LeavesTheSkinOfTheOtherSideOut) {
  const CutSurface box = SurfaceOfMesh(UnitBox());
  CutSurface::SideContent content;
  // the face at x = 1 reaches a thousandth beyond the cut, and its wall far behind it
  box.FindSide({{0, 0.999}, 1}, 0.002, kNone, content);
  EXPECT_LT(content.area_m2, 0.01);
  box.FindSide({{0, 0.999}, 1}, 0.0005, kNone, content);
  EXPECT_GT(content.area_m2, 1);
}

}  // namespace
}  // namespace doorforge
