// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/repair_mesh.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <new>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/work_budget.h"

#include "measure/mesh_pieces.h"
#include "measure/surface_samples.h"
#include "measure/triangle_tree.h"
#include "repair/collapse_edges.h"
#include "repair/separate_pieces.h"
#include "repair/solid_shells.h"
#include "repair/surface_operations.h"

namespace doorforge {
namespace {

constexpr double kWeldFraction = 1e-6;  // of D: what exporters round away
constexpr double kFlatFraction = 1e-6;  // of D: thinner closed pieces have no inside to speak of
constexpr double kFlatHoleSize = 0.35;  // of D: larger flat holes are openings that someone meant
constexpr double kFlatHoleFraction = 1e-4;  // of D: how far a flat hole may leave its plane
constexpr double kFlatAreaShare = 0.01;   // of all area: flat pieces of more than this become walls
constexpr double kFreeErrorShare = 0.25;  // of the offset: error of a wrap that costs nothing
constexpr double kShiftFraction = 3e-5;   // of D: how far pieces move so that nothing only touches

constexpr double kGoodFraction = 0.01;    // of D: an exact result farther off competes with a wrap
constexpr std::size_t kBudgetFactor = 3;  // triangles of the output for one of the input,
constexpr std::size_t kBudget = 5000;     // and besides

void CheckConfig(const RepairConfig& config) {
  const auto require = [](bool holds, const char* message) {
    Require(holds, ErrorCode::kInvalidConfig, message);
  };
  require(config.alpha_fraction >= 1e-4 && config.alpha_fraction <= 1,
          "repair.alpha_fraction: allowed 0.0001..1");
  require(config.offset_fraction >= 1e-5 && config.offset_fraction <= 1,
          "repair.offset_fraction: allowed 0.00001..1");
  require(config.max_hole_fraction >= 0 && config.max_hole_fraction <= 1,
          "repair.max_hole_fraction: allowed 0..1");
  require(config.max_flat_hole_share >= 0 && config.max_flat_hole_share <= 1,
          "repair.max_flat_hole_share: allowed 0..1");
  require(config.max_cap_fraction >= 0 && config.max_cap_fraction <= 1,
          "repair.max_cap_fraction: allowed 0..1");
  require(config.max_triangles == 0 || config.max_triangles >= 100,
          "repair.max_triangles: allowed 0 (any number) or 100 and more");
  require(config.max_pairs >= 0, "repair.max_pairs: allowed 0 and more");
}

std::string Count(int count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// One repair from input to report; the members are what the steps pass on.
class Repair {
 public:
  Repair(const TriangleMesh& input, const RepairConfig& config)
      : input_(&input), config_(config), pairs_(static_cast<std::size_t>(config.max_pairs)) {
    const MeshTopology topology = MeasureTopology(input);
    diagonal_m_ = topology.bounds.isEmpty() ? 0 : topology.bounds.diagonal().norm();
  }

  RepairResult Run() {
    if (!(diagonal_m_ > 0)) return Failed("the mesh has no extent");
    soup_ = Welded(*input_, kWeldFraction * diagonal_m_);
    report_.before = MeasureTopology(soup_);
    if (soup_.vertices.size() < input_->vertices.size())
      Did("welded " + std::to_string(input_->vertices.size()) + " vertices to " +
          std::to_string(soup_.vertices.size()));
    if (!(report_.before.area_m2 > 0)) return Failed("no triangle has an area");
    surface_ = soup_;
    try {
      return Best();
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      return Failed("a step failed on it; export it again or in another format");
    }
  }

 private:
  void Did(std::string step) { report_.steps.push_back(std::move(step)); }

  RepairResult Failed(std::string reason) {
    report_.outcome = RepairOutcome::kFailed;
    report_.reason = std::move(reason);
    return {std::nullopt, std::move(report_)};
  }

  // The exact result where there is one that is near enough, else the wrap, or whichever is nearer.
  RepairResult Best() {
    TriangleMesh mesh;
    if (config_.wrap == WrapUse::kAlways)
      report_.reason = "a wrap was asked for";
    else
      mesh = KeptExactly();
    if (mesh.triangles.empty())
      return config_.wrap == WrapUse::kNever ? Failed(report_.reason)
                                             : Finished(WithinBudget(Wrapped()));
    const RepairReport begun = report_;
    RepairResult exact = Finished(WithinBudget(std::move(mesh)));
    if (config_.wrap == WrapUse::kNever || IsGood(exact)) return exact;
    report_ = begun;
    report_.reason = "the union of its pieces and walls is farther off or has more triangles";
    RepairResult wrap = Finished(WithinBudget(Wrapped()));
    const bool nearer = wrap.mesh && WorstOf(wrap.report) < WorstOf(exact.report);
    return nearer || IsGood(wrap) ? wrap : exact;
  }

  static double WorstOf(const RepairReport& report) {
    return std::max(report.output_to_input.max_m, report.visible_input_to_output.max_m);
  }

  bool IsGood(const RepairResult& result) const {
    if (!result.mesh) return false;
    const bool in_budget =
        config_.max_triangles == 0 ||
        static_cast<int>(result.mesh->mesh().triangles.size()) <= BudgetOfInput();
    return in_budget && WorstOf(result.report) <= kGoodFraction * diagonal_m_;
  }

  // The union of the input's pieces, where open ones count as thin walls; empty, with a reason,
  // where it cannot be had without crossings.
  TriangleMesh KeptExactly() {
    const bool is_closed =
        report_.before.non_manifold_vertices == 0 && ClosedMesh::From(soup_).has_value();
    report_.outcome = is_closed ? RepairOutcome::kAlreadyClosed : RepairOutcome::kRepaired;
    if (!is_closed) surface_ = Closed();
    std::vector<TriangleMesh> pieces = PiecesOf(surface_);
    std::vector<TriangleMesh> sheets;  // closed ones without an inside
    if (!SortOutFlat(pieces, sheets)) return {};
    if (!is_closed && !UntangleThoseThatStay(pieces, sheets)) return {};
    if (!AddWalls(pieces, std::move(sheets))) return {};
    if (is_closed) {
      OrientKeepingCavities(pieces);
    } else {
      OrientOutwards(pieces);
      DropHidden(pieces);
    }
    report_.components_kept = static_cast<int>(pieces.size());
    return WithoutCrossings(std::move(pieces));
  }

  TriangleMesh Closed() {
    SolidShells solids = SolidShellsOf(soup_, kFlatFraction * diagonal_m_);
    if (solids.shells.empty()) return Closed(soup_);
    Did("took " + Count(static_cast<int>(solids.shells.size()), "solid") +
        " apart at shared edges with " + Count(solids.split_vertices, "copied corner"));
    if (!solids.rest.triangles.empty()) solids.shells.push_back(Closed(solids.rest));
    return Merged(solids.shells);
  }

  TriangleMesh Closed(const TriangleMesh& soup) {
    ClosedSoup closed = CloseSoup(soup,
                                  {.max_size_m = config_.max_hole_fraction * diagonal_m_,
                                   .max_flat_size_m = kFlatHoleSize * diagonal_m_,
                                   .max_flat_area_share = config_.max_flat_hole_share,
                                   .flatness_m = kFlatHoleFraction * diagonal_m_,
                                   .max_cap_distance_m = config_.max_cap_fraction * diagonal_m_},
                                  soup_);
    if (closed.degenerate_triangles > 0)
      Did("dropped " + Count(closed.degenerate_triangles, "degenerate triangle"));
    if (closed.duplicate_triangles > 0)
      Did("dropped " + Count(closed.duplicate_triangles, "duplicate triangle"));
    Did("oriented and stitched the surface");
    if (closed.split_vertices > 0)
      Did("cut non-manifold places apart with " + Count(closed.split_vertices, "copied corner"));
    if (closed.holes_filled > 0) Did("filled " + Count(closed.holes_filled, "hole"));
    if (closed.far_caps > 0)
      Did("left " + Count(closed.far_caps, "hole") + " open whose cap would lie more than " +
          std::to_string(1000 * config_.max_cap_fraction * diagonal_m_) + " mm from the surface");
    report_.holes_filled = closed.holes_filled;
    return std::move(closed.mesh);
  }

  // Closed without an inside, as a sheet that is drawn with both its sides, or all needle.
  bool IsFlat(const TriangleMesh& piece) const {
    const MeshTopology topology = MeasureTopology(piece);
    const double thickness_m = topology.boundary_edges == 0
                                   ? 2 * std::abs(topology.volume_m3) / topology.area_m2
                                   : 2 * topology.area_m2 / topology.bounds.diagonal().norm();
    return !(thickness_m > kFlatFraction * diagonal_m_);
  }

  // Removes pieces without thickness, or moves those that matter to the pieces that become walls.
  // False, with a reason, if none has any extent.
  bool SortOutFlat(std::vector<TriangleMesh>& pieces, std::vector<TriangleMesh>& sheets) {
    const auto first_flat = std::stable_partition(
        pieces.begin(), pieces.end(), [&](const TriangleMesh& piece) { return !IsFlat(piece); });
    std::vector<TriangleMesh> flat(std::make_move_iterator(first_flat),
                                   std::make_move_iterator(pieces.end()));
    pieces.erase(first_flat, pieces.end());
    double flat_area = 0;
    for (const TriangleMesh& piece : flat) flat_area += MeasureTopology(piece).area_m2;
    if (pieces.empty() || flat_area > kFlatAreaShare * report_.before.area_m2) {
      for (TriangleMesh& piece : flat) {
        if (MeasureTopology(piece).boundary_edges == 0 &&
            !IsNeedle(piece, config_.offset_fraction * diagonal_m_))
          sheets.push_back(std::move(piece));
      }
      std::erase_if(flat, [](const TriangleMesh& piece) { return piece.triangles.empty(); });
    }
    if (!flat.empty())
      Did("dropped " + Count(static_cast<int>(flat.size()), "piece") + " without thickness");
    report_.components_dropped += static_cast<int>(flat.size());
    if (pieces.empty() && sheets.empty()) report_.reason = "no piece has an extent";
    return !pieces.empty() || !sheets.empty();
  }

  // Closed pieces that cross themselves, before walls are made of others, which takes the longest:
  // false, with a reason, where one cannot be untangled, which ends it all. One that may lie hidden
  // in another waits until that is known.
  bool UntangleThoseThatStay(std::vector<TriangleMesh>& pieces,
                             const std::vector<TriangleMesh>& sheets) {
    std::vector<Eigen::AlignedBox3d> boxes;
    std::vector<char> is_open;
    for (const TriangleMesh& piece : pieces) {
      boxes.push_back(BoxAround(piece));
      is_open.push_back(MeasureTopology(piece).boundary_edges > 0);
    }
    if (sheets.empty() && std::find(is_open.begin(), is_open.end(), 1) == is_open.end())
      return true;
    for (const TriangleMesh& sheet : sheets) boxes.push_back(BoxAround(sheet));
    // as far as a vertex of a wall may stand out where its triangles fold sharply, and more
    const double wall_m = 4 * config_.offset_fraction * diagonal_m_;
    std::vector<TriangleMesh*> tangled;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto may_hide = [&](const Eigen::AlignedBox3d& box) {
        return &box != &boxes[i] &&
               Eigen::AlignedBox3d(box.min().array() - wall_m, box.max().array() + wall_m)
                   .contains(boxes[i]);
      };
      if (is_open[i] || std::any_of(boxes.begin(), boxes.end(), may_hide)) continue;
      if (!SelfIntersects(pieces[i])) continue;
      if (MeasureTopology(pieces[i]).volume_m3 < 0)
        pieces[i] = TurnedInsideOut(std::move(pieces[i]));
      tangled.push_back(&pieces[i]);
    }
    Untangling untangling = WithoutOwnCrossings({tangled.begin(), tangled.end()}, Limits(), pairs_);
    if (untangling.pieces.size() < tangled.size()) {
      report_.reason = std::move(untangling.problem);
      return false;
    }
    for (std::size_t i = 0; i < tangled.size(); ++i) *tangled[i] = std::move(untangling.pieces[i]);
    untangled_ += static_cast<int>(tangled.size());
    return true;
  }

  // Makes walls of the pieces that are still open and of the sheets. False, with a reason, where
  // one would cross itself.
  bool AddWalls(std::vector<TriangleMesh>& pieces, std::vector<TriangleMesh> sheets) {
    const double half_m = config_.offset_fraction * diagonal_m_;
    int thickened = 0;
    const auto thicken = [&](TriangleMesh& piece) {
      std::optional<TriangleMesh> wall = WallsOf(piece, half_m, pairs_);
      if (!wall) {
        report_.reason = "an open piece of " +
                         Count(static_cast<int>(piece.triangles.size()), "triangle") +
                         " makes no simple wall";
        return false;
      }
      piece = *std::move(wall);
      ++thickened;
      return true;
    };
    for (TriangleMesh& piece : pieces) {
      if (MeasureTopology(piece).boundary_edges > 0 && !thicken(piece)) return false;
    }
    for (TriangleMesh& sheet : sheets) {
      if (!thicken(sheet)) return false;
      pieces.push_back(std::move(sheet));
    }
    if (thickened > 0) {
      Did("made walls " + std::to_string(2000 * half_m) + " mm thick of " +
          Count(thickened, "open piece"));
      report_.outcome = RepairOutcome::kRepaired;
    }
    report_.sheets_thickened = thickened;
    return true;
  }

  void OrientOutwards(std::vector<TriangleMesh>& pieces) {
    for (TriangleMesh& piece : pieces) {
      if (MeasureTopology(piece).volume_m3 < 0) piece = TurnedInsideOut(std::move(piece));
    }
  }

  // In a mesh that was closed and oriented from the start, an inner piece that faces inwards is
  // meant as a cavity; anywhere else it is inside out.
  void OrientKeepingCavities(std::vector<TriangleMesh>& pieces) {
    int turned = 0;
    for (TriangleMesh& piece : pieces) {
      if (MeasureTopology(piece).volume_m3 > 0) continue;
      const bool inside = std::any_of(pieces.begin(), pieces.end(), [&](const TriangleMesh& other) {
        return &other != &piece && TriangleTree(other).WindingNumber(piece.vertices[0]) > 0.5;
      });
      if (inside) continue;
      piece = TurnedInsideOut(std::move(piece));
      ++turned;
    }
    if (turned > 0) Did("turned " + Count(turned, "piece") + " outwards");
  }

  // A piece that lies wholly inside another adds nothing to the union.
  void DropHidden(std::vector<TriangleMesh>& pieces) {
    std::vector<char> hidden(pieces.size(), 0);
    std::vector<Container> containers;
    for (const TriangleMesh& piece : pieces) {
      CheckWork(static_cast<unsigned>(20 * piece.triangles.size()));
      containers.push_back({&piece, BoxAround(piece), std::nullopt});
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = 0; j < pieces.size() && !hidden[i]; ++j)
        hidden[i] = i != j && !hidden[j] && LiesInside(containers[i], containers[j]);
    }
    containers.clear();
    std::size_t index = 0;
    const auto dropped = static_cast<int>(
        std::erase_if(pieces, [&](const TriangleMesh&) { return hidden[index++] != 0; }));
    if (dropped > 0) Did("dropped " + Count(dropped, "piece") + " hidden inside others");
    report_.components_dropped += dropped;
  }

