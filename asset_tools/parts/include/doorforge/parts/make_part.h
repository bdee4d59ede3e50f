// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/mesh/convex_parts.h"
#include "doorforge/mesh/repair_mesh.h"
#include "doorforge/schemas/part.h"

namespace doorforge {

struct MakePartConfig {
  /// Hollow leaves become solid; what would take many unions is wrapped.
  RepairConfig repair = {.max_cap_fraction = 1, .max_pairs = 24'000};
  /// A grid sees depths to within a third of the bound: this keeps nearly all within a centimetre.
  /// Where more parts than these would have to stand for a mesh, the search ends early.
  ConvexPartsConfig frame_convex{
      .max_parts = 32, .max_concavity_m = 0.009, .max_protrusion_m = 0.01, .max_search = 80};
  ConvexPartsConfig leaf_convex{
      .max_parts = 32, .max_concavity_m = 0.009, .max_protrusion_m = 0.01, .max_search = 80};
  /// Finer: what the fingers grasp must not be thicker in collisions than in the picture.
  ConvexPartsConfig handle_convex{
      .max_parts = 32, .max_concavity_m = 0.002, .max_protrusion_m = 0.003};
  int threads = 0;  ///< 0: all processors. Does not change the result.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("repair", self.repair);
    visit("frame_convex", self.frame_convex);
    visit("leaf_convex", self.leaf_convex);
    visit("handle_convex", self.handle_convex);
    visit("threads", self.threads);
  }
};

/// A piece in any state, in the part's frame.
struct RawPiece {
  std::string name;  ///< It is a PartPiece::name.
  TriangleMesh mesh;
  Eigen::Vector4d color_rgba{0.7, 0.7, 0.7, 1.0};
  VisualMesh visual = {};               ///< What its author drew; may be empty.
  std::vector<std::string> notes = {};  ///< What of its materials was left out.
  /// What its source says that it weighs, in the part's frame; nothing: its volume tells.
  std::optional<MassProperties> stated_mass = {};
  /// A mesh that is closed stays as it is, even where its components meet, and is not repaired.
  bool keep_closed = false;
};

/// All that is known of a part before its pieces are repaired.
struct PartDraft {
  Part facts;  ///< Without pieces.
  std::vector<RawPiece> pieces;
};

struct PieceReport {
  std::string piece;
  RepairReport repair;
  int convex_parts = 0;
  ConvexPartsFit convex_fit;  ///< Measured, not the bound that was asked for.
  bool mass_limited = false;  ///< The volume times the density lay outside the plausible range.
  bool mass_stated = false;   ///< The mass is the source's: RawPiece::stated_mass.
  int visual_triangles = 0;   ///< They count what its author drew, where the part keeps it.
  int visual_materials = 0;
  int visual_textures = 0;
  std::vector<std::string> visual_notes = {};  ///< RawPiece::notes.
};

struct MadePart {
  std::optional<Part> part;         ///< Empty exactly if a piece could not be closed.
  std::vector<PieceReport> pieces;  ///< One a piece of the draft, in order.
};

/// Closes every piece, finds its convex parts and its mass.
///
/// Coordinates are rounded to float, as the canonical files hold them, so a part that is written
/// and read back equals the part in memory. What authors drew is kept as it is, unless it is the
/// closed mesh in one colour; collision, mass and volume follow from the closed mesh. A mass that
/// the source states is kept as it is. Else the density follows from category and piece (see
/// docs/design/door.md); masses are kept between limits that a robot can move. Deterministic for
/// any number of threads.
///
/// @throws Error(kInvalidArgument) if the draft has no leaf (body) or no grip (handle), or a piece
///     name that its role does not have; (kInvalidConfig) from the config; (kFormat) out of reach.
MadePart MakePart(const PartDraft& draft, const MakePartConfig& config);

/// Why a part could not be made: "leaf: <reason of its repair>; ..."; empty if it was.
std::string ProblemOf(const MadePart& made);

/// A record of schema "doorforge.part_report", version 1: one repair report a piece.
nlohmann::ordered_json ToJson(const MadePart& made);

}  // namespace doorforge
