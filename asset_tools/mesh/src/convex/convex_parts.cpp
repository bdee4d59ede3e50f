// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/convex_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

#include "convex/convex_region.h"
#include "convex/cover_parts.h"
#include "convex/cut_surface.h"
#include "convex/growing_hull.h"
#include "convex/hull_depth.h"
#include "measure/distance_grid.h"
#include "measure/triangle_tree.h"

namespace doorforge {
namespace {

constexpr double kCoverShare = 0.25;     // of the concavity: what the parts may leave out
constexpr double kFineCoverShare = 0.1;  // the same after cuts that were measured
constexpr double kCutShare = 0.875;      // of the parts: what those cuts may use in any case
constexpr int kExchanges = 16;           // measured cuts and joins without gain before they end
constexpr double kSearchHull = 0.01;     // of the concavity: what hulls of the search leave out
constexpr double kComparedCells = 1;     // to within which depths are told where cuts are compared
constexpr double kFineStep = 0.5;        // cells: to within which protrusion is found
constexpr double kCoarseStep = 1.25;     // the same where cuts are compared
constexpr double kHeldSkins = 2;         // how far surface may stand out of a hull that holds it
constexpr int kRounds = 4;               // of cutting and joining
constexpr double kSurplus = 2;           // regions, against those that may stay, to join from
constexpr double kMostSurplus = 4;       // the same for a second search
constexpr double kWorthwhile = 0.97;     // less of the depth must be left for another round
constexpr double kStepsOfPoint = 22;     // of a point from which a hull is made, with what follows
constexpr double kStepsOfCover = 1e7;    // of looking for what the parts leave out
constexpr double kAgain = 0.6;  // of what may be looked at: after more no second search begins

// The part of the solid inside one box: the surface in it, clipped, and the box's corners that lie
// in the solid. Their hull is the hull of the part.
struct Region {
  int id = 0;
  Eigen::AlignedBox3d box;
  CutSurface surface;
  TriangleMesh hull;                                 // but for what the search may leave out
  std::vector<HalfSpace> faces;                      // of the hull
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // a point in it
  double volume_m3 = 0;                              // the same
  Concavity concavity;                               // of what is deeper than is allowed
  bool indivisible = false;                          // no cut separates anything
  bool trimmed = false;                              // of what others hold as well
};

// Where a cut may separate something.
struct Candidate {
  AxisCut cut;
  double face_share = 0;  // area of the faces in its plane, against the largest such area
};

// Faces, then even steps, then the deepest point of the concavity.
std::vector<Candidate> Candidates(const Region& region, double bin_m) {
  constexpr std::size_t kFaces = 6;
  constexpr int kSteps = 7;
  std::vector<Candidate> candidates;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const CutSurface::Face& face : region.surface.FacesAcross(axis, bin_m, kFaces)) {
      candidates.push_back({{axis, face.position_m}, face.area_m2});
      largest = std::max(largest, face.area_m2);
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

Eigen::Vector3d MiddleOf(const TriangleMesh& hull) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : hull.vertices)
    middle += vertex / static_cast<double>(hull.vertices.size());
  return middle;
}

class Decomposition {
 public:
  Decomposition(const ClosedMesh& mesh, const ConvexPartsConfig& config)
      : mesh_(&mesh),
        config_(config),
        tree_(mesh.mesh()),
        solid_(mesh, CellFor(mesh.mesh(), config.max_concavity_m / 3, 0, config.max_grid_cells)),
        // the grid sees depths to within half a cell
        distances_(solid_, tree_),
        allowed_m_(std::max(config.max_concavity_m - 0.5 * solid_.grid().cell_m,
                            0.5 * config.max_concavity_m)) {
    Region whole;
    for (const Eigen::Vector3d& vertex : mesh.mesh().vertices) whole.box.extend(vertex);
    for (const Eigen::Vector3i& t : mesh.mesh().triangles) {
      std::array<Eigen::Vector3d, 3> corners;
      for (int k = 0; k < 3; ++k)
        corners[static_cast<std::size_t>(k)] = mesh.mesh().vertices[static_cast<std::size_t>(t[k])];
      whole.surface.AddPolygon(corners, WallBehind(corners));
    }
    whole.surface.Weld();
    smallest_m3_ = 1e-9 * whole.box.volume();
    if (Enclose(whole, {})) regions_.push_back(std::move(whole));
    whole_ = regions_;
  }