  // Vertices that no triangle uses are left out.
  static Eigen::AlignedBox3d BoxAround(const TriangleMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (const int index : t) box.extend(mesh.vertices[static_cast<std::size_t>(index)]);
    }
    return box;
  }

  // A closed piece as others are looked for in it; the tree is made for the first.
  struct Container {
    const TriangleMesh* piece;
    Eigen::AlignedBox3d box;
    std::optional<TriangleTree> tree;

    const TriangleTree& Tree() {
      if (!tree) tree.emplace(*piece);
      return *tree;
    }
  };

  static bool LiesInside(const Container& inner, Container& other) {
    if (!other.box.contains(inner.box)) return false;
    const TriangleMesh& piece = *inner.piece;
    const TriangleTree& tree = other.Tree();
    const auto is_inside = [&](const Eigen::Vector3d& point) { return tree.IsInside(point); };
    constexpr int kProbes = 64;
    const std::size_t step = piece.vertices.size() / kProbes + 1;
    for (std::size_t i = 0; i < piece.vertices.size(); i += step) {
      if (!is_inside(piece.vertices[i])) return false;
    }
    const std::vector<Eigen::Vector3d> probes = SurfaceSamples(piece, kProbes);
    return std::all_of(probes.begin(), probes.end(), is_inside);
  }

  SeparationLimits Limits() const {
    return {.shift_m = kShiftFraction * diagonal_m_,
            .half_wall_m = config_.offset_fraction * diagonal_m_,
            .fill_cavities = report_.sheets_thickened > 0};
  }

  TriangleMesh WithoutCrossings(std::vector<TriangleMesh> pieces) {
    Separation separation = Separated(std::move(pieces), Limits(), pairs_);
    if (separation.solids.empty()) {
      report_.reason = separation.problem;
      return {};
    }
    const int untangled = untangled_ + separation.untangled;
    if (untangled > 0) Did("untangled " + Count(untangled, "piece") + " that crossed themselves");
    if (separation.united > 0) {
      Did("united pieces that met: " + Count(separation.united, "piece") + " fewer");
      report_.components_united = separation.united;
    }
    if (untangled + separation.united > 0) report_.outcome = RepairOutcome::kRepaired;
    return Merged(separation.solids);
  }

  TriangleMesh Wrapped() {
    const double alpha_m = config_.alpha_fraction * diagonal_m_;
    const double offset_m = config_.offset_fraction * diagonal_m_;
    TriangleMesh wrap = AlphaWrap(surface_, alpha_m, offset_m);
    Did("wrapped with alpha " + std::to_string(1000 * alpha_m) + " mm and offset " +
        std::to_string(1000 * offset_m) + " mm to " +
        Count(static_cast<int>(wrap.triangles.size()), "triangle"));
    report_.outcome = RepairOutcome::kWrapped;
    report_.components_dropped = 0;
    report_.components_united = 0;
    report_.sheets_thickened = 0;
    report_.components_kept = MeasureTopology(wrap).components;
    return wrap;
  }

