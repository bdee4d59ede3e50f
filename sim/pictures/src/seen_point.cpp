// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "seen_point.h"

#include <algorithm>

namespace doorforge {
namespace {

constexpr std::uint8_t kSeamRight = 1;
constexpr std::uint8_t kSeamBelow = 2;
constexpr float kCrease = 0.97F;

}  // namespace

bool LooksTheSame(const SeenPoint& a, const SeenPoint& b) {
  return a.part == b.part && a.normal.dot(b.normal) >= kCrease &&
         std::fabs((b.position - a.position).dot(a.face)) <= kSamePlane;
}

namespace {

bool SeesTheSame(const SeenPoint& a, const SeenPoint& b) {
  return LooksTheSame(a, b) && a.face.dot(b.face) >= kCrease;
}

}  // namespace

void PointImage::FindSeams() {
  seams.assign(points.size(), 0);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const std::size_t i = At(column, row);
      const auto below = i + static_cast<std::size_t>(width);
      if (column + 1 < width && !SeesTheSame(points[i], points[i + 1])) seams[i] |= kSeamRight;
      if (row + 1 < height && !SeesTheSame(points[i], points[below])) seams[i] |= kSeamBelow;
    }
  }
}

bool PointImage::IsEdge(int column, int row) const {
  const std::size_t i = At(column, row);
  return seams[i] != 0 || (column > 0 && (seams[i - 1] & kSeamRight) != 0) ||
         (row > 0 && (seams[i - static_cast<std::size_t>(width)] & kSeamBelow) != 0);
}

void PointImage::WantAround(std::span<const std::uint8_t> is_seen) {
  const int across = groups_across();
  const int down = (height + kPixelGroup - 1) / kPixelGroup;
  wanted.assign(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 0);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      if (is_seen[At(column, row)] == 0) continue;
      const int x = column / kPixelGroup;
      const int y = row / kPixelGroup;
      for (int j = std::max(0, y - 1); j <= std::min(down - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(across - 1, x + 1); ++i)
          wanted[static_cast<std::size_t>(j * across + i)] = 1;
      }
    }
  }
}

}  // namespace doorforge
