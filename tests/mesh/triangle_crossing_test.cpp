// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/triangle_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace doorforge {
namespace {

using LatticePoint = Eigen::Matrix<long, 3, 1>;
using LatticeTriangle = std::array<LatticePoint, 3>;

long SideOfLattice(const LatticeTriangle& plane, const LatticePoint& point) {
  return (plane[1] - plane[0]).cross(plane[2] - plane[0]).dot(point - plane[0]);
}

int SignOf(long value) { return (value > 0) - (value < 0); }

// In whole numbers, so without rounding: whether the segment, which does not lie in the triangle's
// plane, has a point of it.
bool SegmentMeets(const LatticePoint& p, const LatticePoint& q, const LatticeTriangle& t) {
  const int from = SignOf(SideOfLattice(t, p)), to = SignOf(SideOfLattice(t, q));
  if (from * to > 0 || (from == 0 && to == 0)) return false;
  bool left = false, right = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = SignOf(SideOfLattice({p, q, t[k]}, t[(k + 1) % 3]));
    left = left || side > 0;
    right = right || side < 0;
  }
  return !(left && right);
}

bool EdgesMeet(const LatticeTriangle& s, const LatticeTriangle& t, std::size_t first) {
  for (std::size_t k = first; k < 3; ++k) {
    // with a common corner 0 the edge across from it alone
    const std::size_t from = first == 0 ? k : 1, to = first == 0 ? (k + 1) % 3 : 2;
    if (SegmentMeets(s[from], s[to], t)) return true;
  }
  return false;
}

CornerTriangle AtCorners(const LatticeTriangle& triangle, std::array<int, 3> corners) {
  CornerTriangle made{corners, {}};
  for (std::size_t k = 0; k < 3; ++k) made.points[k] = triangle[k].cast<double>();
  return made;
}

bool IsFlatLattice(const LatticeTriangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).isZero(); }

// Many triangles with small whole corners touch in a point or along a line.
TEST(TrianglesCross, AgreesWithWholeNumbers) {
  std::mt19937 random(7);
  std::uniform_int_distribution<long> number(-3, 3);
  const auto triangle = [&] {
    LatticeTriangle made;
    do {
      for (LatticePoint& corner : made) corner = {number(random), number(random), number(random)};
    } while (IsFlatLattice(made));
    return made;
  };
  int crossing = 0, apart = 0;
  for (int i = 0; i < 40'000; ++i) {
    const LatticeTriangle s = triangle();
    LatticeTriangle t = triangle();
    const std::size_t common = i % 2;
    if (common == 1) t[0] = s[0];
    const bool in_one_plane = std::all_of(t.begin(), t.end(), [&](const LatticePoint& corner) {
      return SideOfLattice(s, corner) == 0;
    });
    if (in_one_plane || IsFlatLattice(t)) continue;
    const bool cross = EdgesMeet(s, t, common) || EdgesMeet(t, s, common);
    const std::array<int, 3> corners_t = {common == 1 ? 0 : 3, 4, 5};
    ASSERT_EQ(TrianglesCross(AtCorners(s, {0, 1, 2}), AtCorners(t, corners_t)), cross) << i;
    ASSERT_EQ(TrianglesCross(AtCorners(t, corners_t), AtCorners(s, {0, 1, 2})), cross) << i;
    ++(cross ? crossing : apart);
  }
  EXPECT_GT(crossing, 5000);
  EXPECT_GT(apart, 5000);
}

TEST(TrianglesCross, TellsInOnePlaneWhetherTheyOverlap) {
  const CornerTriangle low{{0, 1, 2}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
  const CornerTriangle within{{3, 4, 5}, {{{0.2, 0.2, 0}, {0.4, 0.2, 0}, {0.2, 0.4, 0}}}};
  const CornerTriangle beside{{3, 4, 5}, {{{2, 0, 0}, {3, 0, 0}, {2, 1, 0}}}};
  const CornerTriangle hinged{{1, 0, 3}, {{{1, 0, 0}, {0, 0, 0}, {0, -1, 0}}}};
  const CornerTriangle folded{{1, 0, 3}, {{{1, 0, 0}, {0, 0, 0}, {0.1, 1, 0}}}};
  EXPECT_TRUE(TrianglesCross(low, within));
  EXPECT_FALSE(TrianglesCross(low, beside));
  EXPECT_FALSE(TrianglesCross(low, hinged));
  EXPECT_TRUE(TrianglesCross(low, folded));
  EXPECT_TRUE(TrianglesCross(low, low));
}

TEST(TrianglesCross, KeepsSheetsApartThatLieNearerThanRounding) {
  const CornerTriangle sheet{{0, 1, 2}, {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}};
  CornerTriangle other{{3, 4, 5}, sheet.points};
  EXPECT_TRUE(TrianglesCross(sheet, other));
  for (Eigen::Vector3d& point : other.points) point.z() = std::nextafter(1.0, 2.0);
  EXPECT_FALSE(TrianglesCross(sheet, other));
}

TEST(IsLine, IsExact) {
  CornerTriangle triangle{{0, 1, 2}, {{{0, 0, 0}, {0.5, 0.5, 0.5}, {1, 1, 1}}}};
  EXPECT_TRUE(IsLine(triangle));
  triangle.points[1].x() = std::nextafter(0.5, 1.0);
  EXPECT_FALSE(IsLine(triangle));
}

}  // namespace
}  // namespace doorforge