  // A wrap is dense everywhere, so it is also thinned where that costs nothing; exact pieces stay
  // as they are within the budget.
  TriangleMesh WithinBudget(TriangleMesh mesh) {
    const auto count = static_cast<int>(mesh.triangles.size());
    const bool wrapped = report_.outcome == RepairOutcome::kWrapped;
    if (config_.max_triangles == 0 || (count <= config_.max_triangles && !wrapped)) return mesh;
    const int target = std::min(config_.max_triangles, BudgetOfInput());
    const double free_error_m =
        wrapped ? kFreeErrorShare * config_.offset_fraction * diagonal_m_ : 0;
    TriangleMesh simple = Reduced(mesh, target, free_error_m);
    if (!IsSimple(simple))
      simple = ReducedWithoutCrossings(HalfWay(mesh, target), target, free_error_m);
    // where so few would cross, collapses go on elsewhere at any cost
    if (static_cast<int>(simple.triangles.size()) > target && target < BudgetOfInput())
      simple = ReducedWithoutCrossings(mesh, BudgetOfInput(), free_error_m);
    Did("simplified " + std::to_string(count) + " triangles to " +
        std::to_string(simple.triangles.size()));
    return simple;
  }

  static bool IsSimple(const TriangleMesh& mesh) {
    return ClosedMesh::From(mesh) && !SelfIntersects(mesh);
  }

