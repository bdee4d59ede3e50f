// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <CGAL/Kernel_23/internal/Projection_traits_base_3.h>
#include <CGAL/Simple_cartesian.h>

// A union triangulates each face anew around the points where others cut it. These lie on edges of
// the face, so that intervals decide nothing and the exact orientation is asked for. CGAL computes
// it with fractions, each reduced by a greatest common divisor: most of the time of a union. The
// sign takes none.

#ifdef CGAL_USE_GMPXX
namespace CGAL::TriangulationProjectionTraitsCartesianFunctors {

/// Has the signs of CGAL's own. Every source that instantiates it must see it before.
template <>
class Projected_orientation_with_normal_3<Projection_traits_base_3<Simple_cartesian<mpq_class>>> {
  using ExactKernel = Simple_cartesian<mpq_class>;
  using Point = ExactKernel::Point_3;
  using Integers = std::array<mpz_class, 3>;

 public:
  using Orientation = ExactKernel::Orientation;
  using result_type = Orientation;

  explicit Projected_orientation_with_normal_3(const ExactKernel::Vector_3& normal)
      : normal_(Scaled({&normal.x(), &normal.y(), &normal.z()}).numbers) {}

  Orientation operator()(const Point& p, const Point& q, const Point& r) const {
    const OverOne first = Of(p);
    const Integers u = Way(first, Of(q));
    const Integers v = Way(first, Of(r));
    mpz_class sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (sgn(normal_[i]) == 0) continue;
      const std::size_t j = (i + 1) % 3;
      const std::size_t k = (i + 2) % 3;
      const mpz_class across = u[j] * v[k] - u[k] * v[j];
      sum += normal_[i] * across;
    }
    const int sign = sgn(sum);
    return sign > 0 ? POSITIVE : sign < 0 ? NEGATIVE : ZERO;
  }

 private:
  struct OverOne {  // three fractions over one denominator above 0
    Integers numbers;
    mpz_class denominator;
  };

  static OverOne Of(const Point& point) { return Scaled({&point.x(), &point.y(), &point.z()}); }

  static OverOne Scaled(const std::array<const mpq_class*, 3>& fractions) {
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

  // From one to the other, times both denominators.
  static Integers Way(const OverOne& from, const OverOne& to) {
    Integers way;
    for (std::size_t i = 0; i < 3; ++i)
      way[i] = to.numbers[i] * from.denominator - from.numbers[i] * to.denominator;
    return way;
  }

  Integers normal_;  // times a number above 0
};

}  // namespace CGAL::TriangulationProjectionTraitsCartesianFunctors
#endif
