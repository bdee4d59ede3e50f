// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/hull_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/mesh/work_budget.h"

#include "convex/convex_region.h"

namespace doorforge {
namespace {

// ---- the inside -------------------------------------------------------------------------------

bool IsThin(const TriangleMesh& hull, double cell_m) {
  double area = 0;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    area += 0.5 * (hull.vertices[static_cast<std::size_t>(t[1])] - a)
                      .cross(hull.vertices[static_cast<std::size_t>(t[2])] - a)
                      .norm();
  }
  return 2 * VolumeOf(hull) < 2 * cell_m * area;
}

// Descends from large blocks of cells to small ones, leaving out what holds nothing deeper than is
// known and what lies outside the hull. Of the faces those are asked that pass through the block.
class DeepestCell {
 public:
  DeepestCell(const TriangleMesh& hull, const DistanceGrid& solid, const DepthRange& range)
      : hull_(&hull),
        solid_(&solid),
        faces_(HalfSpacesOf(hull)),
        stop_m_(std::max(range.stop_m, range.above_m)),
        margin_m_(IsThin(hull, solid.grid().cell_m) ? 0.5 * solid.grid().cell_m : 0) {
    deepest_.depth_m = range.above_m;
    active_.resize(faces_.size());
    for (std::size_t i = 0; i < active_.size(); ++i) active_[i] = static_cast<int>(i);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : hull.vertices) box.extend(vertex);
    first_ = solid.grid().CellAt(box.min());
    last_ = solid.grid().CellAt(box.max());
  }

  // depth 0 where nothing is deeper than what counts
  Concavity Find() {
    const double known_m = deepest_.depth_m;
    // at a level where the hull's box takes few blocks
    const int longest = (last_ - first_).maxCoeff();
    int level = 0;
    while (level + 1 < solid_->levels() && longest >> level > 1) ++level;
    Eigen::Vector3i block;
    for (block.z() = first_.z() >> level; block.z() <= last_.z() >> level; ++block.z()) {
      for (block.y() = first_.y() >> level; block.y() <= last_.y() >> level; ++block.y()) {
        for (block.x() = first_.x() >> level; block.x() <= last_.x() >> level; ++block.x())
          Visit(level, block, 0, faces_.size());
      }
    }
    return deepest_.depth_m > known_m ? deepest_ : Concavity{};
  }

 private:
  // The active faces of the block that this one is part of are those from `begin` to `end`.
  void Visit(int level, const Eigen::Vector3i& block, std::size_t begin, std::size_t end) {
    if (solid_->LargestInBlock(level, block) <= deepest_.depth_m || deepest_.depth_m > stop_m_)
      return;
    const Eigen::Vector3i low = (block * (1 << level)).cwiseMax(first_);
    const Eigen::Vector3i high =
        (block * (1 << level) + Eigen::Vector3i::Constant((1 << level) - 1)).cwiseMin(last_);
    if ((low.array() > high.array()).any()) return;
    CheckWork(static_cast<unsigned>(end - begin) + 1);
    const Grid& grid = solid_->grid();
    const Eigen::Vector3d between = 0.5 * grid.cell_m * (high - low).cast<double>();
    const Eigen::Vector3d center = grid.CenterOf(low.x(), low.y(), low.z()) + between;
    const Eigen::Vector3d half = between + Eigen::Vector3d::Constant(margin_m_);
    const std::size_t kept = end;
    active_.resize(kept);
    for (std::size_t i = begin; i < end; ++i) {
      const HalfSpace& face = faces_[static_cast<std::size_t>(active_[i])];
      const double outside = face.normal.dot(center) - face.offset;
      const double reach = face.normal.cwiseAbs().dot(half);
      if (outside > reach) return;
      if (outside > -reach) active_.push_back(active_[i]);
    }
    if (low == high) {
      const double depth_m = solid_->DistanceAt(low.x(), low.y(), low.z());
      if (depth_m > deepest_.depth_m && (margin_m_ == 0 || Touches(center, kept)))
        deepest_ = {depth_m, center};
      return;
    }
    VisitParts(level - 1, block, kept, active_.size());
  }

