// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/lens.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr double kWidestAngle = 1.5;  // off the axis [rad]; a depth along it says little beyond
const double kWidestRadius = std::tan(kWidestAngle);
constexpr int kMostSteps = 20;
constexpr int kMostHalvings = 8;
constexpr int kBisections = 60;
constexpr double kExact = 1e-12;  // far below a pixel, 1e-3 or so

struct Radial {
  double factor = 1;
  double slope = 0;  // by the squared radius
};

struct MappedPoint {
  Eigen::Vector2d at;
  Eigen::Matrix2d slope;
};

// The radial part of OpenCV's model, a quotient of polynomials of the squared radius.
Radial RadialAt(const std::array<double, 12>& c, double squared) {
  const double above = 1 + squared * (c[0] + squared * (c[1] + squared * c[4]));
  const double below = 1 + squared * (c[5] + squared * (c[6] + squared * c[7]));
  const double above_slope = c[0] + squared * (2 * c[1] + squared * 3 * c[4]);
  const double below_slope = c[5] + squared * (2 * c[6] + squared * 3 * c[7]);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

// The polynomial and its derivative.
MappedPoint MapPoint(const std::array<double, 12>& c, const Eigen::Vector2d& from) {
  const double x = from.x();
  const double y = from.y();
  const double squared = from.squaredNorm();
  const auto [factor, slope] = RadialAt(c, squared);
  const double p1 = c[2];
  const double p2 = c[3];
  const Eigen::Vector2d prism(c[8] + 2 * squared * c[9], c[10] + 2 * squared * c[11]);
  MappedPoint to;
  to.at = {
      x * factor + 2 * p1 * x * y + p2 * (squared + 2 * x * x) + squared * (c[8] + squared * c[9]),
      y * factor + p1 * (squared + 2 * y * y) + 2 * p2 * x * y +
          squared * (c[10] + squared * c[11])};
  const double mixed = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
  to.slope << factor + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x + 2 * x * prism.x(),
      mixed + 2 * y * prism.x(), mixed + 2 * x * prism.y(),
      factor + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x + 2 * y * prism.y();
  return to;
}

// Up to where `growth` stays above 0.
template <class Growth>
double LimitOf(double widest, const Growth& growth) {
  constexpr int kSteps = 4000;
  for (int i = 1; i <= kSteps; ++i) {
    if (!(growth(widest * i / kSteps) > 0)) return widest * (i - 1) / kSteps;
  }
  return widest;
}

bool Inside(const Eigen::Vector2d& point, double limit) { return point.norm() <= limit; }

}  // namespace

Lens::Lens(const LensDistortion& distortion) : lens_(distortion) {
  const auto& c = lens_.coefficients;
  Require(std::ranges::all_of(c, [](double value) { return std::isfinite(value); }),
          ErrorCode::kInvalidArgument, "lens: a coefficient is not finite");
  if (lens_.model == LensModel::kFisheye) {
    limit_ = LimitOf(kWidestAngle, [&](double angle) {
      const double s = angle * angle;
      return 1 + s * (3 * c[0] + s * (5 * c[1] + s * (7 * c[2] + s * 9 * c[3])));
    });
    return;
  }
  limit_ = LimitOf(kWidestRadius, [&](double radius) {
    const auto [factor, slope] = RadialAt(c, radius * radius);
    return factor > 0 ? factor + 2 * radius * radius * slope : 0;
  });
}

double Lens::FisheyeRadius(double angle_rad) const {
  const auto& c = lens_.coefficients;
  const double s = angle_rad * angle_rad;
  return angle_rad * (1 + s * (c[0] + s * (c[1] + s * (c[2] + s * c[3]))));
}

std::optional<Eigen::Vector2d> Lens::Mapped(const Eigen::Vector2d& from) const {
  if (!Inside(from, limit_)) return std::nullopt;
  return MapPoint(lens_.coefficients, from).at;
}

// Newton's method, kept inside where the polynomial only grows.
std::optional<Eigen::Vector2d> Lens::Solved(const Eigen::Vector2d& value,
                                            const Eigen::Vector2d& guess) const {
  Eigen::Vector2d point = Inside(guess, limit_) ? guess : Eigen::Vector2d::Zero();
  for (int i = 0; i < kMostSteps; ++i) {
    const MappedPoint mapped = MapPoint(lens_.coefficients, point);
    const Eigen::Vector2d off = value - mapped.at;
    if (off.norm() <= kExact * std::max(1.0, value.norm())) return point;
    Eigen::Vector2d step = mapped.slope.inverse() * off;
    if (!step.allFinite()) return std::nullopt;
    for (int k = 0; k < kMostHalvings && !Inside(point + step, limit_); ++k) step /= 2;
    if (!Inside(point + step, limit_)) return std::nullopt;
    point += step;
  }
  return std::nullopt;
}

// The angle off the axis by bisection, which the distance from the middle grows with.
std::optional<Eigen::Vector2d> Lens::FisheyeIdealOf(const Eigen::Vector2d& seen) const {
  const double radius = seen.norm();
  if (radius < kExact) return seen;
  if (radius > FisheyeRadius(limit_)) return std::nullopt;
  double low = 0;
  double high = limit_;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (low + high) / 2;
    (FisheyeRadius(middle) < radius ? low : high) = middle;
  }
  return seen * (std::tan(low) / radius);
}

std::optional<Eigen::Vector2d> Lens::SeenOf(const Eigen::Vector2d& ideal) const {
  switch (lens_.model) {
    case LensModel::kPolynomial:
      return Mapped(ideal);
    case LensModel::kInverseBrown:
      return Solved(ideal, ideal);
    case LensModel::kFisheye: {
      const double radius = ideal.norm();
      const double angle = std::atan(radius);
      if (angle > limit_) return std::nullopt;
      if (radius < kExact) return ideal;
      return ideal * (FisheyeRadius(angle) / radius);
    }
    case LensModel::kPinhole:
      break;
  }
  return ideal;
}

std::optional<Eigen::Vector2d> Lens::IdealOf(const Eigen::Vector2d& seen,
                                             const Eigen::Vector2d& guess) const {
  switch (lens_.model) {
    case LensModel::kPolynomial: {
      // a guess near the limit may lead astray; the middle never does
      const auto near = Solved(seen, guess);
      return near ? near : Solved(seen, Eigen::Vector2d::Zero());
    }
    case LensModel::kInverseBrown:
      return Mapped(seen);
    case LensModel::kFisheye:
      return FisheyeIdealOf(seen);
    case LensModel::kPinhole:
      break;
  }
  return seen;
}

PixelDirections DirectionsOf(const PinholeView& view, const Lens& lens) {
  PixelDirections directions{view.width, view.height, {}};
  directions.ideal.reserve(static_cast<std::size_t>(view.width) *
                           static_cast<std::size_t>(view.height));
  const Eigen::Vector2d nothing =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < view.height; ++row) {
    std::optional<Eigen::Vector2d> left;
    for (int column = 0; column < view.width; ++column) {
      const Eigen::Vector2d seen((column + 0.5 - view.cx) / view.fx,
                                 (row + 0.5 - view.cy) / view.fy);
      left = lens.IdealOf(seen, left.value_or(seen));
      directions.ideal.push_back(left.value_or(nothing));
    }
  }
  return directions;
}

}  // namespace doorforge
