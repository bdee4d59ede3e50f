// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// How many pairs of triangles that meet may be united in the repair of one mesh, all its unions
/// together: each takes about a tenth of a millisecond. Of pieces that are no walls, eight pairs
/// that only touch, as of boards drawn flush, count as one. An eighth more is kept for small unions
/// that come when most is spent, so that costly ones are not made in vain.
class PairBudget {
 public:
  explicit PairBudget(std::size_t allowed)
      : allowed_(allowed), left_(allowed), rest_(allowed / 8) {}

  std::size_t allowed() const { return allowed_; }
  std::size_t left() const { return left_; }

  /// How many pairs all draws of one union together may have: two thirds of those allowed, so that
  /// more are kept for other unions than for one that fails again and again.
  std::size_t in_all_draws() const { return allowed_ * 2 / 3; }

  /// False, and nothing is taken, where no so many are left.
  bool Take(std::size_t pairs) {
    std::size_t& source = pairs > left_ ? rest_ : left_;
    if (pairs > source) return false;
    source -= pairs;
    return true;
  }

 private:
  std::size_t allowed_;
  std::size_t left_;
  std::size_t rest_;
};

/// Too narrow for a wall of twice `half_m`: its long sides lie in its neighbours, and a wall of it
/// would be all sliver.
bool IsNeedle(const TriangleMesh& patch, double half_m);

/// The solid that stands for an open sheet: walls of twice `half_m`, or thinner where the sheet
/// folds tightly; free of crossings. A sheet that cannot be thickened as a whole is the union of
/// the walls of its patches; voids that these close in are filled, as they are for any surface that
/// crosses itself. Nothing where that takes too many walls, or more pairs than are left, or they
/// have no simple union.
std::optional<TriangleMesh> WallsOf(const TriangleMesh& surface, double half_m, PairBudget& pairs);

struct Separation {
  std::vector<TriangleMesh> solids;  ///< None meets another or itself; empty if that failed.
  int untangled = 0;                 ///< Pieces that crossed themselves.
  int united = 0;                    ///< Pieces that met others.
  std::string problem;               ///< Why it failed.
};

struct SeparationLimits {
  double shift_m = 0;      ///< How far surfaces may move so that nothing touches.
  double half_wall_m = 0;  ///< Half the thickness of walls that stand for tangled pieces; 0: the
                           ///< pieces are such walls, and none stand for what they tangle.
  bool fill_cavities = false;  ///< Whether voids that arise where pieces are united are filled.
};

/// Solids without crossings from closed pieces, which face outwards or, as cavities, inwards:
/// pieces that touch themselves are shrunk or grown a little, those that cross themselves become
/// the union of walls along them, filled; pieces that meet are united.
Separation Separated(std::vector<TriangleMesh> pieces, const SeparationLimits& limits,
                     PairBudget& pairs);

/// What Separated() puts in the places of closed pieces that cross themselves, in their order.
/// Fewer where it fails for the next of them, of which it says why in `problem`: before any is
/// united, where walls of them all would have more pairs than are left.
struct Untangling {
  std::vector<TriangleMesh> pieces;
  std::string problem;
};
Untangling WithoutOwnCrossings(const std::vector<const TriangleMesh*>& pieces,
                               const SeparationLimits& limits, PairBudget& pairs);

}  // namespace doorforge
