// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/named_enum.h"
#include "doorforge/mesh/surface_deviation.h"

namespace doorforge {

/// When a mesh is replaced by an alpha wrap around it.
enum class WrapUse {
  kNever,   ///< What cannot be repaired exactly fails.
  kAuto,    ///< Only what cannot be repaired exactly, or not well, is wrapped.
  kAlways,  ///< Every mesh is wrapped.
};
inline constexpr NamedValue<WrapUse> kWrapUses[] = {
    {WrapUse::kNever, "never"}, {WrapUse::kAuto, "auto"}, {WrapUse::kAlways, "always"}};
constexpr std::span<const NamedValue<WrapUse>> ValuesOf(WrapUse) { return kWrapUses; }

/// D is the diagonal of the input's bounding box.
struct RepairConfig {
  WrapUse wrap = WrapUse::kAuto;
  double alpha_fraction = 0.01;         ///< The wrap enters openings wider than this times D.
  double offset_fraction = 1.0 / 1200;  ///< The wrap lies this times D outside the input.
  double max_hole_fraction = 0.05;      ///< Holes up to this times D across are filled.
  double max_flat_hole_share = 0.15;  ///< So are flat holes up to this part of their piece's area.
  /// But only where the cap stays within this times D of the surface; a piece with another hole
  /// becomes walls. 1: caps may lie anywhere, so hollow models become solid.
  double max_cap_fraction = 0.01;
  /// The output has at most so many, a wrap never more than three times the input's and 5,000. More
  /// are kept where fewer would cross. 0: any number.
  int max_triangles = 6000;
  /// A mesh in whose unions, all of them together, more pairs of triangles meet is wrapped; of
  /// pieces, eight pairs that only touch count as one, and an eighth more is kept for small unions
  /// at the end. A union that crosses itself is drawn again, but for two draws no oftener than all
  /// its draws together have two thirds as many pairs, and twice as many pairs and triangles. Each
  /// pair and draw takes about 0.1 ms; more of them keep nearer to the surface.
  int max_pairs = 100'000;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("wrap", self.wrap);
    visit("alpha_fraction", self.alpha_fraction);
    visit("offset_fraction", self.offset_fraction);
    visit("max_hole_fraction", self.max_hole_fraction);
    visit("max_flat_hole_share", self.max_flat_hole_share);
    visit("max_cap_fraction", self.max_cap_fraction);
    visit("max_triangles", self.max_triangles);
    visit("max_pairs", self.max_pairs);
  }
};

enum class RepairOutcome {
  kAlreadyClosed,  ///< The input was closed; vertices may have been welded.
  kRepaired,       ///< Closed by exact steps: the surface is the input's but for filled holes and
                   ///< the walls that stand for open sheets.
  kWrapped,        ///< Replaced by an alpha wrap around it.
  kFailed,         ///< No closed mesh; `reason` says why.
};

/// "already_closed", "repaired", "wrapped" or "failed".
std::string_view NameOf(RepairOutcome outcome);

struct RepairReport {
  RepairOutcome outcome = RepairOutcome::kFailed;
  std::string reason;  ///< Why the input could not be kept exactly, or why nothing came out.
  std::vector<std::string> steps;  ///< What was done, in order, with counts.
  MeshTopology before;  ///< It describes the input after vertices at one place were welded.
  MeshTopology after;   ///< It describes the output; zeros if there is none.
  int holes_filled = 0;
  int components_kept = 0;
  int components_dropped = 0;    ///< Pieces without thickness or hidden wholly inside others.
  int sheets_thickened = 0;      ///< Open pieces that became thin walls.
  int components_united = 0;     ///< Pieces that met others and were made one with them.
  bool self_intersects = false;  ///< Two triangles of the output cross or touch.
  SurfaceDeviation output_to_input;
  /// From the points of the input that a ray from outside can reach: what lies hidden inside, a
  /// wrap rightly leaves out.
  SurfaceDeviation visible_input_to_output;
};

struct RepairResult {
  std::optional<ClosedMesh> mesh;  ///< Empty exactly if the outcome is kFailed.
  RepairReport report;
};

/// Makes a closed mesh of triangles in any state; see docs/design/mesh.md for the steps.
///
/// Exact first: duplicate and degenerate triangles dropped, pieces oriented and stitched, small
/// holes filled, pieces that stay open made walls of twice the offset, pieces that meet united.
/// Where that leaves triangles that cross, an alpha wrap (Portaneri et al., "Alpha wrapping with an
/// offset", SIGGRAPH 2022), which thickens thin sheets by twice its offset. More than
/// `max_triangles` are reduced by edge collapse (Garland and Heckbert, 1997), which keeps the mesh
/// closed. Deterministic: the same input gives the same output on every machine of one
/// architecture, whatever the number of threads.
///
/// @throws Error(kInvalidArgument) as MeasureTopology() does; Error(kInvalidConfig) on a config
///     value out of range, (kFormat) as CheckWork() does. A mesh that cannot be closed is no Error.
RepairResult RepairMesh(const TriangleMesh& mesh, const RepairConfig& config);

/// The report as a record of schema "doorforge.repair_report", version 1.
nlohmann::ordered_json ToJson(const RepairReport& report);

/// Throws Error(kFormat) on anything that ToJson() would not write; `path` names the record.
RepairReport RepairReportFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge
