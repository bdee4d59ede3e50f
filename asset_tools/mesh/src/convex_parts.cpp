// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/convex_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "doorforge/core/error.h"

#include "convex_region.h"
#include "triangle_tree.h"

namespace doorforge {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;

// A plane across one axis.
struct Cut {
  int axis = 0;
  double position_m = 0;
};

// What lies on one side of the cut: below it for sign -1, above for +1 (Sutherland and Hodgman).
Polygon Clipped(const Polygon& polygon, const Cut& cut, int sign) {
  Polygon clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[cut.axis] - cut.position_m);
    const double db = sign * (b[cut.axis] - cut.position_m);
    if (da >= 0) clipped.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      Eigen::Vector3d crossing = a + da / (da - db) * (b - a);
      crossing[cut.axis] = cut.position_m;
      clipped.push_back(crossing);
    }
  }
  return clipped;
}

// The part of the solid inside one box: the surface in it, clipped, and the box's corners that lie
// in the solid. Their hull is the hull of the part.
struct Region {
  Eigen::AlignedBox3d box;
  std::vector<Polygon> surface;
  TriangleMesh hull;
  Concavity concavity;
};

std::vector<Eigen::Vector3d> PointsOf(const std::vector<Polygon>& polygons) {
  std::vector<Eigen::Vector3d> points;
  for (const Polygon& polygon : polygons)
    points.insert(points.end(), polygon.begin(), polygon.end());
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::vector<Polygon> OneSide(const std::vector<Polygon>& polygons, const Cut& cut, int sign) {
  std::vector<Polygon> kept;
  for (const Polygon& polygon : polygons) {
    Polygon clipped = Clipped(polygon, cut, sign);
    if (!clipped.empty()) kept.push_back(std::move(clipped));
  }
  return kept;
}

// Places where a cut along `axis` may separate something: faces across the axis, the largest
// first, then even steps, and the deepest point of the concavity.
std::vector<double> CutPositions(const Region& region, int axis) {
  constexpr int kFaces = 6;
  constexpr int kSteps = 7;
  std::map<double, double> area_at;
  for (const Polygon& polygon : region.surface) {
    const double position = polygon[0][axis];
    const bool across = std::all_of(polygon.begin(), polygon.end(), [&](const Eigen::Vector3d& p) {
      return std::abs(p[axis] - position) < 1e-6 * region.box.diagonal().norm();
    });
    if (!across) continue;
    Eigen::Vector3d doubled = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      doubled += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
    area_at[position] += doubled.norm();
  }
  std::vector<std::pair<double, double>> faces;
  for (const auto& [position, area] : area_at) faces.emplace_back(-area, position);
  std::sort(faces.begin(), faces.end());
  std::vector<double> positions{region.concavity.at_m[axis]};
  for (std::size_t i = 0; i < faces.size() && i < kFaces; ++i) positions.push_back(faces[i].second);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : region.hull.vertices) box.extend(vertex);
  for (int i = 1; i <= kSteps; ++i)
    positions.push_back(box.min()[axis] + box.sizes()[axis] * i / (kSteps + 1));
  return positions;
}

class Decomposition {
 public:
  Decomposition(const ClosedMesh& mesh, const ConvexPartsConfig& config)
      : config_(config),
        tree_(mesh.mesh()),
        solid_(mesh, CellFor(mesh.mesh(), config.max_concavity_m / 3, 0, config.max_grid_cells)),
        // the grid sees depths to within half a cell
        allowed_m_(std::max(config.max_concavity_m - 0.5 * solid_.grid().cell_m,
                            0.5 * config.max_concavity_m)) {
    Region whole;
    for (const Eigen::Vector3d& vertex : mesh.mesh().vertices) whole.box.extend(vertex);
    for (const Eigen::Vector3i& t : mesh.mesh().triangles) {
      Polygon& polygon = whole.surface.emplace_back();
      for (const int index : t)
        polygon.push_back(mesh.mesh().vertices[static_cast<std::size_t>(index)]);
    }
    smallest_m3_ = 1e-9 * whole.box.volume();
    if (Enclose(whole)) regions_.push_back(std::move(whole));
  }

  std::vector<TriangleMesh> Run() {
    // joining frees parts for further cuts, so both alternate until nothing changes
    for (int round = 0; round < 4; ++round) {
      const bool cut = CutWorst();
      const bool joined = JoinAll();
      if (!cut || !joined) break;
    }
    std::vector<TriangleMesh> parts;
    for (const Region& region : regions_)
      parts.push_back(ReducedHull(region.hull, config_.max_vertices));
    return parts;
  }

