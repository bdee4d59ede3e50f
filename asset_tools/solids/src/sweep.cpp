// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/solids/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

constexpr int kSectionPoints = 20;

void SetLengths(std::vector<PathPoint>& path) {
  for (std::size_t i = 1; i < path.size(); ++i)
    path[i].length_m = path[i - 1].length_m + (path[i].position_m - path[i - 1].position_m).norm();
}

// The arc that replaces a corner between the unit directions `in` and `out`.
std::vector<PathPoint> Arc(const Eigen::Vector3d& corner, const Eigen::Vector3d& in,
                           const Eigen::Vector3d& out, double radius_m) {
  const double turn = std::acos(std::clamp(in.dot(out), -1.0, 1.0));
  const Eigen::Vector3d axis = in.cross(out).normalized();
  const Eigen::Vector3d start = corner - in * radius_m * std::tan(turn / 2);
  const Eigen::Vector3d center = start + axis.cross(in) * radius_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(turn / (std::numbers::pi / 12) - 1e-9)));
  std::vector<PathPoint> points;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::AngleAxisd rotation(turn * i / steps, axis);
    points.push_back({center + rotation * (start - center), rotation * in});
  }
  return points;
}

Ring SectionRing(const PathPoint& at, const Eigen::Vector3d& up, const Section& section) {
  const Eigen::Vector3d v = (up - at.tangent * at.tangent.dot(up)).normalized();
  const Eigen::Vector3d u = v.cross(at.tangent);
  const double power = 2 / section.exponent;
  Ring ring;
  for (int k = 0; k < kSectionPoints; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / kSectionPoints;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    ring.push_back(at.position_m +
                   u * (section.half_width_m * std::copysign(std::pow(std::abs(c), power), c)) +
                   v * (section.half_height_m * std::copysign(std::pow(std::abs(s), power), s)));
  }
  return ring;
}

// A rounded end beyond the last ring.
void AddDome(const PathPoint& last, const Eigen::Vector3d& up, const Section& end, double dome_m,
             std::vector<Ring>& rings) {
  if (dome_m <= 0) return;
  for (const double degrees : {25.0, 50.0, 72.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    PathPoint beyond = last;
    beyond.position_m += beyond.tangent * (dome_m * std::sin(angle));
    rings.push_back(SectionRing(
        beyond, up,
        {end.half_width_m * std::cos(angle), end.half_height_m * std::cos(angle), end.exponent}));
  }
}

Ring LatheRing(const LathePoint& at, const LatheShape& shape, double largest_radius_m) {
  Ring ring;
  for (int k = 0; k < shape.sides; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / shape.sides;
    const double depth = shape.flute_depth_m * at.radius_m / largest_radius_m;
    const double radius = at.radius_m - depth * (0.5 - 0.5 * std::cos(shape.flutes * angle));
    const double power = 2 / shape.squareness;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    ring.emplace_back(at.x_m, radius * std::copysign(std::pow(std::abs(c), power), c),
                      shape.aspect * radius * std::copysign(std::pow(std::abs(s), power), s));
  }
  return ring;
}

// Fewer profile points for collision: those in between that stick out by less than `tolerance_m`
// from the chord are left out (Douglas and Peucker, 1973).
void Thin(const std::vector<LathePoint>& profile, std::size_t first, std::size_t last,
          std::vector<bool>& keep) {
  const Eigen::Vector2d a(profile[first].x_m, profile[first].radius_m);
  const Eigen::Vector2d b(profile[last].x_m, profile[last].radius_m);
  const Eigen::Vector2d normal = Eigen::Vector2d(-(b - a).y(), (b - a).x()).normalized();
  double farthest = 4e-4;
  std::size_t split = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const Eigen::Vector2d p(profile[i].x_m, profile[i].radius_m);
    const double distance = std::abs(normal.dot(p - a));
    if (distance <= farthest) continue;
    farthest = distance;
    split = i;
  }
  if (split == first) return;
  keep[split] = true;
  Thin(profile, first, split, keep);
  Thin(profile, split, last, keep);
}

