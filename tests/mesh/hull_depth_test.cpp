// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/hull_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/rng.h"
#include "doorforge/mesh/convex_parts.h"

#include "convex/convex_region.h"
#include "measure/distance_grid.h"
#include "measure/surface_samples.h"
#include "measure/triangle_tree.h"
#include "shapes.h"

namespace doorforge {
namespace {

Eigen::Vector3d Drawn(Rng& rng, const Eigen::Vector3d& size) {
  return Eigen::Vector3d(rng.Uniform(0, 1), rng.Uniform(0, 1), rng.Uniform(0, 1))
      .cwiseProduct(size);
}

TriangleMesh DrawnHull(Rng& rng, const Eigen::Vector3d& size) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 12; ++i) points.push_back(Drawn(rng, size));
  return ConvexHull(points);
}

ClosedMesh Posts() {
  TriangleMesh posts;
  for (const double x : {0.0, 0.4, 0.9}) {
    for (const double y : {0.0, 0.55})
      posts =
          Together(posts, Box(Eigen::Vector3d(x, y, 0), Eigen::Vector3d(x + 0.1, y + 0.05, 0.7)));
  }
  return *ClosedMesh::From(posts);
}

struct MeasuredPosts {
  explicit MeasuredPosts(double cell_m) : solid(posts, cell_m) {}

  ClosedMesh posts = Posts();
  DistanceGrid solid;
  TriangleTree tree{posts.mesh()};
  MeasuredDistances distances{solid, tree};
};

// every cell of the grid is asked
double DeepestOfAll(const TriangleMesh& hull, const DistanceGrid& solid) {
  const std::vector<HalfSpace> faces = HalfSpacesOf(hull);
  double deepest_m = 0;
  for (int k = 0; k < solid.grid().size.z(); ++k) {
    for (int j = 0; j < solid.grid().size.y(); ++j) {
      for (int i = 0; i < solid.grid().size.x(); ++i) {
        const Eigen::Vector3d center = solid.grid().CenterOf(i, j, k);
        if (std::all_of(faces.begin(), faces.end(), [&](const HalfSpace& face) {
              return face.normal.dot(center) <= face.offset;
            }))
          deepest_m = std::max<double>(deepest_m, solid.DistanceAt(i, j, k));
      }
    }
  }
  return deepest_m;
}

TEST(ConcavityOf, IsThatOfTheDeepestOfAllCells) {
  const DistanceGrid solid(Posts(), 0.013);
  Rng rng(3, "depth");
  for (int round = 0; round < 100; ++round) {
    const TriangleMesh hull = DrawnHull(rng, {1.1, 0.7, 0.8});
    const double all_m = DeepestOfAll(hull, solid);
    const Concavity found = ConcavityOf(hull, solid);
    EXPECT_EQ(found.depth_m, all_m);
    EXPECT_EQ(ConcavityOf(hull, solid, {.above_m = all_m}).depth_m, 0);
    EXPECT_EQ(ConcavityOf(hull, solid, {.above_m = 0.9 * all_m}).depth_m, all_m);
    EXPECT_GT(ConcavityOf(hull, solid, {.stop_m = 0.5 * all_m}).depth_m, 0.5 * all_m);
    const Eigen::Vector3i cell = solid.grid().CellAt(found.at_m);
    EXPECT_EQ(solid.DistanceAt(cell.x(), cell.y(), cell.z()), all_m);
  }
}

TEST(ConcavityOf, IsTooLittleByAStepAtMost) {
  const DistanceGrid solid(Posts(), 0.013);
  Rng rng(4, "depth");
  for (int round = 0; round < 100; ++round) {
    const TriangleMesh hull = DrawnHull(rng, {1.1, 0.7, 0.8});
    const double all_m = DeepestOfAll(hull, solid);
    const double step_m = rng.Uniform(0, 0.2);
    const Concavity found = ConcavityOf(hull, solid, {.step_m = step_m});
    EXPECT_LE(found.depth_m, all_m);
    EXPECT_GE(found.depth_m, all_m - step_m);
    const Eigen::Vector3i cell = solid.grid().CellAt(found.at_m);
    EXPECT_EQ(solid.DistanceAt(cell.x(), cell.y(), cell.z()), found.depth_m);
    // what may be left out is not what counts
    EXPECT_GT(ConcavityOf(hull, solid, {.above_m = 0.99 * all_m, .step_m = 1}).depth_m, 0);
  }
}

// The diagonal face of an angle's hull is farthest from the angle in its middle.
TEST(ProtrusionOf, AnAngleIsHalfItsOpening) {
  constexpr double kWall = 0.1;
  const TriangleMesh angle =
      Together(Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, kWall, 0.5)),
               Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(kWall, 1, 0.5)));
  const DistanceGrid solid(*ClosedMesh::From(angle), 0.02);
  const TriangleTree tree(angle);
  MeasuredDistances distances(solid, tree);
  const TriangleMesh hull = ConvexHull(angle.vertices);
  const Concavity found = ProtrusionOf(hull, distances, {.above_m = 0.02}, 0.005);
  EXPECT_NEAR(found.depth_m, (1 - kWall) / 2, 0.03 * found.depth_m + 0.005);
  EXPECT_NEAR(found.at_m.x(), (1 + kWall) / 2, 0.03);
  EXPECT_NEAR(found.at_m.y(), (1 + kWall) / 2, 0.03);
  EXPECT_EQ(ProtrusionOf(hull, distances, {.above_m = 0.5}, 0.005).depth_m, 0);
}

