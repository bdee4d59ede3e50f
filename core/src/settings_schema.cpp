// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/settings_schema.h"

#include <utility>

namespace doorforge {

std::string UnitOfName(std::string_view name) {
  const std::pair<std::string_view, const char*> units[] = {{"_nm_per_rad", "N m/rad"},
                                                            {"_rad", "rad"},
                                                            {"_m", "m"},
                                                            {"_nm", "N m"},
                                                            {"_n", "N"},
                                                            {"_s", "s"},
                                                            {"_px", "pixels"},
                                                            {"_bytes", "bytes"}};
  for (const auto& [ending, unit] : units)
    if (name.ends_with(ending)) return unit;
  return "";
}

}  // namespace doorforge