  // Collapses that are not tried against what lies near take a fifth of the time of those that are,
  // and the first of many seldom make triangles cross.
  static TriangleMesh HalfWay(const TriangleMesh& mesh, int target) {
    constexpr double kMany = 2.5;  // times the target
    if (static_cast<double>(mesh.triangles.size()) < kMany * target) return mesh;
    TriangleMesh between = Reduced(mesh, 2 * target, 0);
    return IsSimple(between) ? between : mesh;
  }

  int BudgetOfInput() const {
    return static_cast<int>(kBudgetFactor * input_->triangles.size() + kBudget);
  }

  RepairResult Finished(TriangleMesh mesh) {
    std::optional<ClosedMesh> closed = ClosedMesh::From(std::move(mesh));
    if (!closed) return Failed("the result is not closed; please report this mesh");
    const TriangleMesh& output = closed->mesh();
    report_.after = MeasureTopology(output);
    report_.self_intersects = SelfIntersects(output);
    report_.output_to_input = DeviationOf(output, *input_, {.samples = 2000});
    report_.visible_input_to_output =
        DeviationOf(*input_, output, {.samples = 2000, .visible_only = true, .rays = 48});
    return {std::move(closed), report_};
  }

  const TriangleMesh* input_;
  RepairConfig config_;
  RepairReport report_;
  TriangleMesh soup_;     // the input, welded
  TriangleMesh surface_;  // the same, oriented and with small holes filled where that was tried
  double diagonal_m_ = 0;
  PairBudget pairs_;
  int untangled_ = 0;  // pieces, before others are looked at
};

}  // namespace

RepairResult RepairMesh(const TriangleMesh& mesh, const RepairConfig& config) {
  CheckConfig(config);
  return Repair(mesh, config).Run();
}

}  // namespace doorforge
