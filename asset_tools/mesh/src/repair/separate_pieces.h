// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// The solid that stands for an open sheet: walls of twice `half_m`, or thinner where the sheet
/// folds tightly; free of crossings. A sheet that cannot be thickened as a whole is the union of
/// the walls of its patches; voids that these close in are filled, as they are for any surface that
/// crosses itself. Nothing where that takes too many walls, more than `max_pairs` of their
/// triangles meet, or they have no simple union.
std::optional<TriangleMesh> WallsOf(const TriangleMesh& surface, double half_m,
                                    std::size_t max_pairs);

struct Separation {
  std::vector<TriangleMesh> solids;  ///< None meets another or itself; empty if that failed.
  int untangled = 0;                 ///< Pieces that crossed themselves.
  int united = 0;                    ///< Pieces that met others.
  std::string problem;               ///< Why it failed.
};

struct SeparationLimits {
  double shift_m = 0;          ///< How far surfaces may move so that nothing touches.
  double half_wall_m = 0;      ///< Half the thickness of walls that stand for tangled pieces.
  bool fill_cavities = false;  ///< Whether voids that arise where pieces are united are filled.
  std::size_t max_pairs = 0;   ///< Pairs of triangles that may meet; more are not united.
};

/// Solids without crossings from closed pieces, which face outwards or, as cavities, inwards:
/// pieces that touch themselves are shrunk or grown a little, those that cross themselves become
/// the union of walls along them, filled; pieces that meet are united.
Separation Separated(std::vector<TriangleMesh> pieces, const SeparationLimits& limits);

/// What Separated() puts in the place of a closed piece that crosses itself, or nothing where it
/// fails for that.
std::optional<TriangleMesh> WithoutOwnCrossings(const TriangleMesh& piece,
                                                const SeparationLimits& limits);

}  // namespace doorforge