// Drawn hulls against the deepest of many points of their surface.
TEST(ProtrusionOf, IsThatOfTheDeepestPointOfTheSurface) {
  constexpr double kCell = 0.013, kStep = 0.5 * kCell, kAbove = 0.04;
  MeasuredPosts posts(kCell);
  Rng rng(5, "protrusion");
  for (int round = 0; round < 40; ++round) {
    const TriangleMesh hull = DrawnHull(rng, {1.1, 0.7, 0.8});
    double deepest_m = 0;
    for (const Eigen::Vector3d& point : SurfaceSamples(hull, 4000)) {
      const Eigen::Vector3i cell = posts.solid.grid().CellAt(point);
      if (posts.solid.DistanceAt(cell.x(), cell.y(), cell.z()) > 0)
        deepest_m = std::max(deepest_m, posts.distances.At(point));
    }
    const DepthRange range{.above_m = kAbove};
    const double found_m = ProtrusionOf(hull, posts.distances, range, kStep).depth_m;
    EXPECT_GE(found_m, deepest_m > kAbove + kStep ? 0.97 * deepest_m - kStep : 0);
    EXPECT_LE(found_m, 1.05 * deepest_m + 2 * kStep);
    // asked with a depth to stop at, it finds one beyond or all of it
    const double stop_m = 0.8 * found_m;
    const double stopped_m =
        ProtrusionOf(hull, posts.distances, {.above_m = kAbove, .stop_m = stop_m}, kStep).depth_m;
    EXPECT_GE(stopped_m, stop_m);
    EXPECT_LE(stopped_m, 1.03 * found_m + kStep);
  }
}

TEST(MeasuredDistances, AreOffByHalfACellsDiagonalAtMost) {
  constexpr double kCell = 0.02;
  MeasuredPosts posts(kCell);
  Rng rng(8, "distances");
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point = Drawn(rng, {1.0, 0.6, 0.7});
    EXPECT_NEAR(posts.distances.At(point), posts.tree.Distance(point), std::sqrt(0.75) * kCell);
  }
}

TEST(MeasuredDistances, NoPointIsBeyondWhereNoneIsSaidToBe) {
  MeasuredPosts posts(0.013);
  Rng rng(10, "beyond");
  int known = 0, near = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d a = Drawn(rng, {1.0, 0.6, 0.7});
    const auto beside = [&] { return (a + 0.1 * Drawn(rng, {1, 1, 1})).eval(); };
    const std::array<Eigen::Vector3d, 3> corners{a, beside(), beside()};
    const double far_m = rng.Uniform(0.02, 0.3);
    double most_m = 0;
    for (int k = 0; k < 40; ++k) {
      const double u = std::sqrt(rng.Uniform(0, 1));
      const double v = rng.Uniform(0, 1);
      most_m = std::max(most_m, posts.tree.Distance((1 - u) * corners[0] +
                                                    u * (1 - v) * corners[1] + u * v * corners[2]));
    }
    const bool none = posts.distances.NoneBeyond(corners, far_m);
    EXPECT_TRUE(!none || most_m <= far_m);
    known += none;
    near += most_m <= far_m;
  }
  // it knows of most, else it would be of no use
  EXPECT_GT(known, 0.8 * near);
  EXPECT_LT(near, 2500);
}

TEST(MeasuredDistances, NoPointOutsideTheFarCellsIsFar) {
  constexpr double kCell = 0.013;
  MeasuredPosts posts(kCell);
  Rng rng(9, "far");
  for (const double above_m : {0.5, 2.0, 6.0, 12.0}) {
    int left_out = 0;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d point = Drawn(rng, {1.0, 0.6, 0.7});
      const Eigen::Vector3i cell = posts.solid.grid().CellAt(point);
      if (posts.distances.FarCells(above_m * kCell).AnyBetween(cell, cell)) continue;
      const bool in_air = posts.solid.DistanceAt(cell.x(), cell.y(), cell.z()) > 0;
      EXPECT_TRUE(!in_air || posts.distances.At(point) <= above_m * kCell);
      left_out += in_air;
    }
    // beyond two cells and a half diagonal it leaves out what is near
    EXPECT_EQ(left_out > 0, above_m > 3) << above_m;
  }
}

TEST(MarkedCells, AreFoundInAnyBox) {
  const Eigen::Vector3i size(7, 5, 9);
  Rng rng(4, "marked");
  std::vector<char> marked;
  for (int i = 0; i < size.prod(); ++i) marked.push_back(rng.Uniform(0, 1) < 0.02);
  const MarkedCells cells(size, [&](std::size_t index) { return marked[index] != 0; });
  const auto any = [&](const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
    for (int k = low.z(); k <= high.z(); ++k) {
      for (int j = low.y(); j <= high.y(); ++j) {
        for (int i = low.x(); i <= high.x(); ++i) {
          if (marked[static_cast<std::size_t>((k * size.y() + j) * size.x() + i)] != 0) return true;
        }
      }
    }
    return false;
  };
  int found = 0;
  for (int round = 0; round < 2000; ++round) {
    const Eigen::Vector3i a = Drawn(rng, size.cast<double>()).cast<int>();
    const Eigen::Vector3i b = Drawn(rng, size.cast<double>()).cast<int>();
    const bool is_there = cells.AnyBetween(a.cwiseMin(b), a.cwiseMax(b));
    EXPECT_EQ(is_there, any(a.cwiseMin(b), a.cwiseMax(b)));
    found += is_there;
  }
  EXPECT_GT(found, 200);
  EXPECT_LT(found, 1800);
}

}  // namespace
}  // namespace doorforge