 private:
  // Fills in hull and concavity; false where the region holds nothing.
  bool Enclose(Region& region) const {
    std::vector<Eigen::Vector3d> points = PointsOf(region.surface);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point =
          region.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      if (tree_.WindingNumber(point) > 0.5) points.push_back(point);
    }
    std::optional<TriangleMesh> hull = HullOf(points);
    if (!hull || !(VolumeOf(*hull) > smallest_m3_)) return false;
    region.hull = *std::move(hull);
    region.concavity = ConcavityOf(region.hull, solid_);
    return true;
  }

  bool CutWorst() {
    bool any = false;
    while (static_cast<int>(regions_.size()) < config_.max_parts) {
      const auto worst =
          std::max_element(regions_.begin(), regions_.end(), [](const Region& a, const Region& b) {
            return a.concavity.depth_m < b.concavity.depth_m;
          });
      if (worst == regions_.end() || worst->concavity.depth_m <= allowed_m_) break;
      if (!Split(static_cast<std::size_t>(worst - regions_.begin()))) break;
      any = true;
    }
    return any;
  }

  // Replaces a region by its two sides of the best cut; false if no cut separates anything.
  bool Split(std::size_t index) {
    const std::optional<Cut> cut = BestCut(regions_[index]);
    if (!cut) return false;
    std::vector<Region> sides;
    for (const int sign : {-1, 1}) {
      Region side;
      side.box = regions_[index].box;
      (sign < 0 ? side.box.max() : side.box.min())[cut->axis] = cut->position_m;
      side.surface = OneSide(regions_[index].surface, *cut, sign);
      if (Enclose(side)) sides.push_back(std::move(side));
    }
    if (sides.size() < 2) return false;
    regions_[index] = std::move(sides[0]);
    regions_.push_back(std::move(sides[1]));
    return true;
  }

  // The cut whose two hulls have the least volume, so enclose the least air.
  std::optional<Cut> BestCut(const Region& region) const {
    std::optional<Cut> best;
    double best_volume = VolumeOf(region.hull) * (1 - 1e-6);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double position : CutPositions(region, axis)) {
        const Cut cut{axis, position};
        const double volume = HullVolume(region, cut, -1) + HullVolume(region, cut, 1);
        if (volume >= best_volume * (1 - 1e-9)) continue;  // ties: the first
        best_volume = volume;
        best = cut;
      }
    }
    return best;
  }

  static double HullVolume(const Region& region, const Cut& cut, int sign) {
    const std::optional<TriangleMesh> hull = HullOf(PointsOf(OneSide(region.surface, cut, sign)));
    return hull ? VolumeOf(*hull) : 0;
  }

  // Joins the pairs whose common hull stays within the bound, the least concave first.
  bool JoinAll() {
    bool any = false;
    while (JoinBestPair()) any = true;
    return any;
  }

  bool JoinBestPair() {
    std::optional<Region> best;
    std::pair<std::size_t, std::size_t> best_pair;
    for (std::size_t a = 0; a < regions_.size(); ++a) {
      for (std::size_t b = a + 1; b < regions_.size(); ++b) {
        std::optional<Region> joined = JoinedWithinBound(regions_[a], regions_[b]);
        if (!joined || (best && joined->concavity.depth_m >= best->concavity.depth_m)) continue;
        best = std::move(joined);
        best_pair = {a, b};
      }
    }
    if (!best) return false;
    best->surface = regions_[best_pair.first].surface;
    const std::vector<Polygon>& more = regions_[best_pair.second].surface;
    best->surface.insert(best->surface.end(), more.begin(), more.end());
    regions_[best_pair.first] = *std::move(best);
    regions_.erase(regions_.begin() + static_cast<std::ptrdiff_t>(best_pair.second));
    return true;
  }

  std::optional<Region> JoinedWithinBound(const Region& a, const Region& b) const {
    if (a.box.exteriorDistance(b.box) > solid_.grid().cell_m) return std::nullopt;
    std::vector<Eigen::Vector3d> points = a.hull.vertices;
    points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
    std::optional<TriangleMesh> hull = HullOf(points);
    if (!hull) return std::nullopt;
    Region joined;
    joined.box = a.box.merged(b.box);
    joined.hull = *std::move(hull);
    joined.concavity = ConcavityOf(joined.hull, solid_);
    if (joined.concavity.depth_m > allowed_m_) return std::nullopt;
    return joined;
  }

  ConvexPartsConfig config_;
  TriangleTree tree_;
  DistanceGrid solid_;
  double allowed_m_;
  double smallest_m3_ = 0;
  std::vector<Region> regions_;
};

void CheckConfig(const ConvexPartsConfig& config) {
  Require(config.max_parts >= 1, ErrorCode::kInvalidConfig, "convex.max_parts: allowed 1 and more");
  Require(config.max_concavity_m > 0 && std::isfinite(config.max_concavity_m),
          ErrorCode::kInvalidConfig, "convex.max_concavity_m: must be positive");
  Require(config.max_vertices >= 4, ErrorCode::kInvalidConfig,
          "convex.max_vertices: allowed 4 and more");
  Require(config.max_grid_cells >= 1000, ErrorCode::kInvalidConfig,
          "convex.max_grid_cells: allowed 1000 and more");
}

}  // namespace

std::vector<TriangleMesh> ConvexParts(const ClosedMesh& mesh, const ConvexPartsConfig& config) {
  CheckConfig(config);
  return Decomposition(mesh, config).Run();
}

}  // namespace doorforge
