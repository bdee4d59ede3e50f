// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "doorforge/sensor/ray_packet.h"

#include "pinhole_directions.h"
#include "rgb_renderer.h"

// What RgbRenderer makes of pixels that see more than one surface.
namespace doorforge {
namespace {

constexpr float kEndless = std::numeric_limits<float>::infinity();

}  // namespace

void RgbRenderer::SmoothEdges(const CameraModel& camera) {
  if (samples_ < 2) return;
  const PinholeDirections directions(camera);
  FindCorners(directions);
  std::vector<std::pair<std::size_t, LinearColor>> smooth;
  for (int row = 0; row < image_.height; ++row) {
    for (int column = 0; column < image_.width; ++column) {
      if (IsWantedEdge(column, row) && !HasOneSurface(column, row))
        smooth.emplace_back(image_.At(column, row), EdgeColor(directions, column, row));
    }
  }
  for (const auto& [pixel, color] : smooth) colors_[pixel] = color;
}

bool RgbRenderer::IsWantedEdge(int column, int row) const {
  return image_.IsWanted(column, row) && image_.IsEdge(column, row);
}

// A seam between two pixels runs through one of them as a rule, and the other needs no samples.
bool RgbRenderer::HasOneSurface(int column, int row) const {
  const SeenPoint& middle = image_.points[image_.At(column, row)];
  for (const int y : {row, row + 1}) {
    for (const int x : {column, column + 1}) {
      if (!LooksTheSame(middle, corners_[CornerAt(x, y)])) return false;
    }
  }
  return true;
}

void RgbRenderer::FindCorners(const PinholeDirections& directions) {
  corners_.resize(CornerAt(image_.width, image_.height) + 1);
  std::vector<std::uint8_t> is_wanted(corners_.size());
  for (int row = 0; row < image_.height; ++row) {
    for (int column = 0; column < image_.width; ++column) {
      if (!IsWantedEdge(column, row)) continue;
      for (const int y : {row, row + 1})
        for (const int x : {column, column + 1}) is_wanted[CornerAt(x, y)] = 1;
    }
  }
  for (int top = 0; top <= image_.height; top += kCornerTile) {
    for (int left = 0; left <= image_.width; left += kCornerTile)
      FindCornersOfTile(directions, {left, top}, is_wanted);
  }
}

void RgbRenderer::FindCornersOfTile(const PinholeDirections& directions,
                                    const Eigen::Vector2i& left_top,
                                    const std::vector<std::uint8_t>& is_wanted) {
  const Eigen::Vector3f& origin = directions.origin();
  RayPacket packet;
  std::array<std::size_t, RayPacket::kSize> corner_of{};
  std::array<Eigen::Vector3f, RayPacket::kSize> through;
  for (int lane = 0; lane < kCornerTile * kCornerTile; ++lane) {
    const int x = left_top.x() + lane % kCornerTile;
    const int y = left_top.y() + lane / kCornerTile;
    if (x > image_.width || y > image_.height || is_wanted[CornerAt(x, y)] == 0) continue;
    const auto slot = static_cast<std::size_t>(lane);
    corner_of[slot] = CornerAt(x, y);
    through[slot] = directions.Through(static_cast<float>(x), static_cast<float>(y));
    packet.Set(slot, origin, through[slot], kEndless);
  }
  if (packet.rays == 0) return;
  const PacketHits hits = CastRays(geometry_, packet);
  for (std::size_t slot = 0; slot < RayPacket::kSize; ++slot) {
    if ((packet.rays >> slot & 1U) != 0)
      corners_[corner_of[slot]] = PointMet({hits, slot, origin, through[slot]});
  }
}

SeenPoint RgbRenderer::PointMet(const EdgeSample& sample) const {
  const auto& [hits, slot, origin, through] = sample;
  SeenPoint point =
      (hits.hits >> slot & 1U) != 0
          ? MeshPoint(static_cast<std::size_t>(hits.mesh[slot]), hits.triangle[slot],
                      {hits.u[slot], hits.v[slot]}, origin + hits.distance[slot] * through)
          : RoomPoint(origin, through);
  if (point.normal.dot(through) > 0) point.normal = -point.normal;
  return point;
}

// The surfaces that an edge pixel's samples met last, and their colours.
class RgbRenderer::MetSurfaces {
 public:
  const LinearColor* ColorOf(std::uint32_t surface, std::uint32_t triangle) const {
    for (const Met& met : met_) {
      if (met.color != nullptr && met.surface == surface && met.triangle == triangle)
        return met.color;
    }
    return nullptr;
  }
  void Keep(std::uint32_t surface, std::uint32_t triangle, const LinearColor* color) {
    met_[next_++ % met_.size()] = {surface, triangle, color};
  }

