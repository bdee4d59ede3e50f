// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "exact_side.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace doorforge {
namespace {

// Exact sums of doubles that do not overlap, smallest first: Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
using Expansion = std::vector<double>;

struct SumAndError {
  double sum;
  double error;
};

SumAndError TwoSum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

Expansion Sum(const Expansion& a, const Expansion& b) {
  Expansion total = a;
  for (double term : b) {
    Expansion grown;
    for (const double part : total) {
      const SumAndError added = TwoSum(term, part);
      if (added.error != 0) grown.push_back(added.error);
      term = added.sum;
    }
    if (term != 0) grown.push_back(term);
    total = std::move(grown);
  }
  return total;
}

Expansion Difference(double a, double b) {
  return Sum(a == 0 ? Expansion{} : Expansion{a}, b == 0 ? Expansion{} : Expansion{-b});
}

Expansion Product(const Expansion& a, const Expansion& b) {
  Expansion total;
  for (const double x : a) {
    for (const double y : b) {
      const double product = x * y;
      const double error = std::fma(x, y, -product);
      total = Sum(total, error == 0 ? Expansion{product} : Expansion{error, product});
    }
  }
  return total;
}

Expansion Negative(Expansion a) {
  for (double& term : a) term = -term;
  return a;
}

int SignOf(const Expansion& a) { return a.empty() ? 0 : (a.back() > 0 ? 1 : -1); }

using ExactVector = std::array<Expansion, 3>;

ExactVector Between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {Difference(to.x(), from.x()), Difference(to.y(), from.y()), Difference(to.z(), from.z())};
}

ExactVector Cross(const ExactVector& a, const ExactVector& b) {
  const auto minor = [&](std::size_t i, std::size_t j) {
    return Sum(Product(a[i], b[j]), Negative(Product(a[j], b[i])));
  };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

int ExactSide(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              const Eigen::Vector3d& d) {
  const ExactVector normal = Cross(Between(a, b), Between(a, c));
  const ExactVector along = Between(a, d);
  Expansion total;
  for (std::size_t i = 0; i < 3; ++i) total = Sum(total, Product(normal[i], along[i]));
  return SignOf(total);
}

}  // namespace

int SideOfPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
  // the rounded determinant has the right sign where it is larger than its greatest error
  constexpr double kBound = 1e-15;  // more than Shewchuk's (7 + 56 eps) eps
  const Eigen::Vector3d p = b - a;
  const Eigen::Vector3d q = c - a;
  const Eigen::Vector3d r = d - a;
  const double rounded = p.cross(q).dot(r);
  const Eigen::Vector3d m = p.cwiseAbs();
  const Eigen::Vector3d n = q.cwiseAbs();
  const double size = (m.y() * n.z() + m.z() * n.y()) * std::abs(r.x()) +
                      (m.z() * n.x() + m.x() * n.z()) * std::abs(r.y()) +
                      (m.x() * n.y() + m.y() * n.x()) * std::abs(r.z());
  if (std::abs(rounded) > kBound * size) return rounded > 0 ? 1 : -1;
  return ExactSide(a, b, c, d);
}

bool AreCollinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  for (const Expansion& component : Cross(Between(a, b), Between(a, c))) {
    if (SignOf(component) != 0) return false;
  }
  return true;
}

}  // namespace doorforge
