// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/hull_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
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
        faces_(FacesOf(hull)),
        active_(std::make_unique_for_overwrite<int[]>(
            faces_.size() * static_cast<std::size_t>(solid.levels() + 1))),
        stop_m_(std::max(range.stop_m, range.above_m)),
        step_m_(range.step_m),
        worthwhile_m_(range.above_m),
        margin_m_(IsThin(hull, solid.grid().cell_m) ? 0.5 * solid.grid().cell_m : 0) {
    deepest_.depth_m = range.above_m;
    std::iota(active_.get(), active_.get() + faces_.size(), 0);
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
          Visit(level, block, {active_.get(), faces_.size()});
      }
    }
    return deepest_.depth_m > known_m ? deepest_ : Concavity{};
  }

 private:
  struct Face {
    HalfSpace half_space;
    Eigen::Vector3d lengths;  // of its normal's components
  };

  static std::vector<Face> FacesOf(const TriangleMesh& hull) {
    std::vector<Face> faces;
    for (const HalfSpace& face : HalfSpacesOf(hull))
      faces.push_back({face, face.normal.cwiseAbs()});
    return faces;
  }

  // Those of the block that this one is part of are active. Its own are written behind them.
  void Visit(int level, const Eigen::Vector3i& block, std::span<int> active) {
    if (solid_->LargestInBlock(level, block) <= worthwhile_m_ || deepest_.depth_m > stop_m_) return;
    const Eigen::Vector3i low = (block * (1 << level)).cwiseMax(first_);
    const Eigen::Vector3i high =
        (block * (1 << level) + Eigen::Vector3i::Constant((1 << level) - 1)).cwiseMin(last_);
    if ((low.array() > high.array()).any()) return;
    CheckWork(static_cast<unsigned>(active.size()) + 1);
    const Grid& grid = solid_->grid();
    const Eigen::Vector3d between = 0.5 * grid.cell_m * (high - low).cast<double>();
    const Eigen::Vector3d center = grid.CenterOf(low.x(), low.y(), low.z()) + between;
    const Eigen::Vector3d half = between + Eigen::Vector3d::Constant(margin_m_);
    // the face that had the last block outside often has the next
    if (!faces_.empty() && OutsideOf(parting_, center) > ReachOver(parting_, half)) return;
    int* const own = active.data() + active.size();
    std::size_t count = 0;
    for (const int index : active) {
      const double outside = OutsideOf(index, center);
      const double reach = ReachOver(index, half);
      if (outside > reach) {
        parting_ = index;
        return;
      }
      if (outside > -reach) own[count++] = index;
    }
    if (low == high) {
      const double depth_m = solid_->DistanceAt(low.x(), low.y(), low.z());
      if (depth_m > worthwhile_m_ && (margin_m_ == 0 || Touches(center, {own, count}))) {
        deepest_ = {depth_m, center};
        worthwhile_m_ = depth_m + step_m_;
      }
      return;
    }
    VisitParts(level - 1, block, {own, count});
  }

  double OutsideOf(int index, const Eigen::Vector3d& center) const {
    const HalfSpace& face = faces_[static_cast<std::size_t>(index)].half_space;
    return face.normal.dot(center) - face.offset;
  }
  double ReachOver(int index, const Eigen::Vector3d& half) const {
    return faces_[static_cast<std::size_t>(index)].lengths.dot(half);
  }

  // Whether the hull, whose faces through the cell are active, has a point in the cell: all but
  // those that no face keeps apart from it are known to have none.
  bool Touches(const Eigen::Vector3d& center, std::span<const int> active) const {
    const bool holds_center = std::all_of(active.begin(), active.end(), [&](int index) {
      const HalfSpace& face = faces_[static_cast<std::size_t>(index)].half_space;
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
  void VisitParts(int level, const Eigen::Vector3i& block, std::span<int> active) {
    const Eigen::Vector3i count = solid_->BlocksAt(level);
    std::array<std::pair<float, Eigen::Vector3i>, 8> parts;
    std::size_t found = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i part =
          2 * block + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2);
      if ((part.array() >= count.array()).any()) continue;
      const float largest_m = solid_->LargestInBlock(level, part);
      if (!(largest_m > worthwhile_m_)) continue;
      std::size_t place = found++;  // behind those that are no less
      for (; place > 0 && parts[place - 1].first < largest_m; --place)
        parts[place] = parts[place - 1];
      parts[place] = {largest_m, part};
    }
    for (std::size_t i = 0; i < found; ++i) Visit(level, parts[i].second, active);
  }

  const TriangleMesh* hull_;
  const DistanceGrid* solid_;
  std::vector<Face> faces_;
  std::unique_ptr<int[]> active_;  // a stack: of each level no more than all faces
  int parting_ = 0;
  double stop_m_;
  double step_m_;
  double worthwhile_m_;  // what else is of interest is deeper
  double margin_m_;      // around a cell's centre; 0 where centres alone count
  Concavity deepest_;
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
  DeepestOnSurface(MeasuredDistances& distances, double above_m)
      : distances_(&distances),
        solid_(&distances.solid()),
        far_(&distances.FarCells(above_m)),
        slack_m_(distances.MostBeyondGrid()),
        worthwhile_m_(above_m) {
    deepest_.depth_m = above_m;
  }

  // To within `step_m` of its place and a part of its depth, or any that is deeper than `stop_m`.
  // Where the depth to stop at is known, larger steps look first: they find most of what is deeper
  // with a small part of the work.
  Concavity Find(const TriangleMesh& hull, double step_m, double stop_m) {
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
    for (double larger = stop_m < kNoStop ? kLargestStep : 1; larger >= 1; larger /= kFiner) {
      for (const Patch& triangle : triangles) {
        patches_.assign(1, triangle);
        while (!patches_.empty() && deepest_.depth_m <= stop_m) {
          const Patch patch = patches_.back();
          patches_.pop_back();
          Visit(patch, larger * step_m);
        }
      }
    }
    return deepest_.depth_m > known_m ? deepest_ : Concavity{};
  }

 private:
  static constexpr double kMeasured = 8;       // steps; larger patches are halved without measuring
  static constexpr double kAsked = 2;          // steps; larger ones without asking for a depth
  static constexpr double kWorthwhile = 0.03;  // of a depth: what must be left to look further
  static constexpr double kLargestStep = 64;   // steps: the first where there is a depth to stop at
  static constexpr double kFiner = 8;          // by which the next are smaller
  static constexpr std::uint64_t kStepsOfPatch = 5;

  void Visit(const Patch& patch, double step_m) {
    if (patch.bound_m <= worthwhile_m_) return;
    CheckWork(5);
    double bound_m = patch.bound_m;
    const bool is_last = patch.reach_m <= step_m;
    if (!is_last && patch.reach_m <= kMeasured * step_m &&
        distances_->NoneBeyond(patch.corners, worthwhile_m_))
      return;
    if (patch.reach_m <= kAsked * step_m) {
      const double depth_m = DepthAt(patch.center);
      if (depth_m > deepest_.depth_m) {
        deepest_ = {depth_m, patch.center};
        worthwhile_m_ = (1 + kWorthwhile) * depth_m;
      }
      if (depth_m > 0) bound_m = std::min(bound_m, depth_m + patch.reach_m);
    }
    if (!is_last && bound_m > worthwhile_m_) Halve(patch, bound_m);
  }

  double DepthAt(const Eigen::Vector3d& point) {
    const Eigen::Vector3i cell = solid_->grid().CellAt(point);
    return solid_->DistanceAt(cell.x(), cell.y(), cell.z()) > 0 ? distances_->At(point) : 0;
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
    // much of a hull lies on the solid, where it would be halved down to cells
    if (patch.bound_m > worthwhile_m_ && !MayBeDeep(patch)) patch.bound_m = 0;
    return patch.bound_m > worthwhile_m_;
  }

  // False where no cell that the patch has a point in is far.
  bool MayBeDeep(const Patch& patch) const {
    constexpr double kRounding = 1e-7;  // cells: of corners and centres of patches
    const Eigen::Array3d a = patch.corners[0], b = patch.corners[1], c = patch.corners[2];
    const double margin_m = kRounding * solid_->grid().cell_m;
    distances_->Took(kStepsOfPatch);
    return far_->AnyBetween(solid_->grid().CellAt(a.min(b).min(c) - margin_m),
                            solid_->grid().CellAt(a.max(b).max(c) + margin_m));
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
    const bool low_first = low.bound_m > high.bound_m;
    if (keeps_low && keeps_high) patches_.push_back(low_first ? high : low);
    if (keeps_low || keeps_high) patches_.push_back(low_first ? low : high);
  }

  MeasuredDistances* distances_;
  const DistanceGrid* solid_;
  const MarkedCells* far_;  // no point of other cells is deeper than what counts
  double slack_m_;          // how much deeper than the grid says a point may be
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
  return DeepestOnSurface(distances, range.above_m)
      .Find(hull, step_m, std::max(range.stop_m, range.above_m));
}

}  // namespace doorforge