  std::vector<TriangleMesh> Run() {
    CutAndJoin(config_.max_parts);
    if (WorstDepth() > allowed_m_) SpendBetter();
    if (WorstDepth() > allowed_m_ && MayLook(kAgain)) SearchAgain();
    std::vector<TriangleMesh> parts = Covered(kCoverShare);
    if (config_.max_protrusion_m > 0) parts = Measured(std::move(parts));
    for (TriangleMesh& part : parts) part = ConvexHull(part.vertices);
    return parts;
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

  double WallBehind(const std::array<Eigen::Vector3d, 3>& p) const {
    const Eigen::Vector3d inwards = -(p[1] - p[0]).cross(p[2] - p[0]).normalized();
    return tree_.FirstHit((p[0] + p[1] + p[2]) / 3, inwards, 1e-3 * SkinM());
  }

  // Fills in hull and concavity; false where the region holds nothing. Of the box's corners those
  // count that lie in the solid and in the hull that the region is cut from: the box of two regions
  // that were joined holds what belongs to others.
  bool Enclose(Region& region, const std::vector<HalfSpace>& cut_from) {
    // kept with the surface, so that later cuts and joins know them
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point =
          region.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      if (IsHeldBy(cut_from, {&point, 1}) && IsSolidBehind(point, region.box))
        region.surface.AddNotedPoint(point);
    }
    region.surface.Weld();
    return SetHull(region, SearchHull(region.surface.points()));
  }

  // False where the hull holds nothing.
  bool SetHull(Region& region, std::optional<TriangleMesh> hull) {
    region.id = next_id_++;
    if (!hull) return false;
    region.volume_m3 = VolumeOf(*hull);
    if (!(region.volume_m3 > smallest_m3_)) return false;
    region.hull = *std::move(hull);
    region.faces = HalfSpacesOf(region.hull);
    region.middle = MiddleOf(region.hull);
    region.concavity = ConcavityOf(region.hull, solid_, {.above_m = allowed_m_});
    return true;
  }

  // Whether less than this share of what may be looked at was.
  bool MayLook(double share) const {
    constexpr double kMillion = 1e6;
    const double steps = kStepsOfPoint * static_cast<double>(points_) + kStepsOfCover * covers_ +
                         static_cast<double>(distances_.steps());
    return config_.max_search == 0 || steps < share * kMillion * config_.max_search;
  }

  // What the hulls of the search leave out does not change what a grid sees of them.
  std::optional<TriangleMesh> SearchHull(std::span<const Eigen::Vector3d> points) {
    points_ += points.size();
    return GrownHull(points, kSearchHull * allowed_m_);
  }

  double WorstDepth() const {
    double worst_m = 0;
    for (const Region& region : regions_) worst_m = std::max(worst_m, region.concavity.depth_m);
    return worst_m;
  }

  std::vector<TriangleMesh> Covered(double share) {
    ++covers_;
    std::vector<TriangleMesh> parts;
    for (const Region& region : regions_) {
      if (const std::optional<TriangleMesh>& part = PartOf(region)) parts.push_back(*part);
    }
    return Covering(std::move(parts), *mesh_, solid_,
                    {.tolerance_m = share * config_.max_concavity_m,
                     .allowed_m = allowed_m_,
                     .max_parts = config_.max_parts,
                     .max_vertices = config_.max_vertices});
  }

  const std::optional<TriangleMesh>& PartOf(const Region& region) {
    const auto [entry, is_new] = parts_.try_emplace(region.id);
    if (is_new) {
      entry->second = HullOf(region.surface.points());
      if (entry->second) entry->second = ReducedHull(*entry->second, config_.max_vertices);
    }
    return entry->second;
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
    for (int since = 0; since < kExchanges && MayLook(1); ++since) {
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

  // It looks at regions that stand out by more than they may and that a cut may divide.
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
      const double depth_m = MeasuredBetween(regions_[pair.first], regions_[pair.second], below_m);
      if (depth_m >= below_m) continue;
      best = pair;
      if (depth_m <= config_.max_protrusion_m) break;
      below_m = depth_m;
    }
    return best;
  }

