// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/solids/relief.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

namespace doorforge::internal {
namespace {

using Lines = std::vector<double>;

bool Contains(const Rectangle& r, const Eigen::Vector2d& p) {
  return (p.array() > r.min_m.array()).all() && (p.array() < r.max_m.array()).all();
}

// Distance from a point inside to the nearest side; negative outside, where it is the distance in
// the larger of the two directions, so that the lines of equal distance are rectangles.
double InnerDistance(const Rectangle& r, const Eigen::Vector2d& p) {
  return std::min((p - r.min_m).minCoeff(), (r.max_m - p).minCoeff());
}

double HeightAt(const ReliefProfile& profile, double distance) {
  if (distance <= profile.front().distance_m) return profile.front().height_m;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const ReliefStep& a = profile[i - 1];
    const ReliefStep& b = profile[i];
    if (distance < b.distance_m)
      return a.height_m +
             (b.height_m - a.height_m) * (distance - a.distance_m) / (b.distance_m - a.distance_m);
  }
  return profile.back().height_m;
}

// A quarter circle that begins `radius` below the face and ends level with it.
ReliefProfile RoundedEdge(double radius_m) {
  ReliefProfile profile;
  for (const double degrees : {0.0, 30.0, 60.0, 90.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    profile.push_back({radius_m * (1 - std::cos(angle)), radius_m * (std::sin(angle) - 1)});
  }
  return profile;
}

class Relief {
 public:
  explicit Relief(const ReliefSlab& slab) : slab_(slab), edge_(RoundedEdge(slab.edge_radius_m)) {
    for (int axis = 0; axis < 2; ++axis) {
      lines_[axis] = FineLines(axis);
      coarse_[axis] = CoarseLines(axis);
    }
  }

  struct Depth {
    double front;
    double back;
  };

  TriangleMesh Mesh();
  std::vector<TriangleMesh> Hulls(double tolerance_m) const;

 private:
  // A rectangle of coarse cells with one range of depth.
  struct Block {
    std::size_t y0, y1, z0, z1;
    Depth depth;
  };

  Lines FineLines(int axis) const;
  Lines CoarseLines(int axis) const;
  double FieldHeight(const Eigen::Vector2d& p, bool front) const;
  double Ground(const Eigen::Vector2d& p) const;
  Depth At(const Eigen::Vector2d& p) const;
  bool Filled(const Lines& ys, const Lines& zs, int i, int j) const;
  int Node(int i, int j, bool front);
  void AddCell(int i, int j, bool front);
  void AddWall(int i0, int j0, int i1, int j1);
  Depth CellDepth(std::size_t i, std::size_t j) const;
  std::vector<Block> RowOfBlocks(std::size_t j, double tolerance_m) const;
  std::vector<Block> Blocks(double tolerance_m) const;

  const ReliefSlab& slab_;
  ReliefProfile edge_;
  Lines lines_[2];
  Lines coarse_[2];
  TriangleMesh mesh_;
  std::map<std::pair<std::pair<int, int>, bool>, int> nodes_;
};

// Ascending, without repetition, within [low, high].
Lines Sorted(Lines lines, double low, double high) {
  std::sort(lines.begin(), lines.end());
  Lines kept;
  for (const double line : lines) {
    if (line < low - 1e-9 || line > high + 1e-9) continue;
    if (kept.empty() || line - kept.back() > 1e-6) kept.push_back(line);
  }
  return kept;
}

// Lines at every distance where a profile bends, on both sides of a rectangle.
void AddLines(const Rectangle& r, const ReliefProfile& profile, int axis, bool inside,
              Lines& lines) {
  for (const ReliefStep& step : profile) {
    const double inset = inside ? step.distance_m : -step.distance_m;
    const double low = r.min_m[axis] + inset;
    const double high = r.max_m[axis] - inset;
    if (low > high) continue;
    lines.push_back(low);
    lines.push_back(high);
  }
}

Lines Relief::FineLines(int axis) const {
  Lines lines;
  AddLines(slab_.outline, edge_, axis, true, lines);
  for (const ReliefField& field : slab_.fields)
    AddLines(field.area, field.profile, axis, true, lines);
  for (const Rectangle& opening : slab_.openings) AddLines(opening, edge_, axis, false, lines);
  lines.insert(lines.end(), slab_.extra_cuts_m[axis].begin(), slab_.extra_cuts_m[axis].end());
  return Sorted(lines, slab_.outline.min_m[axis], slab_.outline.max_m[axis]);
}

Lines Relief::CoarseLines(int axis) const {
  Lines lines = {slab_.outline.min_m[axis], slab_.outline.max_m[axis]};
  const auto add = [&](const Rectangle& r) {
    lines.push_back(r.min_m[axis]);
    lines.push_back(r.max_m[axis]);
  };
  for (const ReliefField& field : slab_.fields) {
    add(field.area);
    // where a field ends higher or lower than the ground, its flat part is a piece of its own
    AddLines(field.area, {field.profile.back()}, axis, true, lines);
  }
  for (const Rectangle& opening : slab_.openings) add(opening);
  return Sorted(lines, slab_.outline.min_m[axis], slab_.outline.max_m[axis]);
}

double Relief::FieldHeight(const Eigen::Vector2d& p, bool front) const {
  double height = 0;
  for (const ReliefField& field : slab_.fields) {
    if (field.side == (front ? ReliefSide::kBack : ReliefSide::kFront)) continue;
    const double distance = InnerDistance(field.area, p);
    if (distance > 0) height += HeightAt(field.profile, distance);
  }
  return height;
}

// Height of the rounded ground, at most 0.
double Relief::Ground(const Eigen::Vector2d& p) const {
  if (slab_.edge_radius_m <= 0) return 0;
  double height = HeightAt(edge_, InnerDistance(slab_.outline, p));
  for (const Rectangle& opening : slab_.openings)
    height = std::min(height, HeightAt(edge_, -InnerDistance(opening, p)));
  return height;
}

Relief::Depth Relief::At(const Eigen::Vector2d& p) const {
  const double ground = Ground(p);
  return {ground + FieldHeight(p, true), -slab_.thickness_m - ground - FieldHeight(p, false)};
}

bool Relief::Filled(const Lines& ys, const Lines& zs, int i, int j) const {
  if (i < 0 || j < 0 || i + 1 >= static_cast<int>(ys.size()) ||
      j + 1 >= static_cast<int>(zs.size()))
    return false;
  const auto y = static_cast<std::size_t>(i);
  const auto z = static_cast<std::size_t>(j);
  const Eigen::Vector2d center((ys[y] + ys[y + 1]) / 2, (zs[z] + zs[z + 1]) / 2);
  return std::none_of(slab_.openings.begin(), slab_.openings.end(),
                      [&](const Rectangle& opening) { return Contains(opening, center); });
}

int Relief::Node(int i, int j, bool front) {
  const auto [entry, is_new] =
      nodes_.try_emplace({{i, j}, front}, static_cast<int>(mesh_.vertices.size()));
  if (is_new) {
    const Eigen::Vector2d p(lines_[0][static_cast<std::size_t>(i)],
                            lines_[1][static_cast<std::size_t>(j)]);
    const Depth depth = At(p);
    mesh_.vertices.emplace_back(front ? depth.front : depth.back, p.x(), p.y());
  }
  return entry->second;
}

// Two triangles of one face; the diagonal follows the crease of a mitre.
void Relief::AddCell(int i, int j, bool front) {
  const int a = Node(i, j, front);
  const int b = Node(i + 1, j, front);
  const int c = Node(i + 1, j + 1, front);
  const int d = Node(i, j + 1, front);
  const auto x = [&](int node) { return mesh_.vertices[static_cast<std::size_t>(node)].x(); };
  const bool along_ac = std::abs(x(b) - x(d)) < std::abs(x(a) - x(c));
  const auto add = [&](int p, int q, int r) {
    mesh_.triangles.push_back(front ? Eigen::Vector3i(p, q, r) : Eigen::Vector3i(p, r, q));
  };
  add(a, b, along_ac ? c : d);
  add(along_ac ? a : b, c, d);
}

// The wall between front and back along a border; the solid lies to the left of the way from
// (i0, j0) to (i1, j1), seen from the front.
void Relief::AddWall(int i0, int j0, int i1, int j1) {
  const int f0 = Node(i0, j0, true);
  const int f1 = Node(i1, j1, true);
  const int b0 = Node(i0, j0, false);
  const int b1 = Node(i1, j1, false);
  mesh_.triangles.emplace_back(f0, b0, b1);
  mesh_.triangles.emplace_back(f0, b1, f1);
}

TriangleMesh Relief::Mesh() {
  const auto filled = [&](int i, int j) { return Filled(lines_[0], lines_[1], i, j); };
  for (int i = 0; i + 1 < static_cast<int>(lines_[0].size()); ++i) {
    for (int j = 0; j + 1 < static_cast<int>(lines_[1].size()); ++j) {
      if (!filled(i, j)) continue;
      AddCell(i, j, true);
      AddCell(i, j, false);
      if (!filled(i, j - 1)) AddWall(i, j, i + 1, j);
      if (!filled(i + 1, j)) AddWall(i + 1, j, i + 1, j + 1);
      if (!filled(i, j + 1)) AddWall(i + 1, j + 1, i, j + 1);
      if (!filled(i - 1, j)) AddWall(i, j + 1, i, j);
    }
  }
  return std::move(mesh_);
}

// Range of depth over a coarse cell: highest front, deepest back of the fine nodes in it.
Relief::Depth Relief::CellDepth(std::size_t i, std::size_t j) const {
  Depth depth{-1e9, 1e9};
  for (const double y : lines_[0]) {
    if (y < coarse_[0][i] - 1e-6 || y > coarse_[0][i + 1] + 1e-6) continue;
    for (const double z : lines_[1]) {
      if (z < coarse_[1][j] - 1e-6 || z > coarse_[1][j + 1] + 1e-6) continue;
      const Depth here = At({y, z});
      depth.front = std::max(depth.front, here.front);
      depth.back = std::min(depth.back, here.back);
    }
  }
  return depth;
}

// Whether two ranges of depth may become one.
bool Near(const Relief::Depth& a, const Relief::Depth& b, double tolerance_m) {
  return std::abs(a.front - b.front) <= tolerance_m && std::abs(a.back - b.back) <= tolerance_m;
}

Relief::Depth Union(const Relief::Depth& a, const Relief::Depth& b) {
  return {std::max(a.front, b.front), std::min(a.back, b.back)};
}

// The cells of row j, those of one depth joined along y.
std::vector<Relief::Block> Relief::RowOfBlocks(std::size_t j, double tolerance_m) const {
  std::vector<Block> blocks;
  for (std::size_t i = 0; i + 1 < coarse_[0].size(); ++i) {
    if (!Filled(coarse_[0], coarse_[1], static_cast<int>(i), static_cast<int>(j))) continue;
    const Depth depth = CellDepth(i, j);
    const bool joins =
        !blocks.empty() && blocks.back().y1 == i && Near(blocks.back().depth, depth, tolerance_m);
    if (!joins) {
      blocks.push_back({i, i + 1, j, j + 1, depth});
      continue;
    }
    blocks.back().y1 = i + 1;
    blocks.back().depth = Union(blocks.back().depth, depth);
  }
  return blocks;
}

// Rows of equal extent and depth are joined along z.
std::vector<Relief::Block> Relief::Blocks(double tolerance_m) const {
  std::vector<Block> joined;
  for (std::size_t j = 0; j + 1 < coarse_[1].size(); ++j) {
    for (const Block& row : RowOfBlocks(j, tolerance_m)) {
      const auto below = std::find_if(joined.begin(), joined.end(), [&](const Block& block) {
        return block.z1 == row.z0 && block.y0 == row.y0 && block.y1 == row.y1 &&
               Near(block.depth, row.depth, tolerance_m);
      });
      if (below == joined.end()) {
        joined.push_back(row);
        continue;
      }
      below->z1 = row.z1;
      below->depth = Union(below->depth, row.depth);
    }
  }
  return joined;
}

std::vector<TriangleMesh> Relief::Hulls(double tolerance_m) const {
  const std::vector<Block> blocks = Blocks(tolerance_m);
  std::vector<TriangleMesh> hulls(blocks.size());
  std::transform(blocks.begin(), blocks.end(), hulls.begin(), [&](const Block& block) {
    return BoxMesh({block.depth.back, coarse_[0][block.y0], coarse_[1][block.z0]},
                   {block.depth.front, coarse_[0][block.y1], coarse_[1][block.z1]});
  });
  return hulls;
}

}  // namespace

Solid ReliefSolid(const ReliefSlab& slab, double hull_tolerance_m) {
  Relief relief(slab);
  std::vector<TriangleMesh> hulls = relief.Hulls(hull_tolerance_m);
  return {relief.Mesh(), std::move(hulls)};
}

ReliefProfile SunkPanel(double depth_m, double slope_m) { return {{0, 0}, {slope_m, -depth_m}}; }

ReliefProfile RaisedPanel(double groove_depth_m, double field_depth_m, double bevel_m) {
  return {{0, 0},
          {0.004, -0.6 * groove_depth_m},
          {0.007, -groove_depth_m},
          {0.013, -groove_depth_m},
          {0.013 + bevel_m, -field_depth_m - 0.002},
          {0.0145 + bevel_m, -field_depth_m}};
}

}  // namespace doorforge::internal
