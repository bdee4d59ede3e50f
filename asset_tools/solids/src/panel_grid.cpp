// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/solids/panel_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kMaxPanelHullVertices = 64;
constexpr double kOnLineM = 1e-7;

// Shares of the radius at which a quarter circle has lines, and how far it lies back there.
constexpr double kEdgeShare = 0.3;
constexpr double kEdgeDrop[] = {1.0, 0.286};

struct HullExtent {
  double volume_m3 = 0;
  double area_m2 = 0;
};

HullExtent Extent(const TriangleMesh& hull) {
  HullExtent extent;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    extent.volume_m3 += a.dot(b.cross(c)) / 6;
    extent.area_m2 += (b - a).cross(c - a).norm() / 2;
  }
  return extent;
}

class Panel {
 public:
  explicit Panel(const PanelGrid& grid)
      : grid_(grid),
        columns_(static_cast<int>(grid.u_m.size()) - 1),
        rows_(static_cast<int>(grid.v_m.size()) - 1) {
    Require(columns_ > 0 && rows_ > 0, ErrorCode::kInvalidArgument, "a panel has cells");
  }

  TriangleMesh Mesh();
  std::vector<TriangleMesh> Hulls(double tolerance_m) const;

 private:
  // Cells i0 <= i < i1, j0 <= j < j1.
  struct Block {
    int i0, i1, j0, j1;
  };

  double U(int i) const { return grid_.u_m[static_cast<std::size_t>(i)]; }
  double V(int j) const { return grid_.v_m[static_cast<std::size_t>(j)]; }
  std::size_t CellIndex(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(rows_) +
           static_cast<std::size_t>(j);
  }
  bool Filled(int i, int j) const;
  int StepsToBorder(int i, int j) const;
  Eigen::Vector3d Point(int i, int j, bool front) const;
  int Node(int i, int j, bool front);
  void AddCell(int i, int j, bool front);
  void AddWall(int i0, int j0, int i1, int j1);
  TriangleMesh HullOf(const Block& block) const;
  double StandsOut(const TriangleMesh& hull, const Block& block) const;
  double VolumeOf(const Block& block) const;
  bool AllFilled(const Block& block, const std::vector<char>& taken) const;
  bool MayJoin(const Block& block, double tolerance_m) const;
  Block Grown(Block block, const std::vector<char>& taken, double tolerance_m) const;

  const PanelGrid& grid_;
  int columns_;
  int rows_;
  TriangleMesh mesh_;
  std::map<std::tuple<int, int, bool>, int> nodes_;
};

bool Panel::Filled(int i, int j) const {
  if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return false;
  const Eigen::Vector2d center((U(i) + U(i + 1)) / 2, (V(j) + V(j + 1)) / 2);
  return std::none_of(grid_.openings.begin(), grid_.openings.end(), [&](const Rectangle& opening) {
    return (center.array() > opening.min_m.array()).all() &&
           (center.array() < opening.max_m.array()).all();
  });
}

// Lines between a node and the nearest cell that is not filled, up to 2.
int Panel::StepsToBorder(int i, int j) const {
  for (int steps = 0; steps < 2; ++steps) {
    for (int di = -steps - 1; di <= steps; ++di) {
      for (int dj = -steps - 1; dj <= steps; ++dj) {
        if (!Filled(i + di, j + dj)) return steps;
      }
    }
  }
  return 2;
}

Eigen::Vector3d Panel::Point(int i, int j, bool front) const {
  const Eigen::Vector3d a = grid_.front(U(i), V(j));
  const Eigen::Vector3d b = grid_.back(U(i), V(j));
  const int steps = StepsToBorder(i, j);
  if (steps == 2 || grid_.edge_radius_m <= 0) return front ? a : b;
  const double drop = kEdgeDrop[steps] * grid_.edge_radius_m;
  const Eigen::Vector3d inwards = (b - a).normalized() * drop;
  return front ? Eigen::Vector3d(a + inwards) : Eigen::Vector3d(b - inwards);
}

