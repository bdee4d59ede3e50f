// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/divergence_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace doorforge {
namespace {

constexpr double kTouching = 0.005;  // [m] of overlap that contacts in use come to
constexpr const char* kEverything = "robot and door";

std::string_view UnitOf(const StateFault& fault) {
  switch (fault.kind) {
    case DivergenceKind::kPenetration:
      return " m";
    case DivergenceKind::kTorque:
      return " N m";
    case DivergenceKind::kEnergyGain:
      return " J";
    default:
      return "";
  }
}

}  // namespace

std::string_view NameOf(DivergenceKind kind) {
  switch (kind) {
    case DivergenceKind::kNotFinite:
      return "not_finite";
    case DivergenceKind::kTooFast:
      return "too_fast";
    case DivergenceKind::kBeyondLimit:
      return "beyond_limit";
    case DivergenceKind::kPenetration:
      return "penetration";
    case DivergenceKind::kTorque:
      return "torque";
    case DivergenceKind::kEnergyGain:
      return "energy_gain";
  }
  return "unknown";
}

std::string Describe(const StateFault& fault) {
  char text[200];
  if (fault.kind == DivergenceKind::kNotFinite) {
    std::snprintf(text, sizeof text, "not_finite at %.3f s: %s", fault.time_s, fault.where.c_str());
    return text;
  }
  std::snprintf(text, sizeof text, "%s at %.3f s: %s, found %.3g, allowed %.3g%s",
                std::string(NameOf(fault.kind)).c_str(), fault.time_s, fault.where.c_str(),
                fault.found, fault.allowed, std::string(UnitOf(fault)).c_str());
  return text;
}

DivergenceDetector::DivergenceDetector(std::vector<WatchedJoint> joints,
                                       const DivergenceLimits& limits)
    : joints_(std::move(joints)), limits_(limits) {}

std::optional<StateFault> DivergenceDetector::CheckJoint(std::size_t index,
                                                         const WatchedStep& step) const {
  const WatchedJoint& joint = joints_[index];
  const double position = step.position[index];
  const double speed = std::abs(step.velocity[index]);
  if (!std::isfinite(position) || !std::isfinite(speed))
    return StateFault{DivergenceKind::kNotFinite, joint.name, position, 0, step.time_s};
  if (speed > joint.fastest)
    return StateFault{DivergenceKind::kTooFast, joint.name, speed, joint.fastest, step.time_s};
  const double beyond = std::max(joint.lower - position, position - joint.upper);
  const double allowed = joint.slides ? limits_.beyond_limit_m : limits_.beyond_limit_rad;
  if (beyond > allowed)
    return StateFault{DivergenceKind::kBeyondLimit, joint.name, beyond, allowed, step.time_s};
  return std::nullopt;
}

std::optional<StateFault> DivergenceDetector::CheckState(const WatchedStep& step) const {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (auto fault = CheckJoint(i, step)) return fault;
  }
  return std::nullopt;
}

std::optional<StateFault> DivergenceDetector::Check(const WatchedStep& step) {
  if (auto fault = CheckState(step)) return fault;
  if (!std::isfinite(step.kinetic_j) || !std::isfinite(step.work_j))
    return StateFault{DivergenceKind::kNotFinite, kEverything, step.kinetic_j, 0, step.time_s};
  // a scene may begin with the arm in a bulging body, and comes out of it by itself
  least_depth_m_ = first_step_ ? step.deepest_m : std::min(least_depth_m_, step.deepest_m);
  coming_out_ = (first_step_ || coming_out_) && step.deepest_m > kTouching;
  first_step_ = false;
  const double deepest = least_depth_m_ + limits_.penetration_m;
  if (step.deepest_m > deepest)
    return StateFault{DivergenceKind::kPenetration, kEverything, step.deepest_m, deepest,
                      step.time_s};
  if (!coming_out_)
    surplus_j_ = std::max(0.0, surplus_j_ + (step.kinetic_j - kinetic_j_) - step.work_j);
  kinetic_j_ = step.kinetic_j;
  if (surplus_j_ > limits_.energy_j)
    return StateFault{DivergenceKind::kEnergyGain, kEverything, surplus_j_, limits_.energy_j,
                      step.time_s};
  return std::nullopt;
}

}  // namespace doorforge
