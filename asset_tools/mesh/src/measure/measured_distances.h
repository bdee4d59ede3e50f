// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "measure/distance_grid.h"
#include "measure/marked_cells.h"
#include "measure/triangle_tree.h"

namespace doorforge {

/// Distances to the surface of a solid, measured at the centres of a grid's cells when they are
/// first asked for, and between them linear along each axis. Above a plane that is the distance
/// itself; elsewhere it is off by half a cell's diagonal at most, near edges of the surface. For
/// one thread.
class MeasuredDistances {
 public:
  /// Both must outlive this, and be of the same solid.
  MeasuredDistances(const DistanceGrid& solid, const TriangleTree& surface);

  const DistanceGrid& solid() const { return *solid_; }
  double At(const Eigen::Vector3d& point);

  /// True where every point of the triangle with these corners is known to be no farther than
  /// `far_m` from the surface: the distance to one triangle of the surface is convex, so that it is
  /// largest at a corner. Asked is the one that is nearest to the middle.
  bool NoneBeyond(const std::array<Eigen::Vector3d, 3>& corners, double far_m);

  /// What was asked so far took about so many steps of ten nanoseconds. The same questions take the
  /// same.
  std::uint64_t steps() const { return steps_; }
  /// Counts what was looked at besides.
  void Took(std::uint64_t steps) { steps_ += steps; }

  /// How much more than the grid's distance to a cell that of a point in it may be.
  double MostBeyondGrid() const;
  /// The cells in air that may hold a point for which At() is more than `above_m`. Made anew only
  /// where that changes; valid until then.
  const MarkedCells& FarCells(double above_m);

 private:
  double AtCell(int i, int j, int k);
  void BeReady();
  /// What AtCell() is at most where the grid says `grid_m`, and what it is by the cells beside.
  double MostAtCell(double grid_m) const;
  double MostBeside(int i, int j, int k) const;

  const DistanceGrid* solid_;
  const TriangleTree* surface_;
  std::vector<float> distance_m_;  // negative where it was not asked for
  std::vector<int> nearest_;       // triangle of the surface where the distance was asked for
  std::optional<MarkedCells> far_;
  double far_above_m_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace doorforge