std::vector<TriangleMesh> LatheHulls(const std::vector<LathePoint>& profile,
                                     const LatheShape& shape, int sides) {
  std::vector<bool> keep(profile.size(), false);
  keep.front() = keep.back() = true;
  Thin(profile, 0, profile.size() - 1, keep);
  const double outside = 1 / std::cos(std::numbers::pi / sides);
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (!keep[i]) continue;
    const LathePoint around{profile[i].x_m, (profile[i].radius_m + 4e-4) * outside};
    rings.push_back(
        LatheRing(around, {sides, 0, 0, shape.squareness, shape.aspect}, around.radius_m));
  }
  return LoftHulls(rings, 0.0012);
}

}  // namespace

std::vector<PathPoint> FilletedPath(const std::vector<Eigen::Vector3d>& corners, double radius_m) {
  Require(corners.size() >= 2, ErrorCode::kInvalidArgument, "a path needs two points");
  std::vector<PathPoint> path = {{corners[0], (corners[1] - corners[0]).normalized()}};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Eigen::Vector3d in = corners[i] - corners[i - 1];
    const Eigen::Vector3d out = corners[i + 1] - corners[i];
    const double turn = std::acos(std::clamp(in.normalized().dot(out.normalized()), -1.0, 1.0));
    if (turn < 1e-6) {
      path.push_back({corners[i], in.normalized()});
      continue;
    }
    const double room = 0.49 * std::min(in.norm(), out.norm()) / std::tan(turn / 2);
    const std::vector<PathPoint> arc =
        Arc(corners[i], in.normalized(), out.normalized(), std::min(radius_m, room));
    path.insert(path.end(), arc.begin(), arc.end());
  }
  path.push_back({corners.back(), (corners.back() - corners[corners.size() - 2]).normalized()});
  SetLengths(path);
  return path;
}

std::vector<PathPoint> SmoothPath(const std::vector<Eigen::Vector3d>& points,
                                  const Eigen::Vector3d& first, const Eigen::Vector3d& last) {
  std::vector<PathPoint> path;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3d tangent = first;
    if (i + 1 == points.size()) tangent = last;
    if (i > 0 && i + 1 < points.size()) tangent = points[i + 1] - points[i - 1];
    path.push_back({points[i], tangent.normalized()});
  }
  SetLengths(path);
  return path;
}

std::vector<Ring> SweepRings(const std::vector<PathPoint>& path, const Eigen::Vector3d& up,
                             const std::function<Section(double)>& section, double dome_m) {
  const double total = path.back().length_m;
  std::vector<Ring> rings;
  for (const PathPoint& point : path)
    rings.push_back(SectionRing(point, up, section(point.length_m / total)));
  AddDome(path.back(), up, section(1), dome_m, rings);
  return rings;
}

std::vector<Ring> TransportedSweepRings(const std::vector<PathPoint>& path,
                                        const Eigen::Vector3d& up,
                                        const std::function<Section(double)>& section,
                                        double dome_m) {
  const double total = path.back().length_m;
  Eigen::Vector3d carried = up;
  std::vector<Ring> rings;
  for (const PathPoint& point : path) {
    carried = (carried - point.tangent * point.tangent.dot(carried)).normalized();
    rings.push_back(SectionRing(point, carried, section(point.length_m / total)));
  }
  AddDome(path.back(), carried, section(1), dome_m, rings);
  return rings;
}

Solid LatheSolid(const std::vector<LathePoint>& profile, const LatheShape& shape) {
  double largest = 0;
  for (const LathePoint& point : profile) largest = std::max(largest, point.radius_m);
  std::vector<Ring> rings;
  for (const LathePoint& point : profile) rings.push_back(LatheRing(point, shape, largest));
  const bool faceted = shape.sides <= 12;
  return {Loft(rings), faceted ? LoftHulls(rings, 0.0012)
                               : LatheHulls(profile, shape, shape.squareness > 2 ? 20 : 12)};
}

}  // namespace doorforge::internal