int Panel::Node(int i, int j, bool front) {
  const auto [entry, is_new] =
      nodes_.try_emplace({i, j, front}, static_cast<int>(mesh_.vertices.size()));
  if (is_new) mesh_.vertices.push_back(Point(i, j, front));
  return entry->second;
}

// Two triangles; of the diagonals the one that lies outside, so that a bulge stays convex.
void Panel::AddCell(int i, int j, bool front) {
  const int a = Node(i, j, front);
  const int b = Node(i + 1, j, front);
  const int c = Node(i + 1, j + 1, front);
  const int d = Node(i, j + 1, front);
  const auto at = [&](int node) { return mesh_.vertices[static_cast<std::size_t>(node)]; };
  const Eigen::Vector3d out = (at(b) - at(a)).cross(at(d) - at(a)) * (front ? 1 : -1);
  const bool along_ac = ((at(a) + at(c)) - (at(b) + at(d))).dot(out) >= 0;
  const auto add = [&](int p, int q, int r) {
    mesh_.triangles.push_back(front ? Eigen::Vector3i(p, q, r) : Eigen::Vector3i(p, r, q));
  };
  add(a, b, along_ac ? c : d);
  add(along_ac ? a : b, c, d);
}

// The wall along a border; the solid lies to the left of the way, seen from the front.
void Panel::AddWall(int i0, int j0, int i1, int j1) {
  const int f0 = Node(i0, j0, true);
  const int f1 = Node(i1, j1, true);
  const int b0 = Node(i0, j0, false);
  const int b1 = Node(i1, j1, false);
  mesh_.triangles.emplace_back(f0, b0, b1);
  mesh_.triangles.emplace_back(f0, b1, f1);
}

TriangleMesh Panel::Mesh() {
  for (int i = 0; i < columns_; ++i) {
    for (int j = 0; j < rows_; ++j) {
      if (!Filled(i, j)) continue;
      AddCell(i, j, true);
      AddCell(i, j, false);
      if (!Filled(i, j - 1)) AddWall(i, j, i + 1, j);
      if (!Filled(i + 1, j)) AddWall(i + 1, j, i + 1, j + 1);
      if (!Filled(i, j + 1)) AddWall(i + 1, j + 1, i, j + 1);
      if (!Filled(i - 1, j)) AddWall(i, j + 1, i, j);
    }
  }
  return std::move(mesh_);
}

TriangleMesh Panel::HullOf(const Block& block) const {
  std::vector<Eigen::Vector3d> points;
  for (int i = block.i0; i <= block.i1; ++i) {
    for (int j = block.j0; j <= block.j1; ++j) {
      points.push_back(Point(i, j, true));
      points.push_back(Point(i, j, false));
    }
  }
  return ConvexHull(points);
}

// How far the hull stands out from the block's faces, at nodes and the middles of cells.
double Panel::StandsOut(const TriangleMesh& hull, const Block& block) const {
  std::vector<Eigen::Vector4d> planes;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    if (cross.norm() < 1e-10) continue;
    const Eigen::Vector3d normal = cross.normalized();
    planes.emplace_back(normal.x(), normal.y(), normal.z(), -normal.dot(a));
  }
  double deepest = 0;
  const auto check = [&](const Eigen::Vector3d& point) {
    double depth = 1e9;
    for (const Eigen::Vector4d& plane : planes)
      depth = std::min(depth, -plane.dot(point.homogeneous()));
    deepest = std::max(deepest, depth);
  };
  for (int i = block.i0; i < block.i1; ++i) {
    for (int j = block.j0; j < block.j1; ++j) {
      const double u = (U(i) + U(i + 1)) / 2;
      const double v = (V(j) + V(j + 1)) / 2;
      check(grid_.front(u, v));
      check(grid_.back(u, v));
    }
  }
  // the sides, which a slanted or curved outline leaves
  const auto check_side = [&](double u, double v) {
    check((grid_.front(u, v) + grid_.back(u, v)) / 2);
  };
  for (int i = block.i0; i <= block.i1; ++i) {
    check_side(U(i), V(block.j0));
    check_side(U(i), V(block.j1));
  }
  for (int j = block.j0; j <= block.j1; ++j) {
    check_side(U(block.i0), V(j));
    check_side(U(block.i1), V(j));
  }
  return deepest;
}

