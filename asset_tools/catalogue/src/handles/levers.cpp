// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "handles/lever_base.h"

namespace doorforge::internal {
namespace {

struct CurvedLever : Lever {
  double bow_m = 0.006;  ///< Outward bulge of the bar's middle; negative bends towards the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("bow_m", self.bow_m);
  }
};

struct WaveLever : Lever {
  double wave_m = 0.008;  ///< Height of the wave in the plane of the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("wave_m", self.wave_m);
  }
};

struct DroopedLever : Lever {
  double droop_m = 0.012;  ///< The tip lies so far below the axis; negative rises.
  double bow_m = 0.004;    ///< Outward bulge of the bar's middle.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("droop_m", self.droop_m);
    visit("bow_m", self.bow_m);
  }
};

struct ReturnedLever : Lever {
  double end_gap_m = 0.014;  ///< Between the returned end and the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("end_gap_m", self.end_gap_m);
  }
};

Part BuildStraight(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<Lever>(json, path);
  CheckLever(lever, path);
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, nullptr); });
}

Part BuildCurved(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<CurvedLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "bow_m", lever.bow_m, -0.012, 0.016);
  const BarShape bow = [&](double t) {
    return Eigen::Vector2d(
        lever.bow_m * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * t)) - 0.25 * lever.bow_m * t * t,
        0);
  };
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, bow); });
}

Part BuildWave(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<WaveLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "wave_m", lever.wave_m, 0.002, 0.014);
  const BarShape wave = [&](double t) {
    return Eigen::Vector2d(0, 1.3 * lever.wave_m * t * std::sin(2 * std::numbers::pi * t));
  };
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, wave); });
}

Part BuildDrooped(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<DroopedLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "droop_m", lever.droop_m, -0.02, 0.03);
  RequireRange(path, "bow_m", lever.bow_m, -0.008, 0.012);
  const BarShape droop = [&](double t) {
    return Eigen::Vector2d(lever.bow_m * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * t)),
                           -lever.droop_m * t * t);
  };
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, droop); });
}

Part BuildReturned(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<ReturnedLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "end_gap_m", lever.end_gap_m, 0.008, 0.03);
  const double dome = std::min(lever.bar_depth_m, lever.bar_height_m) * 0.35;
  const double end_y = -(lever.length_m - lever.bar_depth_m / 2);
  return LeverPart(lever, path, [&](double start_x) {
    return FilletedPath({{start_x, 0, 0},
                         {lever.projection_m, 0, 0},
                         {lever.projection_m, end_y, 0},
                         {lever.end_gap_m + dome, end_y, 0}},
                        lever.bend_radius_m);
  });
}

}  // namespace

std::span<const Family> LeverFamilies() {
  static const Family kFamilies[] = {
      {"lever_straight", PartRole::kHandle, Mechanism::kLever, BuildStraight},
      {"lever_curved", PartRole::kHandle, Mechanism::kLever, BuildCurved},
      {"lever_wave", PartRole::kHandle, Mechanism::kLever, BuildWave},
      {"lever_returned", PartRole::kHandle, Mechanism::kLever, BuildReturned},
      {"lever_drooped", PartRole::kHandle, Mechanism::kLever, BuildDrooped},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
