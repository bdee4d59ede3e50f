// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/answer_picture.h"

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

std::size_t IndexOf(int column, int row, int width) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(column);
}

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
        const std::size_t from = 3 * IndexOf(column / scale_, row / scale_, picture.width);
        std::copy_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(from), 3, At(column, row));
      }
    }
  }

  void Line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Color& color,
            double width) {
    constexpr int kSteps = 400;
    for (int i = 0; i <= kSteps; ++i) Disc(from + (to - from) * i / kSteps, color, width / 2);
  }

  void Ring(const Eigen::Vector3d& centre, const Color& color) {
    Disc(centre, kOutline, 8);
    Disc(centre, color, 6);
    Disc(centre, kOutline, 2);
  }

  void Outline(const PixelMask& mask) {
    const auto set = [&](int column, int row) {
      return column >= 0 && row >= 0 && column < mask.width && row < mask.height &&
             mask.set[IndexOf(column, row, mask.width)] != 0;
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
    return picture_.rgb.begin() +
           static_cast<std::ptrdiff_t>(3 * IndexOf(column, row, picture_.width));
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
      const std::size_t i = IndexOf(column, row, depth.width);
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
  for (const auto& [paint, width] : {std::pair{kOutline, 7.0}, std::pair{color, 3.5}}) {
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

// Part of what was seen, with the camera of that part.
struct Excerpt {
  SeenPicture seen;
  PinholeView view;
};

PixelMask Cut(const PixelMask& mask, const PinholeView& part, int left, int top) {
  PixelMask cut{part.width, part.height, {}};
  for (int row = 0; row < part.height; ++row) {
    const auto from = mask.set.begin() + std::ptrdiff_t{top + row} * mask.width + left;
    cut.set.insert(cut.set.end(), from, from + part.width);
  }
  return cut;
}

// Half a metre about a place, or as much of it as the picture shows.
Excerpt CloseUp(const Excerpt& whole, const Eigen::Vector3d& place) {
  constexpr double kAcross = 0.5;  // [m]
  const PinholeView& view = whole.view;
  const Eigen::Vector3d seen = view.world_from_camera.inverse() * place;
  const double depth = std::max(0.1, seen.z());
  const int side = std::clamp(static_cast<int>(view.fx * kAcross / depth), 16,
                              std::min(view.width, view.height));
  const auto begin = [&](double focal, double offset, double middle, int size) {
    const double at = std::clamp(focal * offset / depth + middle, 0.0, static_cast<double>(size));
    return std::clamp(static_cast<int>(at) - side / 2, 0, size - side);
  };
  const int left = begin(view.fx, seen.x(), view.cx, view.width);
  const int top = begin(view.fy, seen.y(), view.cy, view.height);
  Excerpt part{{}, view};
  part.view.width = side;
  part.view.height = side;
  part.view.cx -= left;
  part.view.cy -= top;
  DepthImage& cut = part.seen.depth;
  cut.width = side;
  cut.height = side;
  for (int row = 0; row < side; ++row) {
    const auto from =
        whole.seen.depth.depth_m.begin() + std::ptrdiff_t{top + row} * view.width + left;
    cut.depth_m.insert(cut.depth_m.end(), from, from + side);
  }
  if (whole.seen.handle) part.seen.handle = Cut(*whole.seen.handle, part.view, left, top);
  return part;
}

Picture Drawn(const ActAnswer& answer, const Excerpt& part, const RigidTransform& hand_from_tcp,
              const CloudConfig& cloud) {
  Canvas canvas(CroppedPreview(part.seen.depth, part.view, cloud), part.view);
  if (part.seen.handle) canvas.Outline(*part.seen.handle);
  if (answer.world_from_hand_now)
    DrawHand(canvas, *answer.world_from_hand_now * hand_from_tcp, kNow);
  DrawHand(canvas, answer.world_from_hand * hand_from_tcp, kNext);
  if (answer.contact_m) canvas.Ring(*answer.contact_m, kContact);
  return canvas.picture();
}

}  // namespace

Picture AnswerPicture(const ActAnswer& answer, const OnlineController& controller,
                      const CloudConfig& cloud) {
  constexpr int kTile = 640;
  const RigidTransform hand_from_tcp = controller.robot().hand_from_tcp();
  const Excerpt whole{controller.last_seen(), controller.camera().view};
  const Excerpt close = CloseUp(whole, (answer.world_from_hand * hand_from_tcp).translation());
  const std::vector<Picture> tiles = {Drawn(answer, whole, hand_from_tcp, cloud),
                                      Drawn(answer, close, hand_from_tcp, cloud)};
  const std::vector<std::string> captions = {
      Caption(answer), answer.contact_m ? "red: the hand there, ring: contact, outline: mask"
                                        : "white: the hand now, red: the hand next"};
  return ContactSheet(tiles, captions, {.columns = 2, .tile_width = kTile, .tile_height = kTile});
}

}  // namespace doorforge
