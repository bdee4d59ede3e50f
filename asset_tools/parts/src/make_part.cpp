// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/make_part.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/parts/piece_density.h"
#include "doorforge/schemas/vertex_reach.h"

namespace doorforge {
namespace {

struct MadePiece {
  std::optional<PartPiece> piece;
  PieceReport report;
};

const std::array<std::string_view, 2>& PieceNames(PartRole role) {
  static constexpr std::array<std::string_view, 2> kBody = {"leaf", "frame"};
  static constexpr std::array<std::string_view, 2> kHandle = {"grip", "rose"};
  return role == PartRole::kBody ? kBody : kHandle;
}

void CheckNames(const PartDraft& draft) {
  const auto& names = PieceNames(draft.facts.role);
  bool has_main = false;
  for (const RawPiece& piece : draft.pieces) {
    if (std::find(names.begin(), names.end(), piece.name) == names.end())
      throw Error(ErrorCode::kInvalidArgument, draft.facts.id + ": a " +
                                                   std::string(NameOf(draft.facts.role)) +
                                                   " has no piece \"" + piece.name + '"');
    has_main = has_main || piece.name == names[0];
  }
  if (!has_main)
    throw Error(ErrorCode::kInvalidArgument,
                draft.facts.id + ": the piece \"" + std::string(names[0]) + "\" is missing");
}

// The gates of a large garage have it; grids and searches cost by the extent.
constexpr double kLargestPieceM = 20;

// Whatever way a mesh came in, here it is in metres.
void CheckReach(const PartDraft& draft) {
  for (const RawPiece& piece : draft.pieces) {
    const std::string name = draft.facts.id + ": " + piece.name;
    RequireWithinReach(piece.mesh.vertices, name);
    RequireWithinReach(piece.visual.vertices, name + " as it is drawn");
    const double across = BoundsOf(piece.mesh).sizes().maxCoeff();
    if (!piece.mesh.vertices.empty() && across > kLargestPieceM)
      throw Error(ErrorCode::kFormat, name + ": " + std::to_string(across) +
                                          " m across, allowed are " +
                                          std::to_string(std::lround(kLargestPieceM)) +
                                          " m; a vertex is out of place, or the unit is another");
  }
}

const ConvexPartsConfig& ConvexConfigOf(const std::string& piece, const MakePartConfig& config) {
  if (piece == "frame") return config.frame_convex;
  return piece == "leaf" ? config.leaf_convex : config.handle_convex;
}

// keeps the shape of the inertia; nothing turns on a density that is a guess
bool LimitMass(const internal::PieceDensity& limits, MassProperties& mass) {
  const double limited = std::clamp(mass.mass_kg, limits.min_mass_kg, limits.max_mass_kg);
  if (limited == mass.mass_kg) return false;
  mass.inertia_kg_m2 *= limited / mass.mass_kg;
  mass.mass_kg = limited;
  return true;
}

// rounding can fold a sliver; then the mesh is repaired once more, at the rounded coordinates
std::optional<ClosedMesh> RoundedClosed(const ClosedMesh& mesh, const RepairConfig& config) {
  TriangleMesh rounded = RoundedToFloat(mesh.mesh());
  if (std::optional<ClosedMesh> closed = ClosedMesh::From(rounded)) return closed;
  return RepairMesh(rounded, config).mesh;
}

constexpr double kThinnestHull = 1e-4;  // [m] thinner ones are rounding, and no program takes them

// Rounding moves vertices across the flat faces of a hull; the hull of the rounded ones is convex.
// Nothing if the hull has no thickness.
std::optional<TriangleMesh> RoundedHull(const TriangleMesh& hull) {
  const MeshTopology before = MeasureTopology(hull);
  // a thin plate has twice its area as surface
  if (before.volume_m3 < kThinnestHull * before.area_m2 / 2) return std::nullopt;
  return ConvexHull(RoundedToFloat(hull).vertices);
}

std::vector<TriangleMesh> HullsOf(const ClosedMesh& mesh, const ConvexPartsConfig& config) {
  std::vector<TriangleMesh> hulls;
  for (const TriangleMesh& hull : ConvexParts(mesh, config)) {
    if (std::optional<TriangleMesh> rounded = RoundedHull(hull))
      hulls.push_back(std::move(*rounded));
  }
  return hulls;
}

MadePiece Failed(MadePiece made, const std::string& reason) {
  made.report.repair.outcome = RepairOutcome::kFailed;
  made.report.repair.reason = reason;
  return made;
}

// One colour on the triangles that the part has anyway.
bool ShowsNoMore(const VisualMesh& visual, const RepairReport& report, const TriangleMesh& closed) {
  return report.outcome == RepairOutcome::kAlreadyClosed && visual.surfaces.size() == 1 &&
         visual.surfaces[0].material.texture == nullptr &&
         visual.surfaces[0].triangles.size() == closed.triangles.size();
}

void KeepVisual(const RawPiece& raw, const TriangleMesh& closed, PieceReport& report,
                PartPiece& piece) {
  report.visual_notes = raw.notes;
  if (raw.visual.empty() || ShowsNoMore(raw.visual, report.repair, closed)) return;
  piece.visual = PlacedAsFiled(raw.visual, RigidTransform::Identity());
  for (const VisualSurface& surface : piece.visual.surfaces)
    report.visual_triangles += static_cast<int>(surface.triangles.size());
  report.visual_materials = static_cast<int>(piece.visual.surfaces.size());
  report.visual_textures = static_cast<int>(TexturesOf(piece.visual).size());
}

// A mesh that is to stay as it is and can, else the repaired one.
RepairResult ClosedOf(const RawPiece& raw, const RepairConfig& config) {
  if (raw.keep_closed) {
    if (std::optional<ClosedMesh> closed = ClosedMesh::From(RoundedToFloat(raw.mesh))) {
      RepairResult kept;
      kept.report.outcome = RepairOutcome::kAlreadyClosed;
      kept.report.before = kept.report.after = MeasureTopology(closed->mesh());
      kept.report.components_kept = kept.report.after.components;
      kept.mesh = std::move(closed);
      return kept;
    }
  }
  return RepairMesh(raw.mesh, config);
}

MadePiece MakePiece(const RawPiece& raw, Category category, const MakePartConfig& config) {
  MadePiece made;
  made.report.piece = raw.name;
  const RepairResult repaired = ClosedOf(raw, config.repair);
  made.report.repair = repaired.report;
  if (!repaired.mesh) return made;
  const std::optional<ClosedMesh> closed = RoundedClosed(*repaired.mesh, config.repair);
  if (!closed) return Failed(made, "no longer closed at the precision of mesh files");
  PartPiece piece;
  piece.name = raw.name;
  piece.mesh = closed->mesh();
  piece.color_rgba = raw.color_rgba;
  piece.hulls = HullsOf(*closed, ConvexConfigOf(raw.name, config));
  if (piece.hulls.empty()) return Failed(made, "thinner than a tenth of a millimetre");
  made.report.convex_parts = static_cast<int>(piece.hulls.size());
  made.report.convex_fit = MeasureConvexParts(*closed, piece.hulls);
  const internal::PieceDensity density = internal::DensityOf(category, raw.name);
  made.report.mass_stated = raw.stated_mass.has_value();
  piece.mass = raw.stated_mass.value_or(MassPropertiesOf(*closed, density.density_kg_m3));
  if (!raw.stated_mass) made.report.mass_limited = LimitMass(density, piece.mass);
  KeepVisual(raw, piece.mesh, made.report, piece);
  made.piece = std::move(piece);
  return made;
}

}  // namespace

MadePart MakePart(const PartDraft& draft, const MakePartConfig& config) {
  CheckNames(draft);
  CheckReach(draft);
  std::vector<MadePiece> pieces(draft.pieces.size());
  ParallelFor(pieces.size(), config.threads, [&](std::size_t i) {
    pieces[i] = MakePiece(draft.pieces[i], draft.facts.category, config);
  });
  MadePart made;
  Part part = draft.facts;
  bool complete = true;
  for (MadePiece& piece : pieces) {
    complete = complete && piece.piece.has_value();
    if (piece.piece) part.pieces.push_back(std::move(*piece.piece));
    made.pieces.push_back(std::move(piece.report));
  }
  if (complete) made.part = std::move(part);
  return made;
}

std::string ProblemOf(const MadePart& made) {
  std::string problem;
  for (const PieceReport& piece : made.pieces) {
    if (piece.repair.outcome != RepairOutcome::kFailed) continue;
    if (!problem.empty()) problem += "; ";
    problem += piece.piece + " could not be closed: " + piece.repair.reason;
  }
  return problem;
}

nlohmann::ordered_json ToJson(const MadePart& made) {
  nlohmann::ordered_json pieces = nlohmann::ordered_json::array();
  for (const PieceReport& piece : made.pieces) {
    pieces.push_back({{"piece", piece.piece},
                      {"repair", ToJson(piece.repair)},
                      {"convex_parts", piece.convex_parts},
                      {"convex_protrusion_m", piece.convex_fit.protrusion_m},
                      {"convex_uncovered_m", piece.convex_fit.uncovered_m},
                      {"mass_limited", piece.mass_limited},
                      {"mass_stated", piece.mass_stated},
                      {"visual",
                       {{"triangles", piece.visual_triangles},
                        {"materials", piece.visual_materials},
                        {"textures", piece.visual_textures},
                        {"notes", piece.visual_notes}}}});
  }
  return {{"schema", "doorforge.part_report"}, {"schema_version", 1}, {"pieces", pieces}};
}

}  // namespace doorforge
