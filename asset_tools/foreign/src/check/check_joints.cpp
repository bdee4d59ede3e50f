// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "doorforge/foreign/foreign_rules.h"

#include "check/checks.h"

namespace doorforge::foreign {
namespace {

bool Turns(const ForeignJoint& joint) {
  return joint.type == ForeignJointType::kRevolute || joint.type == ForeignJointType::kContinuous;
}
bool HasRange(const ForeignJoint& joint) {
  return joint.type == ForeignJointType::kRevolute || joint.type == ForeignJointType::kPrismatic;
}
bool HasAxis(const ForeignJoint& joint) {
  return Turns(joint) || joint.type == ForeignJointType::kPrismatic;
}

void CheckAxis(const ForeignJoint& joint, const FormatTraits& traits, FaultList& faults) {
  if (!HasAxis(joint) || !joint.axis) return;
  const double length = joint.axis->norm();
  if (length <= AnyRule("JNT001").limit)
    faults.Add("JNT001", joint.axis_place, Measured(length, ""));
  else if (traits.unit_axes && std::abs(length - 1) > AnyRule("JNT002").limit)
    faults.Add("JNT002", joint.axis_place, Measured(length, ""));
}

void CheckRange(const ForeignJoint& joint, const ForeignLimit& limit, FaultList& faults) {
  if (!limit.lower || !limit.upper) return;
  const bool turns = joint.type == ForeignJointType::kRevolute;
  const std::string unit = turns ? "rad" : "m";
  const std::string range = Digits(*limit.lower) + " to " + Digits(*limit.upper) + " " + unit;
  if (*limit.lower > *limit.upper) return faults.Add("JNT004", limit.place, range);
  if (*limit.lower == *limit.upper && !joint.mimic)
    faults.Add("JNT005", limit.place, Measured(*limit.upper, unit));
  const double most = std::max(std::abs(*limit.lower), std::abs(*limit.upper));
  const char* code = turns ? "JNT009" : "JNT010";
  // some write numbers beyond all use where there is no limit
  constexpr double kNoLimit = 1e5;
  if (most > AnyRule(code).limit && most < kNoLimit)
    faults.Add(code, limit.place, Measured(most, unit));
}

void CheckDrive(const ForeignLimit& limit, bool moves, FaultList& faults) {
  const auto check = [&](const std::optional<double>& number, const std::string& name) {
    if (!number) return;
    if (*number < 0)
      faults.Add("JNT007", limit.place, name + " " + Digits(*number));
    else if (*number == 0 && moves)
      faults.Add("JNT008", limit.place, name + " 0");
  };
  check(limit.effort, "effort");
  check(limit.velocity, "velocity");
}

void CheckDynamics(const ForeignJoint& joint, FaultList& faults) {
  const auto check = [&](const std::optional<double>& number, const std::string& name) {
    if (number && *number < 0)
      faults.Add("JNT011", joint.dynamics_place, name + " " + Digits(*number));
  };
  check(joint.damping, "damping");
  check(joint.friction, "friction");
}

}  // namespace

void CheckJoints(const ArticulatedObject& object, FaultList& faults) {
  for (const ForeignJoint& joint : object.joints) {
    CheckAxis(joint, object.traits, faults);
    if (object.traits.needs_limits && HasRange(joint) && !joint.limit)
      faults.Add("JNT003", joint.place, "no <limit>");
    if (joint.limit && HasRange(joint)) CheckRange(joint, *joint.limit, faults);
    if (joint.limit) CheckDrive(*joint.limit, HasRange(joint), faults);
    CheckDynamics(joint, faults);
    const double away = joint.parent_from_joint.translation().norm();
    if (away > AnyRule("JNT012").limit) faults.Add("JNT012", joint.place, Measured(away, "m"));
  }
}

}  // namespace doorforge::foreign
