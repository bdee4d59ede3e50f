// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/convex_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

#include "convex_region.h"
#include "cover_parts.h"
#include "triangle_tree.h"

namespace doorforge {
namespace {

constexpr double kCoverShare = 0.5;      // of the concavity: what the parts may leave out
constexpr double kFineCoverShare = 0.1;  // the same after cuts that were measured
constexpr double kCutShare = 0.875;      // of the parts: what those cuts may use in any case
constexpr int kExchanges = 16;           // measured cuts and joins without gain before they end
constexpr double kHeldSkins = 2;         // how far surface may stand out of a hull that holds it
constexpr int kRounds = 4;               // of cutting and joining
constexpr double kSurplus = 2;           // regions, against those that may stay, to join from
constexpr double kMostSurplus = 4;       // the same for a second search
constexpr double kWorthwhile = 0.97;     // less of the depth must be left for another round

// A piece of the surface, or a point that was noted for a region.
struct Polygon {
  std::vector<Eigen::Vector3d> corners;
  double wall_m = 0;  // how far the solid reaches behind it

  bool IsNotedPoint() const { return corners.size() == 1; }
};

// A plane across one axis.
struct Cut {
  int axis = 0;
  double position_m = 0;
};

// What lies on one side of the cut: below it for sign -1, above for +1 (Sutherland and Hodgman).
Polygon Clipped(const Polygon& polygon, const Cut& cut, int sign) {
  Polygon clipped{{}, polygon.wall_m};
  const std::vector<Eigen::Vector3d>& corners = polygon.corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& a = corners[i];
    const Eigen::Vector3d& b = corners[(i + 1) % corners.size()];
    const double da = sign * (a[cut.axis] - cut.position_m);
    const double db = sign * (b[cut.axis] - cut.position_m);
    if (da >= 0) clipped.corners.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      Eigen::Vector3d crossing = a + da / (da - db) * (b - a);
      crossing[cut.axis] = cut.position_m;
      clipped.corners.push_back(crossing);
    }
  }
  return clipped;
}

// The part of the solid inside one box: the surface in it, clipped, and the box's corners that lie
// in the solid. Their hull is the hull of the part.
struct Region {
  int id = 0;
  Eigen::AlignedBox3d box;
  std::vector<Polygon> surface;
  TriangleMesh hull;
  Concavity concavity;
  bool indivisible = false;  // no cut separates anything
  bool trimmed = false;      // of what others hold as well
};

std::vector<Eigen::Vector3d> PointsOf(const std::vector<Polygon>& polygons) {
  std::vector<Eigen::Vector3d> points;
  for (const Polygon& polygon : polygons)
    points.insert(points.end(), polygon.corners.begin(), polygon.corners.end());
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

Eigen::Vector3d DoubledAreaOf(const Polygon& polygon) {
  Eigen::Vector3d doubled = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector3d>& p = polygon.corners;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) doubled += (p[i] - p[0]).cross(p[i + 1] - p[0]);
  return doubled;
}

// Whether the polygon only ends what lies on the other side: it reaches no more than `skin_m` into
// this side, less than the wall behind it reaches into the other, and is no face of a solid on this
// side. Kept here, the ends of opposite walls would span the air between them; a thin wall that is
// cut along its middle must keep both its faces.
bool IsSkinOfOtherSide(const Polygon& polygon, const Cut& cut, int sign, double skin_m) {
  const Eigen::Vector3d doubled = DoubledAreaOf(polygon);
  if (sign * doubled[cut.axis] < -0.5 * doubled.norm()) return false;
  const double reach_m = std::min(skin_m, 0.5 * polygon.wall_m);
  return std::all_of(polygon.corners.begin(), polygon.corners.end(), [&](const Eigen::Vector3d& p) {
    return sign * (p[cut.axis] - cut.position_m) <= reach_m;
  });
}

// Where a cut may separate something.
struct Candidate {
  Cut cut;
  double face_share = 0;  // area of the faces in its plane, against the largest such area
};