  // Whether the hull, whose faces through the cell are the active ones from `begin` on, has a point
  // in the cell: all but those that no face keeps apart from it are known to have none.
  bool Touches(const Eigen::Vector3d& center, std::size_t begin) const {
    const bool holds_center = std::all_of(
        active_.begin() + static_cast<std::ptrdiff_t>(begin), active_.end(), [&](int index) {
          const HalfSpace& face = faces_[static_cast<std::size_t>(index)];
          return face.normal.dot(center) <= face.offset;
        });
    return holds_center ||
           std::any_of(hull_->triangles.begin(), hull_->triangles.end(),
                       [&](const Eigen::Vector3i& t) { return MeetsCell(t, center); });
  }

  // Cuts the triangle by the cell's six faces (Sutherland and Hodgman).
  bool MeetsCell(const Eigen::Vector3i& t, const Eigen::Vector3d& center) const {
    std::array<Eigen::Vector3d, 9> corners, kept;
    std::size_t count = 3;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = hull_->vertices[static_cast<std::size_t>(t[static_cast<int>(k)])] - center;
    for (int side = 0; side < 6 && count > 0; ++side) {
      const int axis = side / 2;
      const double sign = side % 2 == 0 ? 1 : -1;
      std::size_t found = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d& a = corners[i];
        const Eigen::Vector3d& b = corners[(i + 1) % count];
        const double da = margin_m_ - sign * a[axis];
        const double db = margin_m_ - sign * b[axis];
        if (da >= 0) kept[found++] = a;
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept[found++] = a + da / (da - db) * (b - a);
      }
      count = found;
      std::swap(corners, kept);
    }
    return count > 0;
  }

  // the one with the deepest cell first
  void VisitParts(int level, const Eigen::Vector3i& block, std::size_t begin, std::size_t end) {
    const Eigen::Vector3i count = solid_->BlocksAt(level);
    std::array<std::pair<float, Eigen::Vector3i>, 8> parts;
    std::size_t found = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i part =
          2 * block + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2);
      if ((part.array() >= count.array()).any()) continue;
      const float largest_m = solid_->LargestInBlock(level, part);
      if (largest_m > deepest_.depth_m) parts[found++] = {largest_m, part};
    }
    std::stable_sort(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(found),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; i < found; ++i) {
      active_.resize(end);
      Visit(level, parts[i].second, begin, end);
    }
  }

  const TriangleMesh* hull_;
  const DistanceGrid* solid_;
  std::vector<HalfSpace> faces_;
  double stop_m_;
  double margin_m_;  // around a cell's centre; 0 where centres alone count
  Concavity deepest_;
  std::vector<int> active_;       // a stack
  Eigen::Vector3i first_, last_;  // cells of the hull's box
};

// ---- the surface ------------------------------------------------------------------------------

struct Patch {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double reach_m = 0;  // from there to the farthest corner
  double bound_m = 0;  // nothing in it is deeper
};

// The deepest point of a hull's triangles, which are halved where they may hold it: depths change
// along the surface by no more than the way.
class DeepestOnSurface {
 public:
  // `slack_m` is how much deeper than the grid says a point may be.
  DeepestOnSurface(const DistanceGrid& solid, double above_m, double slack_m)
      : solid_(&solid), slack_m_(slack_m), worthwhile_m_(above_m) {
    deepest_.depth_m = above_m;
  }

