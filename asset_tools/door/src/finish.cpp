// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "finish.h"

#include <array>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge::internal {
namespace {

// Leaves count as tubular core: 260 to 450 kg/m3 over the whole volume, so that a door weighs 10 to
// 25 kg. Metals and solid wood are those of common tables.
const std::array<Finish, 21>& Finishes() {
  static const std::array<Finish, 21> kFinishes = {{
      {"white_lacquer", {0.93, 0.93, 0.90}, 260},    {"cream_paint", {0.91, 0.86, 0.74}, 280},
      {"sage_paint", {0.56, 0.64, 0.52}, 300},       {"navy_paint", {0.15, 0.22, 0.36}, 300},
      {"slate_paint", {0.34, 0.38, 0.41}, 300},      {"brick_paint", {0.60, 0.25, 0.18}, 300},
      {"oak_veneer", {0.74, 0.56, 0.36}, 340},       {"walnut_veneer", {0.38, 0.25, 0.17}, 360},
      {"beech_veneer", {0.83, 0.66, 0.47}, 340},     {"pine", {0.86, 0.70, 0.45}, 430},
      {"cherry_wood", {0.58, 0.30, 0.18}, 450},      {"chipboard_white", {0.90, 0.90, 0.88}, 620},
      {"brushed_steel", {0.62, 0.63, 0.65}, 7900},   {"polished_chrome", {0.80, 0.82, 0.84}, 7200},
      {"polished_brass", {0.85, 0.67, 0.30}, 8500},  {"antique_bronze", {0.36, 0.27, 0.19}, 8700},
      {"matt_black_zinc", {0.11, 0.11, 0.12}, 6600}, {"satin_aluminium", {0.73, 0.74, 0.75}, 2700},
      {"copper", {0.76, 0.44, 0.30}, 8900},          {"white_porcelain", {0.95, 0.94, 0.91}, 2400},
      {"beech_wood", {0.80, 0.60, 0.38}, 720},
  }};
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