// Planes across `axis` in which much of the surface lies, the largest first. Faces within `bin_m`
// of each other that look the same way count as one, since a wrap's faces are only nearly flat.
std::vector<Candidate> FaceCuts(const Region& region, int axis, double bin_m) {
  struct Bin {
    double area = 0;
    double moment = 0;
  };
  constexpr std::size_t kFaces = 6;
  constexpr double kAcross = 0.98;  // cosine of the angle between a face's normal and the axis
  std::map<std::pair<std::int64_t, bool>, Bin> bins;
  for (const Polygon& polygon : region.surface) {
    const Eigen::Vector3d doubled = DoubledAreaOf(polygon);
    const double area = doubled.norm();
    if (!(area > 0) || std::abs(doubled[axis]) < kAcross * area) continue;
    double position = 0;
    for (const Eigen::Vector3d& p : polygon.corners)
      position += p[axis] / static_cast<double>(polygon.corners.size());
    Bin& bin = bins[{std::llround(position / bin_m), doubled[axis] > 0}];
    bin.area += area;
    bin.moment += area * position;
  }
  std::vector<Candidate> faces;
  faces.reserve(bins.size());
  for (const auto& [index, bin] : bins) faces.push_back({{axis, bin.moment / bin.area}, bin.area});
  std::stable_sort(faces.begin(), faces.end(), [](const Candidate& a, const Candidate& b) {
    return a.face_share > b.face_share;
  });
  if (faces.size() > kFaces) faces.resize(kFaces);
  return faces;
}

// Faces, then even steps, then the deepest point of the concavity.
std::vector<Candidate> Candidates(const Region& region, double bin_m) {
  constexpr int kSteps = 7;
  std::vector<Candidate> candidates;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const Candidate& face : FaceCuts(region, axis, bin_m)) {
      candidates.push_back(face);
      largest = std::max(largest, face.face_share);
    }
  }
  for (Candidate& candidate : candidates) candidate.face_share /= largest;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : region.hull.vertices) box.extend(vertex);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 1; i <= kSteps; ++i)
      candidates.push_back({{axis, box.min()[axis] + box.sizes()[axis] * i / (kSteps + 1)}});
    candidates.push_back({{axis, region.concavity.at_m[axis]}});
  }
  return candidates;
}

