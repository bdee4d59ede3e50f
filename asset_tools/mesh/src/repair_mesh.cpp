// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/repair_mesh.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "doorforge/core/error.h"

#include "mesh_pieces.h"
#include "solid_rows.h"
#include "surface_operations.h"
#include "surface_samples.h"
#include "triangle_tree.h"

namespace doorforge {
namespace {

constexpr double kWeldFraction = 1e-6;  // of D: what exporters round away
constexpr double kFlatFraction = 1e-6;  // of D: thinner closed pieces have no inside to speak of
constexpr double kFlatHoleSize = 0.35;  // of D: larger flat holes are openings that someone meant
constexpr double kFlatHoleFraction = 1e-4;  // of D: how far a flat hole may leave its plane
constexpr double kFlatAreaShare = 0.01;  // of all area: less than this may be lost with flat pieces
constexpr double kFreeErrorShare = 0.25;  // of the offset: error of a wrap that costs nothing
constexpr int kVolumeRows = 40'000;       // rows of the grid that measures overlaps

void CheckConfig(const RepairConfig& config) {
  const auto require = [](bool holds, const char* message) {
    Require(holds, ErrorCode::kInvalidConfig, message);
  };
  require(config.wrap == "never" || config.wrap == "auto" || config.wrap == "always",
          "repair.wrap: expected never, auto or always");
  require(config.alpha_fraction >= 1e-4 && config.alpha_fraction <= 1,
          "repair.alpha_fraction: allowed 0.0001..1");
  require(config.offset_fraction >= 1e-5 && config.offset_fraction <= 1,
          "repair.offset_fraction: allowed 0.00001..1");
  require(config.max_hole_fraction >= 0 && config.max_hole_fraction <= 1,
          "repair.max_hole_fraction: allowed 0..1");
  require(config.max_flat_hole_share >= 0 && config.max_flat_hole_share <= 1,
          "repair.max_flat_hole_share: allowed 0..1");
  require(config.max_overlap_fraction >= 0 && config.max_overlap_fraction <= 1,
          "repair.max_overlap_fraction: allowed 0..1");
  require(config.max_triangles == 0 || config.max_triangles >= 100,
          "repair.max_triangles: allowed 0 (any number) or 100 and more");
}

std::string Count(int count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// One repair from input to report; the members are what the steps pass on.
class Repair {
 public:
  Repair(const TriangleMesh& input, const RepairConfig& config) : input_(&input), config_(config) {
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
      TriangleMesh mesh = config_.wrap == "always" ? TriangleMesh{} : KeptExactly();
      if (config_.wrap == "always") report_.reason = "a wrap was asked for";
      if (mesh.triangles.empty() && config_.wrap == "never") return Failed(report_.reason);
      if (mesh.triangles.empty()) mesh = Wrapped();
      return Finished(WithinBudget(std::move(mesh)));
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      return Failed(std::string("a step failed: ") + error.what());
    }
  }

 private:
  void Did(std::string step) { report_.steps.push_back(std::move(step)); }

  RepairResult Failed(std::string reason) {
    report_.outcome = RepairOutcome::kFailed;
    report_.reason = std::move(reason);
    return {std::nullopt, std::move(report_)};
  }

  // The union of the input's closed pieces; empty, with a reason, where it is none.
  TriangleMesh KeptExactly() {
    const bool is_closed =
        report_.before.non_manifold_vertices == 0 && ClosedMesh::From(soup_).has_value();
    report_.outcome = is_closed ? RepairOutcome::kAlreadyClosed : RepairOutcome::kRepaired;
    if (!is_closed) surface_ = Closed();
    std::vector<TriangleMesh> pieces = PiecesOf(surface_);
    if (!DropFlat(pieces)) return {};
    if (is_closed) {
      OrientKeepingCavities(pieces);
    } else {
      OrientOutwards(pieces);
      DropHidden(pieces);
    }
    TriangleMesh mesh = Joined(pieces);
    if (!OverlapIsSmall(mesh)) return {};
    report_.components_kept = static_cast<int>(pieces.size());
    return mesh;
  }

  TriangleMesh Closed() {
    ClosedSoup closed = CloseSoup(soup_, {.max_size_m = config_.max_hole_fraction * diagonal_m_,
                                          .max_flat_size_m = kFlatHoleSize * diagonal_m_,
                                          .max_flat_area_share = config_.max_flat_hole_share,
                                          .flatness_m = kFlatHoleFraction * diagonal_m_});
    if (closed.degenerate_triangles > 0)
      Did("dropped " + Count(closed.degenerate_triangles, "degenerate triangle"));
    if (closed.duplicate_triangles > 0)
      Did("dropped " + Count(closed.duplicate_triangles, "duplicate triangle"));
    Did("oriented and stitched the surface");
    if (closed.split_vertices > 0)
      Did("cut non-manifold places apart at " + Count(closed.split_vertices, "vertex copy"));
    if (closed.holes_filled > 0) Did("filled " + Count(closed.holes_filled, "hole"));
    report_.holes_filled = closed.holes_filled;
    return std::move(closed.mesh);
  }

  // Removes closed pieces without thickness. False, with a reason, if a piece is open or if the
  // pieces without thickness matter.
  bool DropFlat(std::vector<TriangleMesh>& pieces) {
    int open = 0;
    double flat_area = 0;
    const std::size_t before = pieces.size();
    std::erase_if(pieces, [&](const TriangleMesh& piece) {
      const MeshTopology topology = MeasureTopology(piece);
      open += topology.boundary_edges > 0;
      const double thickness_m = 2 * std::abs(topology.volume_m3) / topology.area_m2;
      const bool flat =
          topology.boundary_edges == 0 && !(thickness_m > kFlatFraction * diagonal_m_);
      if (flat) flat_area += topology.area_m2;
      return flat;
    });
    const int flat = static_cast<int>(before - pieces.size());
    if (open > 0) {
      report_.reason =
          Count(open, "piece") + " of " + std::to_string(before) + " could not be closed";
    } else if (pieces.empty() || flat_area > kFlatAreaShare * report_.before.area_m2) {
      report_.reason =
          Count(flat, "piece") + " of " + std::to_string(before) + " without thickness";
    } else {
      if (flat > 0) Did("dropped " + Count(flat, "piece") + " without thickness");
      report_.components_dropped += flat;
      return true;
    }
    return false;
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
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = 0; j < pieces.size() && !hidden[i]; ++j)
        hidden[i] = i != j && !hidden[j] && LiesInside(pieces[i], pieces[j]);
    }
    std::size_t index = 0;
    const auto dropped = static_cast<int>(
        std::erase_if(pieces, [&](const TriangleMesh&) { return hidden[index++] != 0; }));
    if (dropped > 0) Did("dropped " + Count(dropped, "piece") + " hidden inside others");
    report_.components_dropped += dropped;
  }

