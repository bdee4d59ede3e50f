// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "doorforge/sensor/picture.h"

namespace doorforge::internal {

using Color = std::array<std::uint8_t, 3>;  ///< Red, green, blue.

/// What pictures for people are drawn with: edges are smoothed by how much of a pixel lies within.
/// Places are in pixels from the top left corner, so that the first pixel's centre is (0.5, 0.5);
/// what lies outside is left out. The same calls give the same bytes.
class Canvas {
 public:
  /// Sizes of at least 1.
  Canvas(int width, int height, const Color& ground);
  explicit Canvas(Picture picture) : picture_(std::move(picture)) {}

  const Picture& picture() const { return picture_; }
  Picture Take() && { return std::move(picture_); }

  void Disc(const Eigen::Vector2d& center, double radius, const Color& color);
  /// A circle whose line has this width around the radius.
  void Ring(const Eigen::Vector2d& center, double radius, double width, const Color& color);
  /// With round ends.
  void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
            const Color& color);
  /// ASCII; any other byte is an empty place. `capital_height` is that of "A" [pixels].
  void Text(std::string_view text, const Eigen::Vector2d& left_of_baseline, double capital_height,
            const Color& color);
  /// Puts a picture with its top left corner at this pixel; it must lie within.
  void Paste(const Picture& picture, int left, int top);

 private:
  template <class Distance>
  void Blend(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Color& color,
             Distance&& distance);

  Picture picture_;
};

/// How wide Text() is.
double TextWidth(std::string_view text, double capital_height);

/// The picture at another size: a mean of what falls into a pixel where it becomes smaller,
/// linear between pixels where it grows. Sizes of at least 1.
Picture Resized(const Picture& picture, int width, int height);

/// A colour between the dark violet (0) and the yellow (1) of viridis, even to the eye and to those
/// who cannot tell red from green.
Color Viridis(double share);

}  // namespace doorforge::internal