class Decomposition {
 public:
  Decomposition(const ClosedMesh& mesh, const ConvexPartsConfig& config)
      : mesh_(&mesh),
        config_(config),
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
        polygon.corners.push_back(mesh.mesh().vertices[static_cast<std::size_t>(index)]);
      polygon.wall_m = WallBehind(polygon);
    }
    smallest_m3_ = 1e-9 * whole.box.volume();
    if (Enclose(whole, {})) regions_.push_back(std::move(whole));
    whole_ = regions_;
  }

  std::vector<TriangleMesh> Run() {
    CutAndJoin(config_.max_parts);
    if (WorstDepth() > allowed_m_) SpendBetter();
    if (WorstDepth() > allowed_m_) SearchAgain();
    std::vector<TriangleMesh> parts = Covered(kCoverShare);
    return config_.max_protrusion_m > 0 ? Measured(std::move(parts)) : parts;
  }

 private:
  using RegionPair = std::pair<std::size_t, std::size_t>;

  // What a cut is to make less.
  enum class Depths { kOfGrid, kMeasured };

  // The common hull of two regions: its depth and its volume beyond the two hulls. Asked with a
  // bound on the depth, it may stop at any depth beyond.
  struct Between {
    double depth_m = 1e300;
    double air_m3 = 1e300;
    double asked_m = 0;
  };

  // Which of two joins is better: within the bound by air, else by depth.
  using Cost = std::pair<double, double>;
  Cost CostOf(const Between& between) const {
    return {between.depth_m <= allowed_m_ ? 0 : between.depth_m, between.air_m3};
  }

  double WallBehind(const Polygon& triangle) const {
    const std::vector<Eigen::Vector3d>& p = triangle.corners;
    const Eigen::Vector3d inwards = -DoubledAreaOf(triangle).normalized();
    return tree_.FirstHit((p[0] + p[1] + p[2]) / 3, inwards, 1e-3 * SkinM());
  }

  // Fills in hull and concavity; false where the region holds nothing. Of the box's corners those
  // count that lie in the solid and in the hull that the region is cut from: the box of two regions
  // that were joined holds what belongs to others.
  bool Enclose(Region& region, const std::vector<HalfSpace>& cut_from) {
    region.id = next_id_++;
    // kept with the surface as polygons of one point, so that later cuts and joins know them
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point =
          region.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      if (IsHeldBy(cut_from, {{point}}) && IsSolidBehind(point, region.box))
        region.surface.push_back({{point}});
    }
    std::optional<TriangleMesh> hull = HullOf(PointsOf(region.surface));
    if (!hull || !(VolumeOf(*hull) > smallest_m3_)) return false;
    region.hull = *std::move(hull);
    region.concavity = ConcavityOf(region.hull, solid_);
    return true;
  }

  double WorstDepth() const {
    double worst_m = 0;
    for (const Region& region : regions_) worst_m = std::max(worst_m, region.concavity.depth_m);
    return worst_m;
  }

  std::vector<TriangleMesh> Covered(double share) const {
    std::vector<TriangleMesh> parts;
    for (const Region& region : regions_)
      parts.push_back(ReducedHull(region.hull, config_.max_vertices));
    return Covering(std::move(parts), *mesh_, solid_,
                    {.tolerance_m = share * config_.max_concavity_m,
                     .allowed_m = allowed_m_,
                     .max_parts = config_.max_parts,
                     .max_vertices = config_.max_vertices});
  }

  // Joining frees parts for further cuts.
  void CutAndJoin(int max_regions) {
    for (int round = 0; round < kRounds; ++round) {
      const bool cut = CutWorst(max_regions);
      const bool joined = JoinWithin(allowed_m_, 1);
      if (!cut || !joined) break;
    }
  }

  // From the whole, with more cuts before anything is joined: what the first cuts of a ring or a
  // cabinet separated amiss can then be put together otherwise. Kept if the worst depth falls.
  void SearchAgain() {
    const double before_m = WorstDepth();
    std::vector<Region> before = std::exchange(regions_, whole_);
    CutAndJoin(static_cast<int>(kMostSurplus * config_.max_parts));
    JoinWithin(before_m, config_.max_parts);
    const bool fits = static_cast<int>(regions_.size()) <= config_.max_parts;
    if (!fits || WorstDepth() >= before_m) regions_ = std::move(before);
  }

  // The grid sees depths to within about two cells, so at the end what counts is measured. The
  // parts that covering did not need are cut with.
  std::vector<TriangleMesh> Measured(std::vector<TriangleMesh> parts) {
    const auto most = static_cast<std::size_t>(config_.max_parts);
    const auto spare = [&](const std::vector<TriangleMesh>& covering) {
      return most - std::min(most, covering.size());
    };
    double most_m = MostProtrusion(parts);
    std::size_t room = std::max(static_cast<std::size_t>(kCutShare * config_.max_parts),
                                regions_.size() + spare(parts));
    for (int round = 0; round < kRounds && most_m > config_.max_protrusion_m; ++round) {
      if (!ExchangeMeasured(room)) break;
      std::vector<TriangleMesh> finer = Covered(kFineCoverShare);
      room = regions_.size() + spare(finer);
      const double finer_m = MostProtrusion(finer);
      if (finer_m >= most_m) continue;
      parts = std::move(finer);
      most_m = finer_m;
    }
    return parts;
  }

  // The region that stands out most as measured is cut where it does; where there is no room, the
  // pair whose common hull stands out least is joined first, if that is less. Many pairs that the
  // grid calls too deep are within the bound. Kept where it was best; true if that is not at first.
  bool ExchangeMeasured(std::size_t room) {
    std::vector<Region> best = regions_;
    Excess least = ExcessOf(regions_);
    bool any = false;
    for (int since = 0; since < kExchanges; ++since) {
      const std::optional<std::size_t> worst = WorstMeasured();
      if (!worst) break;
      if (!Trim(*worst)) {
        const Concavity measured = MeasuredOf(regions_[*worst]);
        if (regions_.size() >= room) {
          const auto pair = LeastMeasuredPair(kWorthwhile * measured.depth_m);
          if (!pair) break;
          Join(*pair);
          continue;
        }
        regions_[*worst].concavity = measured;
        if (!Split(*worst, Depths::kMeasured)) regions_[*worst].indivisible = true;
      }
      const Excess excess = ExcessOf(regions_);
      if (excess >= least) continue;
      least = excess;
      best = regions_;
      any = true;
      since = 0;
    }
    regions_ = std::move(best);
    return any;
  }

  // How far regions stand out beyond the bound: the farthest, then all of them.
  using Excess = std::pair<double, double>;
  Excess ExcessOf(const std::vector<Region>& regions) {
    Excess excess{0, 0};
    for (const Region& region : regions) {
      const double beyond_m = MeasuredOf(region).depth_m - config_.max_protrusion_m;
      excess = {std::max(excess.first, beyond_m), excess.second + std::max(0.0, beyond_m)};
    }
    return excess;
  }

  const Concavity& MeasuredOf(const Region& region) {
    const auto [entry, is_new] = measured_.try_emplace(region.id);
    if (is_new) entry->second = Protrusion(region.hull);
    return entry->second;
  }

  // Of those that stand out by more than they may and that a cut may divide.
  std::optional<std::size_t> WorstMeasured() {
    std::optional<std::size_t> worst;
    double worst_m = config_.max_protrusion_m;
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      const double depth_m = MeasuredOf(regions_[i]).depth_m;
      if (regions_[i].indivisible || depth_m <= worst_m) continue;
      worst_m = depth_m;
      worst = i;
    }
    return worst;
  }

  // The pair whose common hull stands out least as measured, less than `below_m`: the first that
  // stays within the bound, in the order of the grid. That tells of depths inside as well, which
  // may be less than a cell more.
  std::optional<RegionPair> LeastMeasuredPair(double below_m) {
    const double seen_m = below_m + solid_.grid().cell_m;
    std::vector<std::pair<Cost, RegionPair>> pairs;
    for (std::size_t a = 0; a < regions_.size(); ++a) {
      for (std::size_t b = a + 1; b < regions_.size(); ++b) {
        const Between between = BetweenOf(regions_[a], regions_[b], seen_m);
        if (between.depth_m <= seen_m) pairs.push_back({CostOf(between), {a, b}});
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::optional<RegionPair> best;
    for (const auto& [cost, pair] : pairs) {
      const double depth_m = MeasuredBetween(regions_[pair.first], regions_[pair.second]);
      if (depth_m >= below_m) continue;
      best = pair;
      if (depth_m <= config_.max_protrusion_m) break;
      below_m = depth_m;
    }
    return best;
  }

  double MeasuredBetween(const Region& a, const Region& b) {
    const auto [entry, is_new] = measured_between_.try_emplace({a.id, b.id}, 1e300);
    if (!is_new) return entry->second;
    const std::optional<TriangleMesh> hull = CommonHull(a, b);
    if (hull) entry->second = Protrusion(*hull).depth_m;
    return entry->second;
  }

  // The point of the hull's surface that is farthest from the mesh's, if it is farther than may be;
  // depth 0 where there is none.
  Concavity Protrusion(const TriangleMesh& hull, int stride = 1) const {
    const double unseen_m = std::sqrt(3.0) * solid_.grid().cell_m;
    std::vector<Concavity> probes;  // with their depths in the grid
    for (const Eigen::Vector3d& point : PointsOn(hull, stride * solid_.grid().cell_m)) {
      const Eigen::Vector3i cell = solid_.grid().CellAt(point);
      const double depth_m = solid_.DistanceAt(cell.x(), cell.y(), cell.z());
      if (depth_m > 0 && depth_m + unseen_m > config_.max_protrusion_m)
        probes.push_back({depth_m, point});
    }
    std::stable_sort(probes.begin(), probes.end(),
                     [](const Concavity& a, const Concavity& b) { return a.depth_m > b.depth_m; });
    Concavity farthest;
    for (const Concavity& probe : probes) {
      if (probe.depth_m + unseen_m <= farthest.depth_m) break;
      const double depth_m = tree_.Distance(probe.at_m, probe.depth_m + unseen_m);
      if (depth_m > std::max(farthest.depth_m, config_.max_protrusion_m))
        farthest = {depth_m, probe.at_m};
    }
    return farthest;
  }

  double MostProtrusion(const std::vector<TriangleMesh>& parts) const {
    double most_m = 0;
    for (const TriangleMesh& part : parts) most_m = std::max(most_m, Protrusion(part).depth_m);
    return most_m;
  }

  // The parts did not suffice, since a cut is never taken back. So the worst regions are cut into
  // more than may stay, and those whose common hull is least deep are joined, until they are few
  // enough. Kept while the worst depth falls.
  void SpendBetter() {
    for (int round = 0; round < kRounds / 2; ++round) {
      const double before_m = WorstDepth();
      std::vector<Region> before = regions_;
      CutWorst(static_cast<int>(kSurplus * config_.max_parts));
      JoinWithin(allowed_m_, 1);
      JoinWithin(before_m, config_.max_parts);
      const bool fits = static_cast<int>(regions_.size()) <= config_.max_parts;
      if (!fits || WorstDepth() >= before_m) regions_ = std::move(before);
      if (WorstDepth() <= allowed_m_ || WorstDepth() > kWorthwhile * before_m) break;
    }
  }

  // Until there are `max_regions`, or none is too deep.
  bool CutWorst(int max_regions) {
    bool any = false;
    while (static_cast<int>(regions_.size()) < max_regions) {
      const auto worst = std::max_element(
          regions_.begin(), regions_.end(),
          [](const Region& a, const Region& b) { return UrgencyOf(a) < UrgencyOf(b); });
      if (worst == regions_.end() || UrgencyOf(*worst) <= allowed_m_) break;
      if (Trim(static_cast<std::size_t>(worst - regions_.begin()))) continue;
      if (Split(static_cast<std::size_t>(worst - regions_.begin()), Depths::kOfGrid))
        any = true;
      else if (regions_.size() > 1)
        regions_.erase(worst);  // flat pieces far apart: each is covered by itself at the end
      else
        worst->indivisible = true;
    }
    return any;
  }

  // A deep region gives up the surface that the hulls of others hold as well: strips along a cut,
  // which would span the air between them and take many cuts to no avail. True if it changed.
  bool Trim(std::size_t index) {
    Region& region = regions_[index];
    if (region.trimmed) return false;
    CheckWork();
    region.trimmed = true;
    std::vector<std::vector<HalfSpace>> others;
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      if (i != index && regions_[i].box.exteriorDistance(region.box) <= kHeldSkins * SkinM())
        others.push_back(HalfSpacesOf(regions_[i].hull));
    }
    std::vector<Polygon> kept;
    for (const Polygon& polygon : region.surface) {
      if (polygon.IsNotedPoint() || !IsHeldBy(others, polygon)) kept.push_back(polygon);
    }
    if (kept.size() == region.surface.size()) return false;
    const bool only_points =
        std::all_of(kept.begin(), kept.end(), [](const Polygon& p) { return p.IsNotedPoint(); });
    std::optional<TriangleMesh> hull = HullOf(PointsOf(kept));
    if (only_points || !hull || !(VolumeOf(*hull) > smallest_m3_)) {
      regions_.erase(regions_.begin() + static_cast<std::ptrdiff_t>(index));
      return true;
    }
    region.id = next_id_++;
    region.surface = std::move(kept);
    region.hull = *std::move(hull);
    region.concavity = ConcavityOf(region.hull, solid_);
    return true;
  }

  // Wholly in one of the hulls, but for a skin.
  bool IsHeldBy(const std::vector<std::vector<HalfSpace>>& hulls, const Polygon& polygon) const {
    return std::any_of(hulls.begin(), hulls.end(),
                       [&](const std::vector<HalfSpace>& hull) { return IsHeldBy(hull, polygon); });
  }

  bool IsHeldBy(const std::vector<HalfSpace>& hull, const Polygon& polygon) const {
    return std::all_of(hull.begin(), hull.end(), [&](const HalfSpace& face) {
      return std::all_of(polygon.corners.begin(), polygon.corners.end(),
                         [&](const Eigen::Vector3d& p) {
                           return face.normal.dot(p) <= face.offset + kHeldSkins * SkinM();
                         });
    });
  }

  static double UrgencyOf(const Region& region) {
    return region.indivisible ? 0 : region.concavity.depth_m;
  }

  // Replaces a region by its two sides of the best cut; false if no cut separates anything.
  bool Split(std::size_t index, Depths depths) {
    const std::optional<Cut> cut = BestCut(regions_[index], depths);
    if (!cut) return false;
    const std::vector<HalfSpace> cut_from = HalfSpacesOf(regions_[index].hull);
    std::vector<Region> sides;
    for (const int sign : {-1, 1}) {
      Region side;
      side.box = regions_[index].box;
      (sign < 0 ? side.box.max() : side.box.min())[cut->axis] = cut->position_m;
      side.surface = OneSide(regions_[index], *cut, sign);
      if (Enclose(side, cut_from)) sides.push_back(std::move(side));
    }
    if (sides.size() < 2) return false;
    regions_[index] = std::move(sides[0]);
    regions_.push_back(std::move(sides[1]));
    return true;
  }

  // One side of a possible cut, as far as it decides between cuts.
  struct Side {
    double volume_m3 = 0;  // of its hull
    double depth_m = 0;    // of its hull, where that makes a further cut necessary
    double area_m2 = 0;    // of the surface in it
  };

  // The cut after which the least surface is left in regions that are still deep, weighed against
  // the air in both hulls. Depth matters because an opening is rid of by cutting its walls off one
  // by one, which gains no air before the last. Faces are preferred, since walls end there, and so
  // are halves over slivers.
  std::optional<Cut> BestCut(const Region& region, Depths depths) const {
    constexpr double kAirWeight = 0.5;
    constexpr double kFaceBonus = 0.02;
    constexpr double kHalfBonus = 0.05;
    const double whole = VolumeOf(region.hull);
    std::optional<Cut> best;
    double best_score = 1e300;
    for (const Candidate& candidate : Candidates(region, solid_.grid().cell_m)) {
      const std::optional<Side> below = SideOf(region, candidate.cut, -1, depths);
      const std::optional<Side> above = SideOf(region, candidate.cut, 1, depths);
      if (!below || !above) continue;
      const double deep = (below->depth_m * below->area_m2 + above->depth_m * above->area_m2) /
                          (region.concavity.depth_m * (below->area_m2 + above->area_m2));
      const double score = deep + kAirWeight * (below->volume_m3 + above->volume_m3) / whole -
                           kFaceBonus * candidate.face_share -
                           kHalfBonus * std::min(below->volume_m3, above->volume_m3) / whole;
      if (score >= best_score - 1e-9) continue;  // ties: the first
      best_score = score;
      best = candidate.cut;
    }
    return best;
  }

  // Nothing where the side is empty or flat.
  std::optional<Side> SideOf(const Region& region, const Cut& cut, int sign, Depths depths) const {
    CheckWork();
    const std::vector<Polygon> surface = OneSide(region, cut, sign);
    const std::optional<TriangleMesh> hull = HullOf(PointsOf(surface));
    if (!hull || !(VolumeOf(*hull) > smallest_m3_)) return std::nullopt;
    Side side{VolumeOf(*hull), ComparableDepth(*hull, depths), 0};
    for (const Polygon& polygon : surface) side.area_m2 += 0.5 * DoubledAreaOf(polygon).norm();
    return side;
  }

  // Of a hull, where it makes a cut necessary; every third row or point is enough to compare.
  double ComparableDepth(const TriangleMesh& hull, Depths depths) const {
    constexpr int kStride = 3;
    if (depths == Depths::kMeasured) return Protrusion(hull, kStride).depth_m;
    const double depth_m = ConcavityOf(hull, solid_, kStride).depth_m;
    return depth_m > allowed_m_ ? depth_m : 0;
  }

  // The surface on one side of a cut, and the points in the solid that were noted for it.
  std::vector<Polygon> OneSide(const Region& region, const Cut& cut, int sign) const {
    std::vector<Polygon> kept;
    for (const Polygon& polygon : region.surface) {
      if (IsSkinOfOtherSide(polygon, cut, sign, SkinM()) && !IsNotedFor(region, polygon, cut, sign))
        continue;
      Polygon clipped = Clipped(polygon, cut, sign);
      if (!clipped.corners.empty()) kept.push_back(std::move(clipped));
    }
    return kept;
  }

  // Whether the solid begins at the point in the direction of the box's inside. Asked a little way
  // inside, because the point itself often lies on a face.
  bool IsSolidBehind(const Eigen::Vector3d& point, const Eigen::AlignedBox3d& box) const {
    Eigen::Vector3d inside = point;
    for (int axis = 0; axis < 3; ++axis) {
      const double way = box.center()[axis] - point[axis];
      inside[axis] += std::clamp(way, -2 * SkinM(), 2 * SkinM());
    }
    return tree_.IsInside(inside);
  }

  // A noted point on the cut belongs to each side on which the solid goes on behind it.
  bool IsNotedFor(const Region& region, const Polygon& polygon, const Cut& cut, int sign) const {
    if (!polygon.IsNotedPoint()) return false;
    const Eigen::Vector3d& point = polygon.corners[0];
    if (sign * (point[cut.axis] - cut.position_m) < 0) return false;
    Eigen::AlignedBox3d side = region.box;
    (sign < 0 ? side.max() : side.min())[cut.axis] = cut.position_m;
    return IsSolidBehind(point, side);
  }

  // What a part may lack of the solid near a cut.
  double SkinM() const { return 0.1 * allowed_m_; }

  // Joins pairs whose common hull is no deeper than `depth_m` until `enough` regions are left:
  // those that enclose least air first within the bound, else the least deep.
  bool JoinWithin(double depth_m, int enough) {
    bool any = false;
    while (static_cast<int>(regions_.size()) > enough && JoinBestPair(depth_m)) any = true;
    return any;
  }

  bool JoinBestPair(double depth_m) {
    Cost least{depth_m, 1e300};
    RegionPair best{0, 0};
    for (std::size_t a = 0; a < regions_.size(); ++a) {
      for (std::size_t b = a + 1; b < regions_.size(); ++b) {
        const Between between = BetweenOf(regions_[a], regions_[b], depth_m);
        const Cost cost = CostOf(between);
        if (between.depth_m > depth_m || cost >= least) continue;
        least = cost;
        best = {a, b};
      }
    }
    if (best.second == 0) return false;
    Join(best);
    return true;
  }

  // The second of the pair, which comes after the first, is gone.
  void Join(const RegionPair& pair) {
    Region joined = std::move(regions_[pair.first]);
    const Region& other = regions_[pair.second];
    joined.id = next_id_++;
    joined.box.extend(other.box);
    joined.surface.insert(joined.surface.end(), other.surface.begin(), other.surface.end());
    joined.hull = *CommonHull(joined, other);
    joined.concavity = ConcavityOf(joined.hull, solid_);
    joined.indivisible = false;
    joined.trimmed = false;
    regions_[pair.first] = std::move(joined);
    regions_.erase(regions_.begin() + static_cast<std::ptrdiff_t>(pair.second));
  }

  static std::optional<TriangleMesh> CommonHull(const Region& a, const Region& b) {
    std::vector<Eigen::Vector3d> points = a.hull.vertices;
    points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
    return HullOf(points);
  }

  const Between& BetweenOf(const Region& a, const Region& b, double bound_m) {
    Between& between = between_[{a.id, b.id}];
    // what lies within the bound that was asked for is exact, what lies beyond stays beyond
    if (between.asked_m > 0 && (between.depth_m <= between.asked_m || bound_m <= between.asked_m))
      return between;
    between.asked_m = bound_m;
    CheckWork(500);
    if (a.box.exteriorDistance(b.box) > solid_.grid().cell_m) return between;
    const std::optional<TriangleMesh> hull = CommonHull(a, b);
    if (!hull) return between;
    between.depth_m = DepthWithin(*hull, solid_, bound_m);
    between.air_m3 = VolumeOf(*hull) - VolumeOf(a.hull) - VolumeOf(b.hull);
    return between;
  }

  const ClosedMesh* mesh_;
  ConvexPartsConfig config_;
  TriangleTree tree_;
  DistanceGrid solid_;
  double allowed_m_;
  double smallest_m3_ = 0;
  std::vector<Region> regions_;
  std::vector<Region> whole_;  // the first of them
  int next_id_ = 0;
  std::map<std::pair<int, int>, Between> between_;
  std::map<int, Concavity> measured_;  // by the region's id
  std::map<std::pair<int, int>, double> measured_between_;
};

void CheckConfig(const ConvexPartsConfig& config) {
  Require(config.max_parts >= 1, ErrorCode::kInvalidConfig, "convex.max_parts: allowed 1 and more");
  Require(config.max_concavity_m > 0 && std::isfinite(config.max_concavity_m),
          ErrorCode::kInvalidConfig, "convex.max_concavity_m: must be positive");
  Require(config.max_protrusion_m >= 0 && std::isfinite(config.max_protrusion_m),
          ErrorCode::kInvalidConfig, "convex.max_protrusion_m: must not be negative");
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