  // Any depth beyond the bound that was asked for, as BetweenOf().
  double MeasuredBetween(const Region& a, const Region& b, double bound_m) {
    Between& between = measured_between_[{a.id, b.id}];
    if (between.asked_m > 0 && (between.depth_m <= between.asked_m || bound_m <= between.asked_m))
      return between.depth_m;
    between.asked_m = bound_m;
    const std::optional<TriangleMesh> hull = CommonHull(a, b);
    if (hull) between.depth_m = Protrusion(*hull, kFineStep, bound_m).depth_m;
    return between.depth_m;
  }

  // The point of the hull's surface that is farthest from the mesh's, if it is farther than may be;
  // depth 0 where there is none.
  Concavity Protrusion(const TriangleMesh& hull, double step_cells = kFineStep,
                       double stop_m = kNoStop) {
    return ProtrusionOf(hull, distances_, {.above_m = config_.max_protrusion_m, .stop_m = stop_m},
                        step_cells * solid_.grid().cell_m);
  }

  double MostProtrusion(const std::vector<TriangleMesh>& parts) {
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
    std::vector<const Region*> others;
    std::vector<int> ids{region.id};
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      if (i == index || regions_[i].box.exteriorDistance(region.box) > kHeldSkins * SkinM())
        continue;
      others.push_back(&regions_[i]);
      ids.push_back(regions_[i].id);
    }
    const auto [entry, is_new] = trimmed_.try_emplace(std::move(ids));
    if (is_new) entry->second = TrimmedBy(others, region);
    const std::optional<Region>& trimmed = entry->second;
    if (!trimmed) return false;
    if (trimmed->hull.vertices.empty())
      regions_.erase(regions_.begin() + static_cast<std::ptrdiff_t>(index));
    else
      region = *trimmed;
    return true;
  }

  // Without what the hulls of others hold; without a hull where that is all, and nothing where it
  // changes nothing.
  std::optional<Region> TrimmedBy(const std::vector<const Region*>& others, Region region) {
    CutSurface kept = region.surface.Without([&](std::span<const Eigen::Vector3d> corners) {
      return std::any_of(others.begin(), others.end(),
                         [&](const Region* other) { return IsHeldBy(other->faces, corners); });
    });
    if (kept.PolygonCount() == region.surface.PolygonCount()) return std::nullopt;
    if (kept.PolygonCount() == 0 || !SetHull(region, SearchHull(kept.points()))) return Region{};
    region.surface = std::move(kept);
    return region;
  }

