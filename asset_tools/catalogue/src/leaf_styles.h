// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/solids/prism.h"
#include "doorforge/solids/relief.h"

// Leaves that are more than a slab with mouldings. All fill x in [-thickness, 0] and leave a plain
// border of `border_m` on all sides, which a handle can sit on.

namespace doorforge::internal {

struct LeafShape {
  Rectangle outline;
  double thickness_m;
  double edge_radius_m;
  double border_m;
};

/// Slats tilted by 35 degrees in an opening, at most 24 of them.
Solid LouvredLeaf(const LeafShape& leaf, int slats);

/// Boards laid on a slab: frame, one rail between `panels` panels and a diagonal in each; `crossed`
/// adds the other diagonal, interrupted at the crossing.
Solid BracedLeaf(const LeafShape& leaf, int panels, bool crossed);

/// Two layers of diagonal bars in an opening, at most 12 of each.
Solid LatticedLeaf(const LeafShape& leaf, int bars, double bar_width_m);

/// A panel behind a frame whose upper rail is cut to an arch of `rise_m`; `open` leaves the panel
/// out.
Solid ArchedLeaf(const LeafShape& leaf, double rise_m, bool open);

/// Bulges out between its upright borders: the borders' front is x = 0, the middle's `bow_m`.
Solid BowedLeaf(const LeafShape& leaf, double bow_m);

/// Upright coves side by side between the borders.
Solid ReededLeaf(const LeafShape& leaf, int reeds);

}  // namespace doorforge::internal
