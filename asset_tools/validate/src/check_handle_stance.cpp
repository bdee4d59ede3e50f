// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "check_handle_stance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>

#include "doorforge/core/mesh_transform.h"

namespace doorforge::internal {
namespace {

constexpr int kLinesPerSide = 40;

double SampleAt(double low, double high, int i) {
  return low + (high - low) * (i + 0.5) / kLinesPerSide;
}

/// Weighs the points of a surface by their area.
struct SurfaceMoments {
  double area = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void Add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const double part = (b - a).cross(c - a).norm() / 2;
    const Eigen::Vector3d sum = a + b + c;
    area += part;
    first += part / 3 * sum;
    second += part / 12 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }

  Eigen::Matrix3d Spread() const {
    const Eigen::Vector3d middle = first / area;
    return second / area - middle * middle.transpose();
  }
};

using Polygon = std::vector<Eigen::Vector3d>;

// What of a convex polygon lies at x and beyond.
Polygon InFrontOf(const Polygon& polygon, double x) {
  Polygon front;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& at = polygon[i];
    const Eigen::Vector3d& next = polygon[(i + 1) % polygon.size()];
    if (at.x() >= x) front.push_back(at);
    if ((at.x() >= x) == (next.x() >= x)) continue;
    front.emplace_back(at + (x - at.x()) / (next.x() - at.x()) * (next - at));
  }
  return front;
}

// This tilt is that of the direction in which what lies at x and beyond is longest.
double TiltBeyond(const TriangleMesh& mesh, double x) {
  SurfaceMoments moments;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Polygon front = InFrontOf({corner(0), corner(1), corner(2)}, x);
    for (std::size_t i = 2; i < front.size(); ++i) moments.Add(front[0], front[i - 1], front[i]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.Spread());
  return std::asin(std::min(1.0, std::abs(axes.eigenvectors().col(2).x())));
}

// The gap is measured where leaf and handle come nearest on a line through both.
double NearestLine(const LeafLines& leaf, const TriangleMesh& handle) {
  const Eigen::AlignedBox3d bounds = BoundsOf(handle);
  const LinesAlongX lines(handle);
  const double front = leaf.bounds.isEmpty() ? 0 : leaf.bounds.max().x();
  double gap = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kLinesPerSide; ++i) {
    for (int j = 0; j < kLinesPerSide; ++j) {
      const Eigen::Vector2d at(SampleAt(bounds.min().y(), bounds.max().y(), i),
                               SampleAt(bounds.min().z(), bounds.max().z(), j));
      const auto near = lines.At(at);
      if (!near || near->first - front >= gap) continue;  // no leaf is nearer than its bounds
      const auto behind = leaf.lines.At(at);
      if (behind) gap = std::min(gap, near->first - behind->last);
    }
  }
  return gap;
}

// The least of what it can be: from the leaf at the mount, from the leaf right behind what stands
// out, and from where it touches the leaf. A curved leaf falls away from the first, an opening in
// it from the first two.
double ReachOf(const StandingHandle& standing, double gap) {
  const Eigen::AlignedBox3d bounds = BoundsOf(standing.grip);
  const double whole = bounds.max().x() - BoundsOf(standing.handle).min().x();
  double from_behind = -std::numeric_limits<double>::infinity();
  const Eigen::AlignedBox3d& leaf = standing.leaf.bounds;
  for (const Eigen::Vector3d& vertex : standing.grip.vertices) {
    if (leaf.isEmpty() || vertex.x() - leaf.min().x() <= from_behind) continue;
    const auto behind = standing.leaf.lines.At({vertex.y(), vertex.z()});
    if (behind) from_behind = std::max(from_behind, vertex.x() - behind->last);
  }
  const double from_mount = bounds.max().x() - standing.surface_m;
  const double reach = std::min(from_mount, whole + std::max(gap, 0.0));
  return std::isfinite(from_behind) ? std::min(reach, from_behind) : reach;
}

Findings CheckReach(const StandingHandle& standing, double gap) {
  const double reach = ReachOf(standing, gap);
  if (reach <= LimitOf("HND009")) return {};
  return {Found("HND009", "handle", Number(reach) + " m")};
}

Findings CheckContact(const StandingHandle& standing, double gap) {
  if (!standing.on_leaf || !standing.leaf.closed) return {};  // faults of other rules
  if (gap <= LimitOf("HND010")) return {};
  return {Found("HND010", "handle",
                std::isfinite(gap) ? Number(gap) + " m" : "nothing of the leaf behind it")};
}

Findings CheckTilt(const StandingHandle& standing) {
  if (standing.mechanism != Mechanism::kLever) return {};
  const double tilt = TiltFromLeaf(standing.grip);
  if (tilt <= LimitOf("HND011")) return {};
  return {Found("HND011", "handle",
                Number(tilt) + " rad (" + Number(tilt * 180 / std::numbers::pi) + " degrees)")};
}

}  // namespace

double GapToLeaf(const LeafLines& leaf, const TriangleMesh& handle) {
  double gap = NearestLine(leaf, handle);
  // a thin edge may lie between the lines
  for (const Eigen::Vector3d& vertex : handle.vertices) {
    if (leaf.bounds.isEmpty() || vertex.x() - leaf.bounds.max().x() >= gap) continue;
    const auto behind = leaf.lines.At({vertex.y(), vertex.z()});
    if (behind) gap = std::min(gap, vertex.x() - behind->last);
  }
  return gap;
}

double TiltFromLeaf(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3d bounds = BoundsOf(mesh);
  const double middle = (bounds.min().x() + bounds.max().x()) / 2;
  return std::min(TiltBeyond(mesh, bounds.min().x()), TiltBeyond(mesh, middle));
}

Findings CheckStance(const StandingHandle& standing) {
  const double gap = GapToLeaf(standing.leaf, standing.handle);
  Findings findings = CheckReach(standing, gap);
  for (const Findings& more : {CheckContact(standing, gap), CheckTilt(standing)})
    findings.insert(findings.end(), more.begin(), more.end());
  return findings;
}

}  // namespace doorforge::internal
