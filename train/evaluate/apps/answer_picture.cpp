// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "answer_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace doorforge {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr Color kNow = {255, 255, 255};
constexpr Color kNext = {220, 40, 40};
constexpr Color kContact = {255, 160, 0};
constexpr Color kMask = {255, 160, 0};
constexpr Color kOutline = {30, 30, 30};
constexpr int kLeastSide = 720;        // pictures are enlarged by whole numbers up to here
constexpr double kPalm = 0.12;         // [m] from the tool centre back to the hand
constexpr double kFinger = 0.05;       // [m] from the tool centre back to the fingers' roots
constexpr double kHalfOpening = 0.04;  // [m]

/// A picture to draw into, with the camera that it was taken by.
class Canvas {
 public:
  Canvas(const Picture& picture, const PinholeView& view)
      : scale_(std::max(1, kLeastSide / std::max(picture.width, picture.height))), view_(view) {
    picture_.width = picture.width * scale_;
    picture_.height = picture.height * scale_;
    picture_.rgb.resize(std::size_t{3} * static_cast<std::size_t>(picture_.width) *
                        static_cast<std::size_t>(picture_.height));
    for (int row = 0; row < picture_.height; ++row) {
      for (int column = 0; column < picture_.width; ++column) {
        const auto from =
            static_cast<std::ptrdiff_t>(3 * (row / scale_ * picture.width + column / scale_));
        std::copy_n(picture.rgb.begin() + from, 3, At(column, row));
      }
    }
  }

  void Line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Color& color,
            double width) {
    constexpr int kSteps = 400;
    for (int i = 0; i <= kSteps; ++i)
      Disc(from + (to - from) * i / kSteps, color, width * scale_ / 2);
  }

  void Ring(const Eigen::Vector3d& centre, const Color& color) {
    Disc(centre, kOutline, 4.0 * scale_);
    Disc(centre, color, 3.0 * scale_);
    Disc(centre, kOutline, 1.0 * scale_);
  }

  void Outline(const PixelMask& mask) {
    const auto set = [&](int column, int row) {
      return column >= 0 && row >= 0 && column < mask.width && row < mask.height &&
             mask.set[static_cast<std::size_t>(row * mask.width + column)] != 0;
    };
    for (int row = 0; row < picture_.height; ++row) {
      for (int column = 0; column < picture_.width; ++column) {
        const int c = column / scale_;
        const int r = row / scale_;
        const bool edge =
            set(c, r) && !(set(c - 1, r) && set(c + 1, r) && set(c, r - 1) && set(c, r + 1));
        if (edge) Paint(column, row, kMask);
      }
    }
  }

  const Picture& picture() const { return picture_; }

 private:
  std::vector<std::uint8_t>::iterator At(int column, int row) {
    return picture_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (row * picture_.width + column));
  }

  void Paint(int column, int row, const Color& color) {
    std::copy(color.begin(), color.end(), At(column, row));
  }

  void Disc(const Eigen::Vector3d& centre, const Color& color, double radius) {
    const Eigen::Vector3d seen = view_.world_from_camera.inverse() * centre;
    if (seen.z() < 0.05) return;  // beside or behind the lens
    const double x = scale_ * (view_.fx * seen.x() / seen.z() + view_.cx);
    const double y = scale_ * (view_.fy * seen.y() / seen.z() + view_.cy);
    if (!(std::fabs(x) < 1e5 && std::fabs(y) < 1e5)) return;
    for (int row = static_cast<int>(y - radius); row <= static_cast<int>(y + radius); ++row) {
      for (int column = static_cast<int>(x - radius); column <= static_cast<int>(x + radius);
           ++column) {
        const bool inside = column >= 0 && row >= 0 && column < picture_.width &&
                            row < picture_.height &&
                            std::hypot(column + 0.5 - x, row + 0.5 - y) <= std::max(0.8, radius);
        if (inside) Paint(column, row, color);
      }
    }
  }

  int scale_;
  PinholeView view_;
  Picture picture_;
};

// Washes out what the policy is not given.
Picture CroppedPreview(const DepthImage& depth, const PinholeView& view,
                       const CloudConfig& config) {
  Picture picture = DepthPreview(depth, config.max_depth_m);
  const RigidTransform& pose = view.world_from_camera;
  for (int row = 0; row < depth.height; ++row) {
    for (int column = 0; column < depth.width; ++column) {
      const auto i = static_cast<std::size_t>(row * depth.width + column);
      const double metres = static_cast<double>(depth.depth_m[i]);
      const Eigen::Vector3d ray((column + 0.5 - view.cx) / view.fx, (row + 0.5 - view.cy) / view.fy,
                                1);
      const bool kept = metres < config.max_depth_m &&
                        (pose * Eigen::Vector3d(ray * metres)).z() > config.min_height_m;
      if (kept) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint8_t& channel = picture.rgb[3 * i + k];
        channel = static_cast<std::uint8_t>((channel + 3 * 235) / 4);
      }
    }
  }
  return picture;
}

void DrawHand(Canvas& canvas, const RigidTransform& world_from_tcp, const Color& color) {
  const auto at = [&](double y, double z) -> Eigen::Vector3d {
    return world_from_tcp * Eigen::Vector3d(0, y, z);
  };
  for (const auto& [paint, width] : {std::pair{kOutline, 3.5}, std::pair{color, 1.8}}) {
    canvas.Line(at(0, -kPalm), at(0, -kFinger), paint, width);
    canvas.Line(at(-kHalfOpening, -kFinger), at(kHalfOpening, -kFinger), paint, width);
    for (const double side : {-kHalfOpening, kHalfOpening})
      canvas.Line(at(side, -kFinger), at(side, 0), paint, width);
  }
}

std::string Caption(const ActAnswer& answer) {
  char text[160];
  std::string foreign = "unknown";
  if (answer.foreign) {
    std::snprintf(text, sizeof text, "%.2f of %.2f", answer.foreign->distance,
                  answer.foreign->limit);
    foreign = text;
  }
  const std::string stage(NameOf(answer.stage));
  std::snprintf(text, sizeof text, "%s: expected %.1f deg, foreign %s: %s", stage.c_str(),
                answer.expected_gain_rad * 180 / std::numbers::pi, foreign.c_str(),
                answer.hold_reasons.empty() ? "go" : "HOLD");
  return text;
}

}  // namespace

Picture AnswerPicture(const ActAnswer& answer, const SeenPicture& seen, const Decider& decider,
                      const CloudConfig& cloud) {
  const PinholeView& view = decider.camera().view;
  Canvas canvas(CroppedPreview(seen.depth, view, cloud), view);
  if (seen.handle) canvas.Outline(*seen.handle);
  const RigidTransform hand_from_tcp = decider.robot().hand_from_tcp();
  if (answer.world_from_hand_now)
    DrawHand(canvas, *answer.world_from_hand_now * hand_from_tcp, kNow);
  DrawHand(canvas, answer.world_from_hand * hand_from_tcp, kNext);
  if (answer.contact_m) canvas.Ring(*answer.contact_m, kContact);
  const std::vector<std::string> captions = {Caption(answer)};
  const Picture& drawn = canvas.picture();
  return ContactSheet(std::span(&drawn, 1), captions,
                      {.columns = 1, .tile_width = drawn.width, .tile_height = drawn.height});
}

}  // namespace doorforge
