// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/mesh/convex_parts.h"

#include "convex/convex_region.h"
#include "convex/exact_side.h"
#include "convex/growing_hull.h"

namespace doorforge {
namespace {

using Whole = std::array<std::int64_t, 3>;

Eigen::Vector3d AsPoint(const Whole& p, double unit = 1) {
  return {static_cast<double>(p[0]) * unit, static_cast<double>(p[1]) * unit,
          static_cast<double>(p[2]) * unit};
}

// exact for whole numbers up to 2^40
int WholeSide(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  using Wide = __int128;
  Wide m[3][3];
  for (int i = 0; i < 3; ++i) {
    m[0][i] = b[static_cast<std::size_t>(i)] - a[static_cast<std::size_t>(i)];
    m[1][i] = c[static_cast<std::size_t>(i)] - a[static_cast<std::size_t>(i)];
    m[2][i] = d[static_cast<std::size_t>(i)] - a[static_cast<std::size_t>(i)];
  }
  const Wide det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                   m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det > 0 ? 1 : (det < 0 ? -1 : 0);
}

Whole Drawn(Rng& rng, std::uint64_t size) {
  const auto number = [&] {
    return static_cast<std::int64_t>(rng.Index(2 * size + 1)) - static_cast<std::int64_t>(size);
  };
  return {number(), number(), number()};
}

TEST(SideOfPlane, IsThatOfWholeNumbersAlsoWhereDoublesRound) {
  Rng rng(7, "side");
  int in_plane = 0;
  int close = 0;
  for (int i = 0; i < 20000; ++i) {
    const Whole a = Drawn(rng, 1U << 30);
    const Whole b = Drawn(rng, 1U << 30);
    const Whole c = Drawn(rng, 1U << 30);
    // in the plane, or one off it
    Whole d;
    for (std::size_t k = 0; k < 3; ++k) d[k] = b[k] + c[k] - a[k];
    d[2] += static_cast<std::int64_t>(rng.Index(3)) - 1;
    const int side = WholeSide(a, b, c, d);
    EXPECT_EQ(SideOfPlane(AsPoint(a), AsPoint(b), AsPoint(c), AsPoint(d)), side);
    (side == 0 ? in_plane : close) += 1;
  }
  EXPECT_GT(in_plane, 5000);
  EXPECT_GT(close, 5000);
}

TEST(SideOfPlane, IsRightOneUnitInTheLastPlaceOff) {
  const Eigen::Vector3d a(0.1, 0.1, 0.1), b(0.7, 0.1, 0.1), c(0.1, 0.9, 0.1);
  const double above = std::nextafter(0.1, 1.0);
  EXPECT_EQ(SideOfPlane(a, b, c, {0.3, 0.3, 0.1}), 0);
  EXPECT_EQ(SideOfPlane(a, b, c, {0.3, 0.3, above}), 1);
  EXPECT_EQ(SideOfPlane(a, c, b, {0.3, 0.3, above}), -1);
}

// a grid so small that most points share planes, lines and places
TEST(ConvexHull, OfPointsThatShareFacesHoldsThemAllAndIsConvex) {
  Rng rng(11, "hull");
  for (int round = 0; round < 300; ++round) {
    const std::uint64_t size = 1 + rng.Index(4);
    std::vector<Whole> places;
    for (std::size_t i = 0; i < 8 + rng.Index(60); ++i) places.push_back(Drawn(rng, size));
    std::vector<Eigen::Vector3d> points;
    for (const Whole& place : places) points.push_back(AsPoint(place));
    TriangleMesh hull;
    try {
      hull = ConvexHull(points);
    } catch (const Error&) {
      continue;  // all in one plane
    }
    const auto closed = ClosedMesh::From(hull);
    ASSERT_TRUE(closed.has_value());
    const auto whole = [&](int i) {
      const Eigen::Vector3d& v = hull.vertices[static_cast<std::size_t>(i)];
      return Whole{std::llround(v.x()), std::llround(v.y()), std::llround(v.z())};
    };
    for (const Eigen::Vector3i& t : hull.triangles) {
      for (const Whole& place : places)
        ASSERT_LE(WholeSide(whole(t[0]), whole(t[1]), whole(t[2]), place), 0) << round;
    }
    std::vector<Eigen::Vector3d> turned(points.rbegin(), points.rend());
    const TriangleMesh again = ConvexHull(turned);
    EXPECT_EQ(again.vertices, hull.vertices) << round;
    EXPECT_EQ(again.triangles, hull.triangles) << round;
  }
}

TEST(ConvexHull, OfAPrismHasNoVertexWithinAnEdge) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 10; ++i) {
    for (const double z : {0.0, 1.0}) {
      points.emplace_back(0.1 * i, 0, z);
      points.emplace_back(0.1 * i, 2, z);
    }
  }
  const TriangleMesh hull = ConvexHull(points);
  EXPECT_EQ(hull.vertices.size(), 8U);
  EXPECT_EQ(hull.triangles.size(), 12U);
}

// round, so that most points lie near the hull of a few of them
TEST(GrownHull, LeavesNoPointOutByTwiceItsTolerance) {
  Rng rng(13, "grown");
  for (int round = 0; round < 60; ++round) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < 500; ++i) {
      const Eigen::Vector3d way(rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1));
      points.push_back(way.normalized().cwiseProduct(Eigen::Vector3d(0.5, 0.2, 0.1)));
    }
    for (const double tolerance_m : {0.0, 1e-3, 5e-3}) {
      const auto hull = GrownHull(points, tolerance_m);
      ASSERT_TRUE(hull.has_value());
      ASSERT_TRUE(ClosedMesh::From(*hull).has_value());
      for (const HalfSpace& face : HalfSpacesOf(*hull)) {
        for (const Eigen::Vector3d& point : points)
          ASSERT_LE(face.normal.dot(point) - face.offset, 2 * tolerance_m + 1e-12) << round;
      }
      if (tolerance_m == 5e-3) {
        EXPECT_LT(hull->vertices.size(), 200U);
      }
    }
  }
}

}  // namespace
}  // namespace doorforge
