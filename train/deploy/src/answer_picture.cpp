// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/answer_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
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
  Canvas(const Picture& picture, const PinholeView& view, const Lens& lens)
      : scale_(std::max(1, kLeastSide / std::max(picture.width, picture.height))),
        view_(view),
        lens_(lens) {
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
    const Eigen::Vector3d in_camera = view_.world_from_camera.inverse() * centre;
    if (in_camera.z() < 0.05) return;  // beside or behind the lens
    const auto seen = lens_.SeenOf(in_camera.hnormalized());
    if (!seen) return;
    const double x = scale_ * (view_.fx * seen->x() + view_.cx);
    const double y = scale_ * (view_.fy * seen->y() + view_.cy);
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
  Lens lens_;
  Picture picture_;
};

// Part of what was seen, with the camera of that part.
struct Excerpt {
  SeenPicture seen;
  PixelMask kept;  // which pixels the policy is given
  PinholeView view;
};

// Which pixels are within the crop.
PixelMask KeptOf(const DepthImage& depth, const CalibratedCamera& camera,
                 const CloudConfig& config) {
  const PinholeView& view = camera.view;
  PixelMask kept{depth.width, depth.height, {}};
  kept.set.reserve(depth.depth_m.size());
  for (int row = 0; row < depth.height; ++row) {
    for (int column = 0; column < depth.width; ++column) {
      const std::size_t i = IndexOf(column, row, depth.width);
      const double metres = static_cast<double>(depth.depth_m[i]);
      const Eigen::Vector2d ideal = camera.directions
                                        ? camera.directions->ideal[i]
                                        : Eigen::Vector2d((column + 0.5 - view.cx) / view.fx,
                                                          (row + 0.5 - view.cy) / view.fy);
      const bool is_kept =
          metres < config.max_depth_m &&
          (view.world_from_camera * Eigen::Vector3d(metres * ideal.homogeneous())).z() >
              config.min_height_m;
      kept.set.push_back(is_kept ? 1 : 0);
    }
  }
  return kept;
}

// Washes out what the policy is not given.
Picture CroppedPreview(const Excerpt& part, const CloudConfig& config) {
  const DepthImage& depth = part.seen.depth;
  Picture picture{depth.width, depth.height, depth.rgb};
  if (depth.rgb.empty()) picture = DepthPreview(depth, config.max_depth_m);
  for (std::size_t i = 0; i < part.kept.set.size(); ++i) {
    if (part.kept.set[i] != 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint8_t& channel = picture.rgb[3 * i + k];
      channel = static_cast<std::uint8_t>((channel + 3 * 235) / 4);
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

// Where a part lies in the whole.
struct Window {
  int left = 0;
  int top = 0;
  int side = 0;
};

template <class Value>
std::vector<Value> Cut(const std::vector<Value>& whole, int width, const Window& window,
                       int channels = 1) {
  std::vector<Value> cut;
  for (int row = 0; row < window.side; ++row) {
    const auto from =
        whole.begin() + (std::ptrdiff_t{window.top + row} * width + window.left) * channels;
    cut.insert(cut.end(), from, from + std::ptrdiff_t{window.side} * channels);
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
  const Window window{begin(view.fx, seen.x(), view.cx, view.width),
                      begin(view.fy, seen.y(), view.cy, view.height), side};
  Excerpt part{{}, {side, side, Cut(whole.kept.set, view.width, window)}, view};
  part.view.width = side;
  part.view.height = side;
  part.view.cx -= window.left;
  part.view.cy -= window.top;
  DepthImage& cut = part.seen.depth;
  cut.width = side;
  cut.height = side;
  cut.depth_m = Cut(whole.seen.depth.depth_m, view.width, window);
  if (whole.seen.handle)
    part.seen.handle = {side, side, Cut(whole.seen.handle->set, view.width, window)};
  if (!whole.seen.depth.rgb.empty()) cut.rgb = Cut(whole.seen.depth.rgb, view.width, window, 3);
  return part;
}

/// What is the same of all parts.
struct Drawing {
  const ActAnswer& answer;
  RigidTransform hand_from_tcp;
  Lens lens;
  const CloudConfig& cloud;
};

Picture Drawn(const Excerpt& part, const Drawing& drawing) {
  const auto& [answer, hand_from_tcp, lens, cloud] = drawing;
  Canvas canvas(CroppedPreview(part, cloud), part.view, lens);
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
  const CalibratedCamera& camera = controller.camera();
  const Drawing drawing{answer, controller.robot().hand_from_tcp(), Lens(camera.lens), cloud};
  const Excerpt whole{controller.last_seen(), KeptOf(controller.last_seen().depth, camera, cloud),
                      camera.view};
  const Excerpt close =
      CloseUp(whole, (answer.world_from_hand * drawing.hand_from_tcp).translation());
  const std::vector<Picture> tiles = {Drawn(whole, drawing), Drawn(close, drawing)};
  const std::vector<std::string> captions = {
      Caption(answer), answer.contact_m ? "red: the hand there, ring: contact, outline: mask"
                                        : "white: the hand now, red: the hand next"};
  return ContactSheet(tiles, captions, {.columns = 2, .tile_width = kTile, .tile_height = kTile});
}

}  // namespace doorforge
