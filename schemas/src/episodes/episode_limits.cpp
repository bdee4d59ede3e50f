// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode_limits.h"

#include <string_view>
#include <type_traits>

#include "doorforge/core/config_io.h"

namespace doorforge {
namespace {

// A speed of zero never arrives; a minute is longer than any motion of an arm at a door.
struct Range {
  double low;
  double high;
};

Range RangeOf(std::string_view field) {
  if (field == "open_angle_rad") return {0.01, std::numbers::pi};
  if (field == "grip_needed") return {0, 1};
  if (field == "reach_speed_fraction") return {0.01, 1};
  if (field == "farthest_move_m") return {0.01, 1000};
  if (field == "blocking_force_n") return {0, 1e6};
  if (field.ends_with("_actions")) return {1, 1e6};
  if (field.ends_with("_time_s")) return {0.01, 60};
  if (field.ends_with("_m_s") || field.ends_with("_rad_s")) return {0.001, 100};
  return {0, 10};
}

}  // namespace

void CheckEpisodeLimits(const EpisodeLimits& limits, const std::string& path) {
  EpisodeLimits::VisitFields(limits, [&](const char* field, const auto& value) {
    const Range range = RangeOf(field);
    RequireRange(path, field, static_cast<double>(value), range.low, range.high);
  });
}

}  // namespace doorforge
