// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge {

/// What a simulated state can have that no real one has.
enum class DivergenceKind {
  kNotFinite,    ///< A position, a velocity or a command is not a number, or infinite.
  kTooFast,      ///< A joint is faster than it can become.
  kBeyondLimit,  ///< A joint is past the stop at the end of its range.
  kPenetration,  ///< Robot and door are inside each other.
  kTorque,       ///< A torque acts on a joint of the door that nothing there can give.
  kEnergyGain,   ///< There is more motion than drives, springs and pushes can have caused.
};
std::string_view NameOf(DivergenceKind kind);  ///< "not_finite", "too_fast", ...

/// What was found, where, and how much of it would have been plausible.
struct StateFault {
  DivergenceKind kind = DivergenceKind::kNotFinite;
  std::string where;   ///< A joint's name, or "robot and door".
  double found = 0;    ///< [rad/s, m/s, rad, m or J]; positive past the allowed value.
  double allowed = 0;  ///< In the same unit.
  double time_s = 0;   ///< Simulated time of the step after which it was found.
};

/// "energy_gain at 1.204 s: robot and door, found 31.2, allowed 5 J".
std::string Describe(const StateFault& fault);

struct WatchedJoint {
  std::string name;
  bool slides = false;
  double lower = 0;    ///< [rad or m]
  double upper = 0;    ///< Equal to lower for a joint that does not move.
  double fastest = 0;  ///< Speed that it never reaches [rad/s or m/s].
};

/// Where a plausible state ends; docs/design/simulation.md has what good episodes come to.
struct DivergenceLimits {
  double beyond_limit_rad = 0.5;
  double beyond_limit_m = 0.02;
  double penetration_m = 0.04;  ///< Deeper than where the world began.
  double energy_j = 4;
};

/// What a world knows of one step.
struct WatchedStep {
  std::vector<double> position;  ///< One number a joint [rad or m].
  std::vector<double> velocity;
  double deepest_m = 0;  ///< Deepest overlap of robot and door, >= 0.
  double kinetic_j = 0;  ///< All bodies together have it after the step.
  /// Most that drives, springs, latch and pushes can have added in the step [J].
  double work_j = 0;
  double time_s = 0;
};

/// Judges the steps of one world, in their order. A value: copies go on independently.
///
/// Contacts and stops take energy out of a scene or leave it as it is. So kinetic energy grows by
/// no more than the work of what drives; what it grows beyond that is added up, and counts down by
/// what the work left over. Where a scene begins with robot and door inside each other, being
/// pushed apart is not counted.
class DivergenceDetector {
 public:
  explicit DivergenceDetector(std::vector<WatchedJoint> joints,
                              const DivergenceLimits& limits = {});

  /// The first fault of a state by itself, if any: not finite, too fast, beyond a limit.
  std::optional<StateFault> CheckState(const WatchedStep& step) const;
  /// Checks the state after a step, its penetration and energy.
  ///
  /// @param step Has as many positions and velocities as there are joints.
  std::optional<StateFault> Check(const WatchedStep& step);

  const std::vector<WatchedJoint>& joints() const { return joints_; }
  /// Energy that nothing accounts for so far [J], >= 0.
  double surplus_j() const { return surplus_j_; }

 private:
  std::optional<StateFault> CheckJoint(std::size_t joint, const WatchedStep& step) const;

  std::vector<WatchedJoint> joints_;
  DivergenceLimits limits_;
  double kinetic_j_ = 0;
  double least_depth_m_ = 0;  // so far
  bool first_step_ = true;
  bool coming_out_ = false;  // of the overlap with which the scene began
  double surplus_j_ = 0;
};

}  // namespace doorforge