  // Wholly in the hull, but for a skin.
  bool IsHeldBy(const std::vector<HalfSpace>& hull,
                std::span<const Eigen::Vector3d> corners) const {
    return std::all_of(hull.begin(), hull.end(), [&](const HalfSpace& face) {
      return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& p) {
        return face.normal.dot(p) <= face.offset + kHeldSkins * SkinM();
      });
    });
  }

  static double UrgencyOf(const Region& region) {
    return region.indivisible ? 0 : region.concavity.depth_m;
  }

  // Replaces a region by its two sides of the best cut; false if no cut separates anything.
  bool Split(std::size_t index, Depths depths) {
    const std::vector<Region>& sides = SidesOf(regions_[index], depths);
    if (sides.size() < 2) return false;
    regions_[index] = sides[0];
    regions_.push_back(sides[1]);
    return true;
  }

  // The two sides of the best cut, or fewer. A search that begins anew, or goes back to what was
  // best, asks for many of them again, and for the largest.
  const std::vector<Region>& SidesOf(const Region& region, Depths depths) {
    const auto [entry, is_new] = sides_.try_emplace({region.id, depths});
    std::vector<Region>& sides = entry->second;
    if (!is_new) return sides;
    const std::optional<AxisCut> cut = BestCut(region, depths);
    if (!cut) return sides;
    for (const int sign : {-1, 1}) {
      Region side;
      side.box = SideOfBox(region.box, {*cut, sign});
      side.surface = region.surface.Side({*cut, sign}, SkinM(), NotedFor(side.box));
      if (Enclose(side, region.faces)) sides.push_back(std::move(side));
    }
    return sides;
  }

  static Eigen::AlignedBox3d SideOfBox(Eigen::AlignedBox3d box, const CutSide& side) {
    (side.sign < 0 ? box.max() : box.min())[side.cut.axis] = side.cut.position_m;
    return box;
  }

  // A noted point on the cut belongs to each side on which the solid goes on behind it.
  CutSurface::IsNotedFor NotedFor(const Eigen::AlignedBox3d& side) const {
    return [this, side](const Eigen::Vector3d& point) { return IsSolidBehind(point, side); };
  }

  // One side of a possible cut, as far as it decides between cuts.
  struct Side {
    TriangleMesh hull;
    double volume_m3 = 0;  // of the hull
    double area_m2 = 0;    // of the surface in it
  };

  // A cut with all of its score but the depths, which only add to it.
  struct RatedCut {
    AxisCut cut;
    std::array<Side, 2> sides;
    double least_score = 0;
  };

  // The cut after which the least surface is left in regions that are still deep, weighed against
  // the air in both hulls. Depth matters because an opening is rid of by cutting its walls off one
  // by one, which gains no air before the last. Faces are preferred, since walls end there, and so
  // are halves over slivers. Of equal cuts the one with the least score without depths is taken,
  // then the first.
  std::optional<AxisCut> BestCut(const Region& region, Depths depths) {
    std::vector<RatedCut> rated;
    for (const Candidate& candidate : Candidates(region, solid_.grid().cell_m)) {
      if (std::optional<RatedCut> cut = Rated(region, candidate)) rated.push_back(*std::move(cut));
    }
    std::stable_sort(rated.begin(), rated.end(), [](const RatedCut& a, const RatedCut& b) {
      return a.least_score < b.least_score;
    });
    std::optional<AxisCut> best;
    double best_score = 1e300;
    for (const RatedCut& cut : rated) {
      const double score = ScoreOf(region, cut, depths, best_score - 1e-9);
      if (score >= best_score - 1e-9) continue;
      best_score = score;
      best = cut.cut;
    }
    return best;
  }

  // Nothing where a side is empty or flat.
  std::optional<RatedCut> Rated(const Region& region, const Candidate& candidate) {
    constexpr double kAirWeight = 0.5;
    constexpr double kFaceBonus = 0.02;
    constexpr double kHalfBonus = 0.05;
    std::optional<Side> lower = SideOf(region, {candidate.cut, -1});
    if (!lower) return std::nullopt;
    std::optional<Side> upper = SideOf(region, {candidate.cut, 1});
    if (!upper) return std::nullopt;
    const double score =
        kAirWeight * (lower->volume_m3 + upper->volume_m3) / region.volume_m3 -
        kFaceBonus * candidate.face_share -
        kHalfBonus * std::min(lower->volume_m3, upper->volume_m3) / region.volume_m3;
    return RatedCut{candidate.cut, {*std::move(lower), *std::move(upper)}, score};
  }

  // With the depths; any that is no less than `below` where it is no less.
  double ScoreOf(const Region& region, const RatedCut& cut, Depths depths, double below) {
    double score = cut.least_score;
    const double area_m2 = cut.sides[0].area_m2 + cut.sides[1].area_m2;
    for (const Side& side : cut.sides) {
      if (score >= below) break;
      // of the score, a depth of one metre
      const double weight = side.area_m2 / (region.concavity.depth_m * area_m2);
      score += weight * ComparableDepth(side.hull, depths, (below - score) / weight);
    }
    return score;
  }

  // Nothing where the side is empty or flat.
  std::optional<Side> SideOf(const Region& region, const CutSide& side) {
    CheckWork();
    region.surface.FindSide(side, SkinM(), NotedFor(SideOfBox(region.box, side)), content_);
    std::optional<TriangleMesh> hull = SearchHull(content_.points);
    if (!hull) return std::nullopt;
    const double volume_m3 = VolumeOf(*hull);
    if (!(volume_m3 > smallest_m3_)) return std::nullopt;
    return Side{*std::move(hull), volume_m3, content_.area_m2};
  }

  // It measures a hull, where that makes a cut necessary, and stops at any depth beyond `stop_m`.
  double ComparableDepth(const TriangleMesh& hull, Depths depths, double stop_m) {
    if (depths == Depths::kMeasured) return Protrusion(hull, kCoarseStep, stop_m).depth_m;
    const DepthRange range{
        .above_m = allowed_m_, .stop_m = stop_m, .step_m = kComparedCells * solid_.grid().cell_m};
    return ConcavityOf(hull, solid_, range).depth_m;
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
    std::optional<TriangleMesh> hull = CommonHull(joined, other);
    joined.box.extend(other.box);
    joined.surface.Append(other.surface);
    joined.surface.Weld();
    SetHull(joined, std::move(hull));
    joined.indivisible = false;
    joined.trimmed = false;
    regions_[pair.first] = std::move(joined);
    regions_.erase(regions_.begin() + static_cast<std::ptrdiff_t>(pair.second));
  }

  std::optional<TriangleMesh> CommonHull(const Region& a, const Region& b) {
    std::vector<Eigen::Vector3d> points = a.hull.vertices;
    points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
    return SearchHull(points);
  }

  // Whether there is so much air between two regions that their common hull, which holds the ways
  // from points of one to points of the other, is known to be deeper than the bound: it need not be
  // made then. Regions need not touch: those on both sides of a bar go through it.
  bool LieApart(const Region& a, const Region& b, double bound_m) const {
    constexpr std::size_t kWays = 16;
    constexpr double kGap = 0.5;  // of the smaller region: what may lie between them
    const double smaller_m = std::min(a.box.diagonal().norm(), b.box.diagonal().norm());
    if (a.box.exteriorDistance(b.box) > std::max(solid_.grid().cell_m, kGap * smaller_m))
      return true;
    if (IsDeepBetween(a.middle, b.middle, bound_m)) return true;
    const std::vector<Eigen::Vector3d>& from = a.hull.vertices;
    const std::vector<Eigen::Vector3d>& to = b.hull.vertices;
    for (std::size_t way = 0; way < kWays; ++way) {
      const std::size_t other = (5 * way + 2) % kWays;  // in another order
      if (IsDeepBetween(from[way * from.size() / kWays], to[other * to.size() / kWays], bound_m))
        return true;
    }
    return false;
  }

  // Asked at a few points, with what a hull's deepest cell may lack of a point in the hull.
  bool IsDeepBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double bound_m) const {
    constexpr int kAsked = 8;
    const Eigen::Vector3d way = to - from;
    const double slack_m = std::sqrt(3.0) * solid_.grid().cell_m;
    for (int i = 1; i < kAsked; ++i) {
      const Eigen::Vector3i cell = solid_.grid().CellAt(from + way * i / kAsked);
      if (solid_.DistanceAt(cell.x(), cell.y(), cell.z()) > bound_m + slack_m) return true;
    }
    return false;
  }

  const Between& BetweenOf(const Region& a, const Region& b, double bound_m) {
    Between& between = between_[{a.id, b.id}];
    // what lies within the bound that was asked for is exact, what lies beyond stays beyond
    if (between.asked_m > 0 && (between.depth_m <= between.asked_m || bound_m <= between.asked_m))
      return between;
    between.asked_m = bound_m;
    CheckWork(500);
    if (LieApart(a, b, bound_m)) return between;
    const std::optional<TriangleMesh> hull = CommonHull(a, b);
    if (!hull) return between;
    between.depth_m =
        ConcavityOf(*hull, solid_, {.above_m = allowed_m_, .stop_m = bound_m}).depth_m;
    between.air_m3 = VolumeOf(*hull) - a.volume_m3 - b.volume_m3;
    return between;
  }

  const ClosedMesh* mesh_;
  ConvexPartsConfig config_;
  TriangleTree tree_;
  DistanceGrid solid_;
  MeasuredDistances distances_;
  double allowed_m_;
  double smallest_m3_ = 0;
  std::vector<Region> regions_;
  std::vector<Region> whole_;  // the first of them
  int next_id_ = 0;
  std::size_t points_ = 0;  // from which hulls were made
  int covers_ = 0;          // how often what the parts leave out was looked for
  std::map<std::pair<int, int>, Between> between_;
  std::map<int, std::optional<TriangleMesh>> parts_;             // by the region's id
  std::map<int, Concavity> measured_;                            // by the region's id
  std::map<std::pair<int, Depths>, std::vector<Region>> sides_;  // the same
  std::map<std::vector<int>, std::optional<Region>> trimmed_;    // by its id, then the others'
  std::map<std::pair<int, int>, Between> measured_between_;
  CutSurface::SideContent content_;  // of the side that is looked at
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
  Require(config.max_search >= 0, ErrorCode::kInvalidConfig,
          "convex.max_search: allowed 0 (anything) and more");
}

}  // namespace

std::vector<TriangleMesh> ConvexParts(const ClosedMesh& mesh, const ConvexPartsConfig& config) {
  CheckConfig(config);
  return Decomposition(mesh, config).Run();
}

}  // namespace doorforge