  // To within `step_m` of its place and a part of its depth, or any that is deeper than `stop_m`.
  template <class DepthAt>
  Concavity Find(const TriangleMesh& hull, double step_m, double stop_m, const DepthAt& depth_at) {
    const double known_m = deepest_.depth_m;
    std::vector<Patch> triangles;
    for (const Eigen::Vector3i& t : hull.triangles) {
      Patch patch;
      for (int k = 0; k < 3; ++k)
        patch.corners[static_cast<std::size_t>(k)] = hull.vertices[static_cast<std::size_t>(t[k])];
      if (SetBound(patch, 1e300)) triangles.push_back(patch);
    }
    // what a deep one holds lets most others be left out
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const Patch& a, const Patch& b) { return a.bound_m > b.bound_m; });
    for (const Patch& triangle : triangles) {
      patches_.assign(1, triangle);
      while (!patches_.empty() && deepest_.depth_m <= stop_m) {
        const Patch patch = patches_.back();
        patches_.pop_back();
        Visit(patch, step_m, depth_at);
      }
    }
    return deepest_.depth_m > known_m ? deepest_ : Concavity{};
  }

 private:
  static constexpr double kAsked =
      2;  // steps; larger patches are halved without asking for a depth
  static constexpr double kWorthwhile = 0.03;  // of a depth: what must be left to look further

  template <class DepthAt>
  void Visit(const Patch& patch, double step_m, const DepthAt& depth_at) {
    if (patch.bound_m <= worthwhile_m_) return;
    CheckWork(5);
    double bound_m = patch.bound_m;
    if (patch.reach_m <= kAsked * step_m) {
      const double depth_m = depth_at(patch.center);
      if (depth_m > deepest_.depth_m) {
        deepest_ = {depth_m, patch.center};
        worthwhile_m_ = (1 + kWorthwhile) * depth_m;
      }
      if (depth_m > 0) bound_m = std::min(bound_m, depth_m + patch.reach_m);
    }
    if (patch.reach_m > step_m && bound_m > worthwhile_m_) Halve(patch, bound_m);
  }

  // False where nothing in the patch is of interest; `bound_m` is what is known of it already.
  bool SetBound(Patch& patch, double bound_m) const {
    patch.center = (patch.corners[0] + patch.corners[1] + patch.corners[2]) / 3;
    double squared = 0;
    for (const Eigen::Vector3d& corner : patch.corners)
      squared = std::max(squared, (corner - patch.center).squaredNorm());
    patch.reach_m = std::sqrt(squared);
    const Eigen::Vector3i cell = solid_->grid().CellAt(patch.center);
    patch.bound_m = std::min(
        bound_m, solid_->DistanceAt(cell.x(), cell.y(), cell.z()) + slack_m_ + patch.reach_m);
    return patch.bound_m > worthwhile_m_;
  }

  // across the longest side; the half with the higher bound comes first
  void Halve(const Patch& patch, double bound_m) {
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double squared = (patch.corners[(k + 1) % 3] - patch.corners[k]).squaredNorm();
      if (squared > most) most = squared, longest = k;
    }
    const std::size_t next = (longest + 1) % 3;
    const Eigen::Vector3d middle = 0.5 * (patch.corners[longest] + patch.corners[next]);
    Patch low = patch;
    Patch high = patch;
    low.corners[longest] = middle;
    high.corners[next] = middle;
    const bool keeps_low = SetBound(low, bound_m);
    const bool keeps_high = SetBound(high, bound_m);
    if (low.bound_m > high.bound_m) std::swap(low, high);
    if (keeps_low && keeps_high) patches_.push_back(low);
    if (keeps_low || keeps_high) patches_.push_back(high);
  }

  const DistanceGrid* solid_;
  double slack_m_;
  Concavity deepest_;
  double worthwhile_m_;         // what else is of interest is deeper
  std::vector<Patch> patches_;  // a stack
};

}  // namespace

Concavity ConcavityOf(const TriangleMesh& hull, const DistanceGrid& solid,
                      const DepthRange& range) {
  return DeepestCell(hull, solid, range).Find();
}

Concavity ProtrusionOf(const TriangleMesh& hull, MeasuredDistances& distances,
                       const DepthRange& range, double step_m) {
  const DistanceGrid& solid = distances.solid();
  const auto depth_at = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3i cell = solid.grid().CellAt(point);
    return solid.DistanceAt(cell.x(), cell.y(), cell.z()) > 0 ? distances.At(point) : 0.0;
  };
  return DeepestOnSurface(solid, range.above_m, std::sqrt(3.0) * solid.grid().cell_m)
      .Find(hull, step_m, std::max(range.stop_m, range.above_m), depth_at);
}

}  // namespace doorforge
