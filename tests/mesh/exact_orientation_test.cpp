// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/exact_orientation.h"

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

// The same with fractions all along.
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

}  // namespace
}  // namespace doorforge
