// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/exact_side.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace doorforge {
namespace {

// An exact sum of doubles that do not overlap, smallest first: Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997. Room for `kMost` of them.
template <int kMost>
struct Expansion {
  std::array<double, static_cast<std::size_t>(kMost)> terms;
  std::size_t count = 0;

  void Add(double term) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double part = terms[i];
      const double sum = term + part;
      const double of_part = sum - term;
      const double error = (term - (sum - of_part)) + (part - of_part);
      if (error != 0) terms[kept++] = error;
      term = sum;
    }
    if (term != 0) terms[kept++] = term;
    count = kept;
  }

  int Sign() const { return count == 0 ? 0 : (terms[count - 1] > 0 ? 1 : -1); }
};

Expansion<2> Difference(double a, double b) {
  Expansion<2> difference;
  difference.Add(a);
  difference.Add(-b);
  return difference;
}

// Adds `sign` times the product of two expansions.
template <int kMost, int kA, int kB>
void AddProduct(Expansion<kMost>& total, const Expansion<kA>& a, const Expansion<kB>& b, int sign) {
  static_assert(kMost >= 2 * kA * kB);
  for (std::size_t i = 0; i < a.count; ++i) {
    for (std::size_t j = 0; j < b.count; ++j) {
      const double x = sign * a.terms[i];
      const double product = x * b.terms[j];
      total.Add(std::fma(x, b.terms[j], -product));
      total.Add(product);
    }
  }
}

using ExactVector = std::array<Expansion<2>, 3>;

ExactVector Between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {Difference(to.x(), from.x()), Difference(to.y(), from.y()), Difference(to.z(), from.z())};
}

std::array<Expansion<16>, 3> Cross(const ExactVector& a, const ExactVector& b) {
  std::array<Expansion<16>, 3> cross;
  for (std::size_t k = 0; k < 3; ++k) {
    AddProduct(cross[k], a[(k + 1) % 3], b[(k + 2) % 3], 1);
    AddProduct(cross[k], a[(k + 2) % 3], b[(k + 1) % 3], -1);
  }
  return cross;
}

}  // namespace

int ExactSideOfPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d) {
  for (int k = 0; k < 3; ++k) {
    if (a[k] == b[k] && a[k] == c[k] && a[k] == d[k]) return 0;  // as most planes of furniture
  }
  const std::array<Expansion<16>, 3> normal = Cross(Between(a, b), Between(a, c));
  const ExactVector along = Between(a, d);
  Expansion<192> total;
  for (std::size_t i = 0; i < 3; ++i) AddProduct(total, normal[i], along[i], 1);
  return total.Sign();
}

int SideOfPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
  // the rounded determinant has the right sign where it is larger than its greatest error
  const Eigen::Vector3d p = b - a;
  const Eigen::Vector3d q = c - a;
  const Eigen::Vector3d r = d - a;
  const double rounded = p.cross(q).dot(r);
  const Eigen::Vector3d m = p.cwiseAbs();
  const Eigen::Vector3d n = q.cwiseAbs();
  const double size = (m.y() * n.z() + m.z() * n.y()) * std::abs(r.x()) +
                      (m.z() * n.x() + m.x() * n.z()) * std::abs(r.y()) +
                      (m.x() * n.y() + m.y() * n.x()) * std::abs(r.z());
  if (std::abs(rounded) > kSideBound * size) return rounded > 0 ? 1 : -1;
  return ExactSideOfPlane(a, b, c, d);
}

bool AreCollinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  for (const Expansion<16>& component : Cross(Between(a, b), Between(a, c))) {
    if (component.Sign() != 0) return false;
  }
  return true;
}

}  // namespace doorforge
