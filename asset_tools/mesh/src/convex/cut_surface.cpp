// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/cut_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

namespace doorforge {
namespace {

Eigen::Vector3d DoubledAreaOf(std::span<const Eigen::Vector3d> corners) {
  Eigen::Vector3d doubled = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    doubled += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return doubled;
}

bool IsBefore(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

bool BelongsTo(const CutSide& side, const Eigen::Vector3d& point,
               const CutSurface::IsNotedFor& is_noted_for) {
  const double reach_m = side.ReachInto(point);
  return reach_m > 0 || (reach_m == 0 && is_noted_for(point));
}

}  // namespace

void CutSurface::AddPolygon(std::span<const Eigen::Vector3d> corners, double wall_m) {
  Polygon polygon{corners_.size(), corners.size(), wall_m, DoubledAreaOf(corners), 0, {}};
  polygon.area_m2 = 0.5 * polygon.doubled_area.norm();
  for (const Eigen::Vector3d& corner : corners) {
    polygon.box.extend(corner);
    corners_.push_back(static_cast<int>(points_.size()));
    points_.push_back(corner);
  }
  polygons_.push_back(polygon);
}

void CutSurface::AddNotedPoint(const Eigen::Vector3d& point) {
  noted_.push_back(static_cast<int>(points_.size()));
  points_.push_back(point);
}

void CutSurface::Append(const CutSurface& other) {
  const auto first_point = static_cast<int>(points_.size());
  const std::size_t first_corner = corners_.size();
  points_.insert(points_.end(), other.points_.begin(), other.points_.end());
  for (const int index : other.corners_) corners_.push_back(first_point + index);
  for (const int index : other.noted_) noted_.push_back(first_point + index);
  for (Polygon polygon : other.polygons_) {
    polygon.first += first_corner;
    polygons_.push_back(polygon);
  }
}

void CutSurface::Weld() {
  std::vector<int> order(points_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int i) -> const Eigen::Vector3d& {
    return points_[static_cast<std::size_t>(i)];
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return IsBefore(at(a), at(b)); });
  std::vector<Eigen::Vector3d> kept;
  std::vector<int> place(points_.size());
  for (const int index : order) {
    if (kept.empty() || kept.back() != at(index)) kept.push_back(at(index));
    place[static_cast<std::size_t>(index)] = static_cast<int>(kept.size()) - 1;
  }
  for (int& corner : corners_) corner = place[static_cast<std::size_t>(corner)];
  for (int& noted : noted_) noted = place[static_cast<std::size_t>(noted)];
  std::sort(noted_.begin(), noted_.end());
  noted_.erase(std::unique(noted_.begin(), noted_.end()), noted_.end());
  points_ = std::move(kept);
}

bool CutSurface::IsSkinOfOtherSide(const Polygon& polygon, const CutSide& side,
                                   double skin_m) const {
  const int axis = side.cut.axis;
  const double reach_m = side.ReachInto(side.sign < 0 ? polygon.box.min() : polygon.box.max());
  return reach_m <= std::min(skin_m, 0.5 * polygon.wall_m) &&
         side.sign * polygon.doubled_area[axis] >= -polygon.area_m2;
}

void CutSurface::Clip(const Polygon& polygon, const CutSide& side,
                      std::vector<Eigen::Vector3d>& clipped) const {
  clipped.clear();
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Eigen::Vector3d& a = Corner(polygon, i);
    const Eigen::Vector3d& b = Corner(polygon, i + 1 < polygon.count ? i + 1 : 0);
    const double da = side.ReachInto(a);
    const double db = side.ReachInto(b);
    if (da >= 0) clipped.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      Eigen::Vector3d crossing = a + da / (da - db) * (b - a);
      crossing[side.cut.axis] = side.cut.position_m;
      clipped.push_back(crossing);
    }
  }
}

