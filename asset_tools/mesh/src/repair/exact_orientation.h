// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <CGAL/Kernel_23/internal/Projection_traits_base_3.h>
#include <CGAL/Simple_cartesian.h>

// A union triangulates each face anew around the points where others cut it. These lie on edges of
// the face, so that intervals decide nothing and the exact predicates are asked for. CGAL computes
// them with fractions, each reduced by a greatest common divisor: most of the time of a union. The
// sign takes none.

#ifdef CGAL_USE_GMPXX
namespace doorforge::exact {

using Fractions = CGAL::Simple_cartesian<mpq_class>;
using Integers = std::array<mpz_class, 3>;

struct OverOne {  // three fractions over one denominator above 0
  Integers numbers;
  mpz_class denominator;
};

inline OverOne OverCommon(const std::array<const mpq_class*, 3>& fractions) {
  OverOne scaled;
  mpz_class& all = scaled.denominator;
  all = fractions[0]->get_den();
  for (std::size_t i = 1; i < 3; ++i) {
    const mpz_class& one = fractions[i]->get_den();
    // mostly they are equal, or one is a multiple of the other
    if (mpz_divisible_p(all.get_mpz_t(), one.get_mpz_t()) != 0) continue;
    if (mpz_divisible_p(one.get_mpz_t(), all.get_mpz_t()) != 0)
      all = one;
    else
      all *= one;
  }
  mpz_class factor;
  for (std::size_t i = 0; i < 3; ++i) {
    mpz_divexact(factor.get_mpz_t(), all.get_mpz_t(), fractions[i]->get_den().get_mpz_t());
    scaled.numbers[i] = fractions[i]->get_num() * factor;
  }
  return scaled;
}

inline OverOne Scaled(const Fractions::Point_3& point) {
  return OverCommon({&point.x(), &point.y(), &point.z()});
}

// From one to the other, times both denominators.
inline Integers Way(const OverOne& from, const OverOne& to) {
  Integers way;
  for (std::size_t i = 0; i < 3; ++i)
    way[i] = to.numbers[i] * from.denominator - from.numbers[i] * to.denominator;
  return way;
}

inline mpz_class Dot(const Integers& u, const Integers& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

inline mpz_class Determinant(const Integers& u, const Integers& v, const Integers& w) {
  mpz_class sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(w[i]) == 0) continue;
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const mpz_class across = u[j] * v[k] - u[k] * v[j];
    sum += w[i] * across;
  }
  return sum;
}

// A direction: times a number above 0.
inline Integers DirectionOf(const Fractions::Vector_3& vector) {
  return OverCommon({&vector.x(), &vector.y(), &vector.z()}).numbers;
}

/// On which side of the line from p to q the point r lies, seen against the normal.
class ProjectedOrientation {
 public:
  using Orientation = Fractions::Orientation;
  using result_type = Orientation;
  using Point = Fractions::Point_3;

  explicit ProjectedOrientation(const Fractions::Vector_3& normal) : normal_(DirectionOf(normal)) {}

  Orientation operator()(const Point& p, const Point& q, const Point& r) const {
    const OverOne first = Scaled(p);
    const mpz_class side = Determinant(Way(first, Scaled(q)), Way(first, Scaled(r)), normal_);
    return static_cast<Orientation>(sgn(side));
  }

 private:
  Integers normal_;
};

/// On which side of the circle through p, q and r the point t lies, seen against the normal.
class ProjectedSideOfCircle {
 public:
  using Oriented_side = Fractions::Oriented_side;
  using result_type = Oriented_side;
  using Point = Fractions::Point_3;

  explicit ProjectedSideOfCircle(const Fractions::Vector_3& normal)
      : normal_(DirectionOf(normal)), squared_(Dot(normal_, normal_)) {}

  Oriented_side operator()(const Point& p, const Point& q, const Point& r, const Point& t) const {
    const OverOne from = Scaled(t);
    const Lifted a = LiftedOf(from, p);
    const Lifted b = LiftedOf(from, q);
    const Lifted c = LiftedOf(from, r);
    const mpz_class side = a.height * Determinant(b.way, c.way, normal_) -
                           b.height * Determinant(a.way, c.way, normal_) +
                           c.height * Determinant(a.way, b.way, normal_);
    return static_cast<Oriented_side>(sgn(side));
  }

 private:
  // The way to a point times its denominator, and the square of what of it lies across the normal,
  // times those of the denominator and of the normal.
  struct Lifted {
    Integers way;
    mpz_class height;
  };

  Lifted LiftedOf(const OverOne& from, const Point& point) const {
    const OverOne to = Scaled(point);
    Lifted lifted{Way(from, to), {}};
    const mpz_class along = Dot(lifted.way, normal_);
    lifted.height = Dot(lifted.way, lifted.way) * squared_ - along * along;
    const mpz_class denominator = from.denominator * to.denominator;
    for (mpz_class& number : lifted.way) number *= denominator;
    return lifted;
  }

  Integers normal_;
  mpz_class squared_;  // of the normal
};

}  // namespace doorforge::exact

namespace CGAL::TriangulationProjectionTraitsCartesianFunctors {

/// These have the signs of CGAL's own. Every source that instantiates one must see it before.
template <>
class Projected_orientation_with_normal_3<Projection_traits_base_3<doorforge::exact::Fractions>>
    : public doorforge::exact::ProjectedOrientation {
 public:
  using ProjectedOrientation::ProjectedOrientation;
};

template <>
class Projected_side_of_oriented_circle_with_normal_3<
    Projection_traits_base_3<doorforge::exact::Fractions>>
    : public doorforge::exact::ProjectedSideOfCircle {
 public:
  using ProjectedSideOfCircle::ProjectedSideOfCircle;
};

}  // namespace CGAL::TriangulationProjectionTraitsCartesianFunctors
#endif
