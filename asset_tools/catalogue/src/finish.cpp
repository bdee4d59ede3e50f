// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "finish.h"

#include <span>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge::internal {
namespace {

// Leaves count as tubular core: 260 to 450 kg/m3 over the whole volume, so that a door weighs 10 to
// 25 kg. Metals and solid wood are those of common tables.
std::span<const Finish> Finishes() {
  static const Finish kFinishes[] = {
      {"white_lacquer", {0.93, 0.93, 0.90}, 260},
      {"cream_paint", {0.91, 0.86, 0.74}, 280},
      {"sage_paint", {0.56, 0.64, 0.52}, 300},
      {"navy_paint", {0.15, 0.22, 0.36}, 300},
      {"slate_paint", {0.34, 0.38, 0.41}, 300},
      {"brick_paint", {0.60, 0.25, 0.18}, 300},
      {"oak_veneer", {0.74, 0.56, 0.36}, 340},
      {"walnut_veneer", {0.38, 0.25, 0.17}, 360},
      {"beech_veneer", {0.83, 0.66, 0.47}, 340},
      {"pine", {0.86, 0.70, 0.45}, 430},
      {"cherry_wood", {0.58, 0.30, 0.18}, 450},
      {"chipboard_white", {0.90, 0.90, 0.88}, 620},
      {"brushed_steel", {0.62, 0.63, 0.65}, 7900},
      {"polished_chrome", {0.80, 0.82, 0.84}, 7200},
      {"polished_brass", {0.85, 0.67, 0.30}, 8500},
      {"antique_bronze", {0.36, 0.27, 0.19}, 8700},
      {"matt_black_zinc", {0.11, 0.11, 0.12}, 6600},
      {"satin_aluminium", {0.73, 0.74, 0.75}, 2700},
      {"copper", {0.76, 0.44, 0.30}, 8900},
      {"white_porcelain", {0.95, 0.94, 0.91}, 2400},
      {"beech_wood", {0.80, 0.60, 0.38}, 720},
      // furniture boards and solid wood through and through
      {"solid_oak", {0.70, 0.53, 0.34}, 710},
      {"solid_walnut", {0.36, 0.24, 0.16}, 660},
      {"solid_cherry", {0.58, 0.31, 0.19}, 660},
      {"solid_ash", {0.84, 0.74, 0.58}, 690},
      {"mdf_white", {0.92, 0.92, 0.90}, 750},
      {"mdf_cream", {0.90, 0.85, 0.72}, 750},
      {"mdf_sage", {0.55, 0.63, 0.51}, 750},
      {"mdf_navy", {0.16, 0.23, 0.37}, 750},
      {"mdf_slate", {0.33, 0.37, 0.40}, 750},
      {"mdf_rust", {0.60, 0.29, 0.20}, 750},
      {"mdf_teal", {0.16, 0.42, 0.43}, 750},
      {"mdf_mustard", {0.80, 0.62, 0.22}, 750},
      // two skins of sheet steel with a core, over the whole volume
      {"sheet_grey", {0.60, 0.62, 0.63}, 860},
      {"sheet_green", {0.24, 0.38, 0.30}, 860},
      {"sheet_black", {0.13, 0.13, 0.14}, 860},
      {"sheet_blue", {0.22, 0.34, 0.50}, 860},
      {"sheet_white", {0.92, 0.93, 0.93}, 860},
      {"sheet_red", {0.62, 0.12, 0.10}, 860},
      {"sheet_mint", {0.66, 0.82, 0.76}, 860},
      {"sheet_ivory", {0.88, 0.85, 0.74}, 860},
      // hollow window profiles, and a car's doors with all that is in them, over the whole volume
      {"profile_white", {0.94, 0.94, 0.93}, 520},
      {"profile_anthracite", {0.24, 0.26, 0.28}, 620},
      {"profile_bronze", {0.33, 0.25, 0.18}, 620},
      {"profile_green", {0.17, 0.30, 0.24}, 560},
      {"paint_silver", {0.72, 0.74, 0.76}, 480},
      {"paint_red", {0.66, 0.10, 0.10}, 480},
      {"paint_blue", {0.12, 0.26, 0.52}, 480},
      {"paint_white", {0.92, 0.93, 0.93}, 480},
      {"paint_black", {0.09, 0.09, 0.10}, 480},
      {"paint_yellow", {0.90, 0.72, 0.14}, 480},
      {"paint_green", {0.13, 0.34, 0.22}, 480},
      {"paint_orange", {0.86, 0.40, 0.10}, 480},
      {"paint_sand", {0.74, 0.67, 0.54}, 480},
      {"black_plastic", {0.10, 0.10, 0.11}, 1150},
  };
  return kFinishes;
}

}  // namespace

const Finish& FinishNamed(const std::string& name, const std::string& path) {
  std::vector<std::string> names;
  for (const Finish& finish : Finishes()) {
    if (finish.name == name) return finish;
    names.emplace_back(finish.name);
  }
  throw Error(ErrorCode::kInvalidConfig, path + ": unknown finish \"" + name +
                                             "\"; did you mean \"" + NearestName(name, names) +
                                             "\"?");
}

}  // namespace doorforge::internal
