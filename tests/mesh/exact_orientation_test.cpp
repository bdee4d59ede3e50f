// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/exact_orientation.h"

#include <array>
#include <random>
#include <vector>

#include <CGAL/determinant.h>
#include <gtest/gtest.h>

namespace doorforge {
namespace {

using ExactKernel = CGAL::Simple_cartesian<mpq_class>;
using Point = ExactKernel::Point_3;
using Vector = ExactKernel::Vector_3;
using Orientation =
    CGAL::TriangulationProjectionTraitsCartesianFunctors::Projected_orientation_with_normal_3<
        CGAL::Projection_traits_base_3<ExactKernel>>;

using SideOfCircle = CGAL::TriangulationProjectionTraitsCartesianFunctors::
    Projected_side_of_oriented_circle_with_normal_3<CGAL::Projection_traits_base_3<ExactKernel>>;

/// Fractions with small and with large denominators, some of them shared.
class Fractions {
 public:
  mpq_class Next() {
    mpq_class fraction(static_cast<long>(random_() % 41) - 20, kDenominators[random_() % 5]);
    if (random_() % 4 == 0) fraction += mpq_class("1/18446744073709551629");
    fraction.canonicalize();
    return fraction;
  }
  Point NextPoint() { return {Next(), Next(), Next()}; }

 private:
  static constexpr long kDenominators[] = {1, 2, 6, 35, 1024};
  std::mt19937 random_{7};
};

// It computes in fractions what the predicate under test computes in integers.
int SignOf(const Point& p, const Point& q, const Point& r, const Vector& normal) {
  const Vector u = q - p;
  const Vector v = r - p;
  return sgn(CGAL::determinant(u.x(), u.y(), u.z(), v.x(), v.y(), v.z(), normal.x(), normal.y(),
                               normal.z()));
}

TEST(ExactOrientation, HasTheSignOfTheDeterminant) {
  Fractions fractions;
  int signs[3] = {};
  for (int i = 0; i < 4000; ++i) {
    const Vector normal(fractions.Next(), fractions.Next(), fractions.Next());
    const Point p = fractions.NextPoint();
    const Point q = fractions.NextPoint();
    const Point r = fractions.NextPoint();
    const int sign = SignOf(p, q, r, normal);
    ASSERT_EQ(static_cast<int>(Orientation(normal)(p, q, r)), sign) << i;
    ++signs[sign + 1];
  }
  EXPECT_GT(signs[0], 1000);
  EXPECT_GT(signs[2], 1000);
}

TEST(ExactOrientation, IsZeroOnALineAndTellsTheLeastStepFromIt) {
  Fractions fractions;
  for (int i = 0; i < 2000; ++i) {
    const Point p = fractions.NextPoint();
    const Vector way(fractions.Next(), fractions.Next(), fractions.Next());
    const Point q = p + way;
    const mpq_class share = fractions.Next();
    const Point on = p + share * way;
    const Vector normal(fractions.Next(), fractions.Next(), fractions.Next());
    EXPECT_EQ(Orientation(normal)(p, q, on), CGAL::ZERO);
    const mpq_class least("1/170141183460469231731687303715884105728");
    const Point beside = on + least * CGAL::cross_product(normal, way);
    EXPECT_EQ(static_cast<int>(Orientation(normal)(p, q, beside)), SignOf(p, q, beside, normal));
  }
}

// It computes in fractions, too: the points are seen against the normal and lifted to a paraboloid.
int SideOfCircleOf(const std::array<Point, 4>& points, const Vector& normal) {
  std::array<Vector, 3> way;
  std::array<mpq_class, 3> height;
  for (std::size_t i = 0; i < 3; ++i) {
    way[i] = points[i] - points[3];
    height[i] = CGAL::cross_product(way[i], normal).squared_length();
  }
  return sgn(CGAL::determinant(way[0].x(), way[0].y(), way[0].z(), height[0], way[2].x(),
                               way[2].y(), way[2].z(), height[2], way[1].x(), way[1].y(),
                               way[1].z(), height[1], normal.x(), normal.y(), normal.z(),
                               mpq_class(0)));
}

TEST(ExactSideOfCircle, HasTheSignOfTheDeterminant) {
  Fractions fractions;
  int signs[3] = {};
  for (int i = 0; i < 4000; ++i) {
    const Vector normal(fractions.Next(), fractions.Next(), fractions.Next());
    std::array<Point, 4> points;
    for (Point& point : points) point = fractions.NextPoint();
    const int sign = SideOfCircleOf(points, normal);
    const SideOfCircle side(normal);
    ASSERT_EQ(static_cast<int>(side(points[0], points[1], points[2], points[3])), sign) << i;
    ++signs[sign + 1];
  }
  EXPECT_GT(signs[0], 1000);
  EXPECT_GT(signs[2], 1000);
}

// Points in the plane z = 0 at whole-numbered angles of the circle of 25 about a centre, counter-
// clockwise seen from above; moved along the normal, which changes nothing.
TEST(ExactSideOfCircle, IsZeroOnItAndTellsTheLeastStepFromIt) {
  Fractions fractions;
  const mpq_class least("1/170141183460469231731687303715884105728");
  const SideOfCircle side(Vector(0, 0, mpq_class("3/7")));
  for (int i = 0; i < 500; ++i) {
    const mpq_class x = fractions.Next();
    const mpq_class y = fractions.Next();
    const auto at = [&](int dx, int dy) { return Point(x + dx, y + dy, fractions.Next()); };
    const Point p = at(5, 0);
    const Point q = at(3, 4);
    const Point r = at(-4, 3);
    const Point on = at(0, -5);
    EXPECT_EQ(side(p, q, r, on), CGAL::ON_ORIENTED_BOUNDARY);
    const Vector inwards(0, least, 0);
    EXPECT_EQ(side(p, q, r, on + inwards), CGAL::ON_POSITIVE_SIDE);
    EXPECT_EQ(side(p, q, r, on - inwards), CGAL::ON_NEGATIVE_SIDE);
  }
}

}  // namespace
}  // namespace doorforge