  static bool LiesInside(const TriangleMesh& piece, const TriangleMesh& other) {
    const Eigen::AlignedBox3d box = MeasureTopology(other).bounds;
    if (!box.contains(MeasureTopology(piece).bounds)) return false;
    const TriangleTree tree(other);
    const auto is_inside = [&](const Eigen::Vector3d& point) {
      return tree.WindingNumber(point) > 0.5;
    };
    constexpr int kProbes = 64;
    const std::size_t step = piece.vertices.size() / kProbes + 1;
    for (std::size_t i = 0; i < piece.vertices.size(); i += step) {
      if (!is_inside(piece.vertices[i])) return false;
    }
    const std::vector<Eigen::Vector3d> probes = SurfaceSamples(piece, kProbes);
    return std::all_of(probes.begin(), probes.end(), is_inside);
  }

  bool OverlapIsSmall(const TriangleMesh& mesh) {
    const double cell_m = CellFor(mesh, diagonal_m_ / 400, 0, kVolumeRows * 200);
    const SolidVolumes volumes = VolumesOf(mesh, GridOver(mesh, cell_m, 0));
    report_.overlap_fraction =
        volumes.sum_m3 > 0 ? std::max(0.0, 1 - volumes.union_m3 / volumes.sum_m3) : 0;
    if (report_.overlap_fraction <= config_.max_overlap_fraction) return true;
    report_.reason = "closed pieces share " +
                     std::to_string(std::lround(100 * report_.overlap_fraction)) +
                     " % of their volume";
    return false;
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
    report_.overlap_fraction = 0;
    report_.components_kept = MeasureTopology(wrap).components;
    return wrap;
  }

  // A wrap is dense everywhere, so it is also thinned where that costs nothing; exact pieces stay
  // as they are within the budget.
  TriangleMesh WithinBudget(TriangleMesh mesh) {
    const auto count = static_cast<int>(mesh.triangles.size());
    const bool wrapped = report_.outcome == RepairOutcome::kWrapped;
    if (config_.max_triangles == 0 || (count <= config_.max_triangles && !wrapped)) return mesh;
    const double free_error_m =
        wrapped ? kFreeErrorShare * config_.offset_fraction * diagonal_m_ : 0;
    TriangleMesh simple = Simplified(mesh, config_.max_triangles, free_error_m);
    if (!ClosedMesh::From(simple)) {
      Did("kept " + std::to_string(count) + " triangles: fewer would not be closed");
      return mesh;
    }
    Did("simplified " + std::to_string(count) + " triangles to " +
        std::to_string(simple.triangles.size()));
    return simple;
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
    return {std::move(closed), std::move(report_)};
  }

  const TriangleMesh* input_;
  RepairConfig config_;
  RepairReport report_;
  TriangleMesh soup_;     // the input, welded
  TriangleMesh surface_;  // the same, oriented and with small holes filled where that was tried
  double diagonal_m_ = 0;
};

}  // namespace

RepairResult RepairMesh(const TriangleMesh& mesh, const RepairConfig& config) {
  CheckConfig(config);
  return Repair(mesh, config).Run();
}

}  // namespace doorforge
