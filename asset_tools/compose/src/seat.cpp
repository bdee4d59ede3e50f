// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "seat.h"

#include <algorithm>
#include <vector>

#include "doorforge/core/mesh_transform.h"

namespace doorforge::internal {
namespace {

constexpr double kBackDepth = 0.004;  // [m] what counts as the back
constexpr int kSamplesPerSide = 15;
// The surface at this share of the back's samples: a moulding or a scratch under less than a tenth
// of the back does not lift the handle off the panel.
constexpr double kSeatQuantile = 0.9;

double SampleAt(double low, double high, int i) {
  return low + (high - low) * (i + 0.5) / kSamplesPerSide;
}

// moves an interval into another by the least amount; nothing if it is longer
std::optional<double> ShiftInto(double low, double high, double outer_low, double outer_high) {
  if (high - low > outer_high - outer_low) return std::nullopt;
  if (low < outer_low) return outer_low - low;
  if (high > outer_high) return outer_high - high;
  return 0.0;
}

}  // namespace

BackOutline BackOutlineOf(const TriangleMesh& handle) {
  const Eigen::AlignedBox3d bounds = BoundsOf(handle);
  BackOutline back{.rear_m = bounds.min().x(), .min_m = {}, .max_m = {}, .samples = {}};
  Eigen::AlignedBox2d outline;
  for (int i = 0; i < kSamplesPerSide; ++i) {
    for (int j = 0; j < kSamplesPerSide; ++j) {
      const Eigen::Vector2d at(SampleAt(bounds.min().y(), bounds.max().y(), i),
                               SampleAt(bounds.min().z(), bounds.max().z(), j));
      const std::optional<LineHits> hits = HitsAlong(handle, 0, at);
      if (!hits || hits->first > back.rear_m + kBackDepth) continue;
      back.samples.push_back(at);
    }
  }
  // the outline itself comes from vertices: a back that is a thin ring may slip between samples
  for (const Eigen::Vector3d& vertex : handle.vertices) {
    if (vertex.x() > back.rear_m + kBackDepth) continue;
    outline.extend(Eigen::Vector2d(vertex.y(), vertex.z()));
    if (back.samples.empty()) back.samples.emplace_back(vertex.y(), vertex.z());
  }
  back.min_m = outline.min();
  back.max_m = outline.max();
  return back;
}

LeafSurface::LeafSurface(const TriangleMesh& leaf) : bounds(BoundsOf(leaf)), lines(leaf) {}

bool FitsOn(const LeafSurface& leaf, const BackOutline& back) {
  const Eigen::Vector2d room = leaf.bounds.sizes().tail<2>();
  return ((back.max_m - back.min_m).array() <= room.array()).all();
}

std::optional<double> SurfaceBehind(const LeafSurface& leaf, const BackOutline& back,
                                    const Eigen::Vector2d& at_m) {
  std::vector<double> surface;
  for (const Eigen::Vector2d& sample : back.samples) {
    const auto hits = leaf.lines.At(sample + at_m);
    if (hits) surface.push_back(hits->last);
  }
  if (surface.empty()) return std::nullopt;
  const auto at = surface.begin() + static_cast<std::ptrdiff_t>(
                                        kSeatQuantile * static_cast<double>(surface.size() - 1));
  std::nth_element(surface.begin(), at, surface.end());
  return *at;
}

std::optional<Eigen::Vector3d> SeatOn(const LeafSurface& leaf, const BackOutline& back,
                                      const Eigen::Vector3d& mount_m) {
  const Eigen::AlignedBox3d& bounds = leaf.bounds;
  Eigen::Vector3d seat = mount_m;
  for (int k = 0; k < 2; ++k) {
    const std::optional<double> shift =
        ShiftInto(mount_m[k + 1] + back.min_m[k], mount_m[k + 1] + back.max_m[k],
                  bounds.min()[k + 1], bounds.max()[k + 1]);
    if (!shift) return std::nullopt;
    seat[k + 1] += *shift;
  }
  const std::optional<double> surface = SurfaceBehind(leaf, back, seat.tail<2>());
  if (!surface) return std::nullopt;
  seat.x() = *surface - back.rear_m;
  return seat;
}

}  // namespace doorforge::internal
