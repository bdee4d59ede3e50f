// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/collapse_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/mesh/surface_deviation.h"

#include "measure/mesh_pieces.h"
#include "repair/surface_operations.h"
#include "shapes.h"

namespace doorforge {
namespace {

// Every vertex of a box's faces, `n` squares along each edge; faces are welded by place.
TriangleMesh FineBox(const Eigen::Vector3d& size, int n) {
  TriangleMesh soup;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const auto at = [&](int i, int k) {
        Eigen::Vector3d unit;
        unit[axis] = side;
        unit[(axis + 1) % 3] = static_cast<double>(i) / n;
        unit[(axis + 2) % 3] = static_cast<double>(k) / n;
        soup.vertices.push_back(size.cwiseProduct(unit));
        return static_cast<int>(soup.vertices.size()) - 1;
      };
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          const int a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
          if (side == 1) {
            soup.triangles.insert(soup.triangles.end(), {{a, b, c}, {a, c, d}});
          } else {
            soup.triangles.insert(soup.triangles.end(), {{a, c, b}, {a, d, c}});
          }
        }
      }
    }
  }
  return Welded(soup, 1e-9);
}

TEST(Reduced, LeavesTheTwelveTrianglesOfABox) {
  const TriangleMesh fine = FineBox({1, 0.5, 0.02}, 12);
  ASSERT_EQ(fine.triangles.size(), 12U * 12 * 12);
  const TriangleMesh box = Reduced(fine, 12, 0);
  EXPECT_EQ(box.triangles.size(), 12U);
  EXPECT_EQ(box.vertices.size(), 8U);
  EXPECT_TRUE(ClosedMesh::From(box));
  EXPECT_NEAR(MeasureTopology(box).volume_m3, 0.01, 1e-9);
  EXPECT_NEAR(MeasureTopology(box).area_m2, 2 * (0.5 + 0.02 + 0.01), 1e-9);
}

TEST(Reduced, StopsWhereTheErrorIsNoLongerFree) {
  const TriangleMesh fine = FineBox({1, 0.5, 0.02}, 12);
  // what lies in a plane or on an edge costs nothing, at any number of triangles
  EXPECT_LE(Reduced(fine, 10'000, 1e-3).triangles.size(), 40U);
  EXPECT_EQ(Reduced(fine, 10'000, 0).triangles.size(), fine.triangles.size());
}

TEST(Reduced, KeepsATorusATorusNearItself) {
  const TriangleMesh fine = Torus(1, 0.3, 120, 60);
  const TriangleMesh coarse = Reduced(fine, 1500, 0);
  EXPECT_LE(coarse.triangles.size(), 1500U);
  EXPECT_GE(coarse.triangles.size(), 1490U);
  ASSERT_TRUE(ClosedMesh::From(coarse));
  // V - E + F = 0, and three edges for two triangles
  EXPECT_EQ(2 * coarse.vertices.size(), coarse.triangles.size());
  for (const Eigen::Vector3d& vertex : coarse.vertices) {
    const double to_ring = std::hypot(std::hypot(vertex.x(), vertex.y()) - 1, vertex.z());
    EXPECT_NEAR(to_ring, 0.3, 5e-3);
  }
  const double volume = 2 * std::numbers::pi * std::numbers::pi * 0.09;
  EXPECT_NEAR(MeasureTopology(coarse).volume_m3, volume, 0.01 * volume);
}

TEST(Reduced, StopsWhereTheTopologyDoes) {
  const TriangleMesh least = Reduced(Torus(1, 0.3, 24, 12), 4, 0);
  EXPECT_TRUE(ClosedMesh::From(least));
  EXPECT_GE(least.triangles.size(), 14U);  // no torus has fewer (Moebius, Csaszar)
  EXPECT_EQ(2 * least.vertices.size(), least.triangles.size());
}

TEST(Reduced, GivesTheSameBytesTwice) {
  const TriangleMesh fine = Torus(1, 0.3, 60, 30);
  const TriangleMesh a = Reduced(fine, 600, 1e-4);
  const TriangleMesh b = Reduced(fine, 600, 1e-4);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Reduced, KeepsAMeshThatIsSmallEnough) {
  const TriangleMesh torus = Torus(1, 0.3, 8, 6);
  EXPECT_EQ(Reduced(torus, 96, 0).triangles.size(), torus.triangles.size());
  EXPECT_NEAR(MeasureTopology(Reduced(torus, 96, 0)).volume_m3, MeasureTopology(torus).volume_m3,
              1e-12);
  EXPECT_TRUE(Reduced({}, 4, 0).triangles.empty());
}

TEST(Reduced, LeavesWhatDoesNotMoveToTheBit) {
  TriangleMesh torus = Torus(1, 0.3, 8, 6);
  for (Eigen::Vector3d& vertex : torus.vertices) vertex += Eigen::Vector3d(0.1, 2.7, 31.3);
  const auto sorted = [](std::vector<Eigen::Vector3d> vertices) {
    std::sort(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) {
      return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    });
    return vertices;
  };
  EXPECT_EQ(sorted(Reduced(torus, 96, 0).vertices), sorted(torus.vertices));
}

// Flush boards that are turned a little before they are united leave triangles that are nearly
// lines. Where such a line kept collapses away, others farther off the surface were made.
TEST(ReducedWithoutCrossings, IsNotHeldUpBySlivers) {
  std::vector<TriangleMesh> boards;
  for (int i = 0; i < 12; ++i) {
    const double at = 0.1 * i;
    boards.push_back(Box({at, 0, 0}, {at + 0.1, 0.5, 0.02}));
    boards.push_back(Box({0, 0.04 * i, 0.02}, {1.2, 0.04 * i + 0.02, 0.04}));
  }
  const std::optional<TriangleMesh> whole =
      United(boards, {.shift_m = 3e-5, .turns = true, .seed = 5});
  ASSERT_TRUE(whole);
  constexpr int kTarget = 1000;
  ASSERT_GT(whole->triangles.size(), 6U * kTarget);
  const TriangleMesh simple = ReducedWithoutCrossings(*whole, kTarget, 0);
  EXPECT_LE(simple.triangles.size(), static_cast<std::size_t>(kTarget));
  EXPECT_LT(DeviationOf(simple, *whole, {.samples = 20'000}).max_m, 1e-4);
  EXPECT_LT(DeviationOf(*whole, simple, {.samples = 20'000}).max_m, 1e-4);
}

}  // namespace
}  // namespace doorforge
