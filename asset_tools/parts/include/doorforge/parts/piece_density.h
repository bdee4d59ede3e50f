// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "doorforge/schemas/names.h"

namespace doorforge::internal {

/// What a piece of unknown material weighs.
struct PieceDensity {
  double density_kg_m3;
  double min_mass_kg;
  double max_mass_kg;
};

/// Density of the filled outline, cavities included, and the range of masses that occur.
PieceDensity DensityOf(Category category, std::string_view piece);

}  // namespace doorforge::internal