 private:
  struct Met {
    std::uint32_t surface = 0;
    std::uint32_t triangle = 0;
    const LinearColor* color = nullptr;
  };
  std::array<Met, 3> met_;
  std::size_t next_ = 0;
};

// Samples that meet a surface again have the colour that the first had.
LinearColor RgbRenderer::EdgeColor(const PinholeDirections& directions, int column, int row) {
  const Eigen::Vector3f& origin = directions.origin();
  const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(samples_))));
  const float step = 1 / static_cast<float>(side);
  LinearColor sum = LinearColor::Zero();
  MetSurfaces met;
  for (int first = 0; first < side * side; first += static_cast<int>(RayPacket::kSize)) {
    RayPacket packet;
    std::array<Eigen::Vector3f, RayPacket::kSize> through;
    const int count = std::min(static_cast<int>(RayPacket::kSize), side * side - first);
    for (int lane = 0; lane < count; ++lane) {
      const int i = first + lane;
      const auto slot = static_cast<std::size_t>(lane);
      through[slot] = directions.Through(
          static_cast<float>(column) + step * (static_cast<float>(i % side) + 0.5F),
          static_cast<float>(row) + step * (static_cast<float>(i / side) + 0.5F));
      packet.Set(slot, origin, through[slot], kEndless);
    }
    const PacketHits hits = CastRays(geometry_, packet);
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(count); ++slot)
      sum += SampleColor({hits, slot, origin, through[slot]}, {column, row}, met);
  }
  return sum / static_cast<float>(side * side);
}

LinearColor RgbRenderer::SampleColor(const EdgeSample& sample, const Eigen::Vector2i& pixel,
                                     MetSurfaces& met) {
  const auto& [hits, slot, origin, through] = sample;
  const bool hit = (hits.hits >> slot & 1U) != 0;
  auto surface = static_cast<std::uint32_t>(hits.mesh[slot]);
  std::uint32_t triangle = hits.triangle[slot];
  const LinearColor* known = hit ? met.ColorOf(surface, triangle) : nullptr;
  if (known != nullptr) return *known;
  SeenPoint point = PointMet(sample);
  if (!hit) {
    // a part of the room has six sides at the most
    surface = point.part;
    triangle = static_cast<std::uint32_t>(3 + point.normal.dot(Eigen::Vector3f(1, 2, 3)));
    known = met.ColorOf(surface, triangle);
    if (known != nullptr) return *known;
  }
  if (const LinearColor* near = ColorNear(point, pixel.x(), pixel.y())) {
    met.Keep(surface, triangle, near);
    return *near;
  }
  point.view = -through.normalized();
  return Shade(point, light_[image_.At(pixel.x(), pixel.y())]);
}

// The colour of the pixel around this one that sees most nearly the same; null: none does.
const LinearColor* RgbRenderer::ColorNear(const SeenPoint& point, int column, int row) const {
  const LinearColor* nearest = nullptr;
  float best = kSameNormal;
  for (int y = std::max(0, row - 1); y <= std::min(image_.height - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(image_.width - 1, column + 1); ++x) {
      const SeenPoint& other = image_.points[image_.At(x, y)];
      if (other.part != point.part) continue;
      const float same = other.normal.dot(point.normal);
      if (same <= best) continue;
      best = same;
      nearest = &colors_[image_.At(x, y)];
    }
  }
  return nearest;
}

}  // namespace doorforge