CutSurface CutSurface::Side(const CutSide& side, double skin_m,
                            const IsNotedFor& is_noted_for) const {
  CutSurface kept;
  std::vector<Eigen::Vector3d> clipped;
  for (const Polygon& polygon : polygons_) {
    if (IsSkinOfOtherSide(polygon, side, skin_m)) continue;
    Clip(polygon, side, clipped);
    if (!clipped.empty()) kept.AddPolygon(clipped, polygon.wall_m);
  }
  for (const int index : noted_) {
    const Eigen::Vector3d& point = points_[static_cast<std::size_t>(index)];
    if (BelongsTo(side, point, is_noted_for)) kept.AddNotedPoint(point);
  }
  kept.Weld();
  return kept;
}

void CutSurface::FindSide(const CutSide& side, double skin_m, const IsNotedFor& is_noted_for,
                          SideContent& content) const {
  content.points.clear();
  content.area_m2 = 0;
  std::vector<char> taken(points_.size(), 0);
  std::vector<Eigen::Vector3d> clipped;
  for (const Polygon& polygon : polygons_) {
    const double most_m = side.ReachInto(side.sign < 0 ? polygon.box.min() : polygon.box.max());
    if (most_m < 0 || IsSkinOfOtherSide(polygon, side, skin_m)) continue;
    const double least_m = side.ReachInto(side.sign < 0 ? polygon.box.max() : polygon.box.min());
    if (least_m < 0) {
      Clip(polygon, side, clipped);
      content.points.insert(content.points.end(), clipped.begin(), clipped.end());
      content.area_m2 += 0.5 * DoubledAreaOf(clipped).norm();
      continue;
    }
    content.area_m2 += polygon.area_m2;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const auto index = static_cast<std::size_t>(corners_[polygon.first + i]);
      if (taken[index]) continue;
      taken[index] = 1;
      content.points.push_back(points_[index]);
    }
  }
  for (const int index : noted_) {
    const Eigen::Vector3d& point = points_[static_cast<std::size_t>(index)];
    if (BelongsTo(side, point, is_noted_for)) content.points.push_back(point);
  }
}

CutSurface CutSurface::Without(
    const std::function<bool(std::span<const Eigen::Vector3d>)>& is_held) const {
  CutSurface kept;
  std::vector<Eigen::Vector3d> corners;
  for (const Polygon& polygon : polygons_) {
    corners.clear();
    for (std::size_t i = 0; i < polygon.count; ++i) corners.push_back(Corner(polygon, i));
    if (!is_held(corners)) kept.AddPolygon(corners, polygon.wall_m);
  }
  for (const int index : noted_) kept.AddNotedPoint(points_[static_cast<std::size_t>(index)]);
  kept.Weld();
  return kept;
}

std::vector<CutSurface::Face> CutSurface::FacesAcross(int axis, double bin_m,
                                                      std::size_t most) const {
  struct Bin {
    double area = 0;
    double moment = 0;
  };
  constexpr double kAcross = 0.98;  // cosine of the angle between a face's normal and the axis
  std::map<std::pair<std::int64_t, bool>, Bin> bins;
  for (const Polygon& polygon : polygons_) {
    const double along = polygon.doubled_area[axis];
    if (!(polygon.area_m2 > 0) || std::abs(along) < 2 * kAcross * polygon.area_m2) continue;
    double position = 0;
    for (std::size_t i = 0; i < polygon.count; ++i)
      position += Corner(polygon, i)[axis] / static_cast<double>(polygon.count);
    Bin& bin = bins[{std::llround(position / bin_m), along > 0}];
    bin.area += polygon.area_m2;
    bin.moment += polygon.area_m2 * position;
  }
  std::vector<Face> faces;
  faces.reserve(bins.size());
  for (const auto& [index, bin] : bins) faces.push_back({bin.moment / bin.area, bin.area});
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.area_m2 > b.area_m2; });
  if (faces.size() > most) faces.resize(most);
  return faces;
}

}  // namespace doorforge
