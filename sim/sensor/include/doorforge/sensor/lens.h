// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "doorforge/sensor/pinhole_view.h"

namespace doorforge {

/// How a lens departs from a pinhole.
///
/// Points are (x, y) = (X / Z, Y / Z) of the camera's frame; "ideal" is where a pinhole would show
/// them, "seen" where the lens does.
enum class LensModel {
  kPinhole,       ///< Seen is ideal.
  kPolynomial,    ///< Seen = polynomial(ideal): OpenCV's standard, rational and thin prism models.
  kFisheye,       ///< Seen lies theta (1 + k1 theta^2 + .. + k4 theta^8) off the axis: OpenCV's.
  kInverseBrown,  ///< Ideal = polynomial(seen), with its first five coefficients.
};

/// A lens as a calibration gives it.
struct LensDistortion {
  LensModel model = LensModel::kPinhole;
  /// OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4, of a fisheye k1 k2 k3 k4; the rest 0.
  std::array<double, 12> coefficients{};
};

/// Takes ideal points to seen ones and back.
class Lens {
 public:
  /// @throws Error(kInvalidArgument) on a coefficient that is not finite.
  explicit Lens(const LensDistortion& distortion);

  /// Nothing where the lens shows the point nowhere: beyond where its polynomial turns back.
  std::optional<Eigen::Vector2d> SeenOf(const Eigen::Vector2d& ideal) const;

  /// The inverse, exact but for rounding; nothing where no ideal point is seen there.
  ///
  /// @param guess Where to begin looking, such as a neighbour's answer.
  std::optional<Eigen::Vector2d> IdealOf(const Eigen::Vector2d& seen,
                                         const Eigen::Vector2d& guess) const;
  std::optional<Eigen::Vector2d> IdealOf(const Eigen::Vector2d& seen) const {
    return IdealOf(seen, seen);
  }

 private:
  std::optional<Eigen::Vector2d> Solved(const Eigen::Vector2d& value,
                                        const Eigen::Vector2d& guess) const;
  std::optional<Eigen::Vector2d> Mapped(const Eigen::Vector2d& from) const;
  std::optional<Eigen::Vector2d> FisheyeIdealOf(const Eigen::Vector2d& seen) const;
  double FisheyeRadius(double angle_rad) const;

  LensDistortion lens_;
  double limit_ = 0;  // of the polynomial's radius, of a fisheye's angle: so far it only grows
};

/// Where the centre of each pixel of a camera with a lens looks: ideal points, row by row from the
/// top left; of pixels that see nothing NaN.
struct PixelDirections {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector2d> ideal;
};

/// `view` without its pose is what the lens's calibration calls the camera matrix.
PixelDirections DirectionsOf(const PinholeView& view, const Lens& lens);

}  // namespace doorforge