double Panel::VolumeOf(const Block& block) const {
  double volume = 0;
  for (int i = block.i0; i < block.i1; ++i) {
    for (int j = block.j0; j < block.j1; ++j) {
      std::vector<Eigen::Vector3d> corners;
      for (const int di : {0, 1}) {
        for (const int dj : {0, 1}) {
          corners.push_back(grid_.front(U(i + di), V(j + dj)));
          corners.push_back(grid_.back(U(i + di), V(j + dj)));
        }
      }
      volume += Extent(ConvexHull(corners)).volume_m3;
    }
  }
  return volume;
}

bool Panel::AllFilled(const Block& block, const std::vector<char>& taken) const {
  if (block.i1 > columns_ || block.j1 > rows_) return false;
  for (int i = block.i0; i < block.i1; ++i) {
    for (int j = block.j0; j < block.j1; ++j) {
      if (!Filled(i, j) || taken[CellIndex(i, j)] != 0) return false;
    }
  }
  return true;
}

bool Panel::MayJoin(const Block& block, double tolerance_m) const {
  const TriangleMesh hull = HullOf(block);
  if (hull.vertices.size() > kMaxPanelHullVertices) return false;
  // a thin bent strip lies near its hull's surface everywhere; what the hull adds tells
  const auto [volume, area] = Extent(hull);
  const double added = (volume - VolumeOf(block)) / area;
  return added <= 0.25 * tolerance_m && StandsOut(hull, block) <= tolerance_m;
}

// The block made as high as it may be, then as wide: an arch cut into the lower border then costs
// columns, not every cell around it.
Panel::Block Panel::Grown(Block block, const std::vector<char>& taken, double tolerance_m) const {
  for (const bool along_v : {true, false}) {
    while (true) {
      Block larger = block;
      ++(along_v ? larger.j1 : larger.i1);
      if (!AllFilled(larger, taken) || !MayJoin(larger, tolerance_m)) break;
      block = larger;
    }
  }
  return block;
}

std::vector<TriangleMesh> Panel::Hulls(double tolerance_m) const {
  std::vector<char> taken(CellIndex(columns_, 0), 0);
  std::vector<TriangleMesh> hulls;
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      const Block cell{i, i + 1, j, j + 1};
      if (!AllFilled(cell, taken)) continue;
      const Block block = Grown(cell, taken, tolerance_m);
      for (int a = block.i0; a < block.i1; ++a) {
        for (int b = block.j0; b < block.j1; ++b) taken[CellIndex(a, b)] = 1;
      }
      hulls.push_back(HullOf(block));
    }
  }
  return hulls;
}

}  // namespace

std::vector<double> EqualLines(double low, double high, int steps) {
  std::vector<double> lines;
  for (int i = 0; i <= steps; ++i) lines.push_back(low + (high - low) * i / steps);
  return lines;
}

std::vector<double> EdgeLines(const std::vector<double>& lines, const std::vector<double>& borders,
                              double radius_m) {
  if (borders.empty()) return lines;
  const auto [low, high] = std::minmax_element(borders.begin(), borders.end());
  std::vector<double> all;
  for (const double line : lines) {
    const bool free = std::all_of(borders.begin(), borders.end(), [&](double border) {
      return std::abs(line - border) > radius_m + kOnLineM;
    });
    if (free && line > *low && line < *high) all.push_back(line);
  }
  for (const double border : borders) {
    for (const double share : {-1.0, -kEdgeShare, 0.0, kEdgeShare, 1.0}) {
      const double line = border + share * radius_m;
      if (line >= *low - kOnLineM && line <= *high + kOnLineM) all.push_back(line);
    }
  }
  std::sort(all.begin(), all.end());
  const auto same = [](double a, double b) { return b - a < kOnLineM; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

Solid PanelSolid(const PanelGrid& grid, double hull_tolerance_m) {
  Panel panel(grid);
  std::vector<TriangleMesh> hulls = panel.Hulls(hull_tolerance_m);
  return {panel.Mesh(), std::move(hulls)};
}

}  // namespace doorforge::internal
