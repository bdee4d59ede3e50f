// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "openable_check.h"

#include <cstdio>
#include <string>

#include "doorforge/physics/leaf_sweep.h"
#include "doorforge/physics/opening_trial.h"
#include "doorforge/rollout/grasp_plan.h"

namespace doorforge {
namespace {

std::string Number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

void AddOverlap(const char* code, const SweepOverlap& overlap, std::vector<Finding>& findings) {
  if (overlap.depth_m <= RuleLimit(code)) return;
  findings.push_back(
      FindingOf(code, "door.json: \"" + overlap.moving + "\" in \"" + overlap.fixed + "\"",
                Number(overlap.depth_m) + " m at hinge " + Number(overlap.hinge_rad) +
                    " rad, handle " + Number(overlap.handle_rad) + " rad"));
}

void AddTrial(const OpeningTrial& trial, std::vector<Finding>& findings) {
  const auto add = [&](const char* code, const char* where, const std::string& measured) {
    findings.push_back(FindingOf(code, std::string("door.json: ") + where, measured));
  };
  if (!trial.finite) return add("OPN006", "joints", "diverged");
  if (!trial.held) add("OPN001", "latch", Number(trial.given_rad) + " rad");
  if (!trial.unlocked)
    return add("OPN002", "latch", "handle at " + Number(trial.turned_rad) + " rad, locked");
  if (trial.latched && trial.returned_rad > RuleLimit("OPN003"))
    add("OPN003", "handle_joint", Number(trial.returned_rad) + " rad");
  if (trial.opened_rad <= RuleLimit("OPN004"))
    add("OPN004", "hinge",
        Number(trial.opened_rad) + " rad after " + Number(trial.opened_s) + " s");
}

}  // namespace

OpenableCheck::OpenableCheck() : robot_(std::make_shared<const RobotModel>(LoadMobileFranka())) {}

std::vector<Finding> OpenableCheck::operator()(const DoorAsset& door) const {
  std::vector<Finding> findings;
  AddTrial(TryOpening(door), findings);
  const LeafSweep sweep = SweepLeaf(door);
  AddOverlap("SWP001", sweep.opening, findings);
  AddOverlap("SWP002", sweep.closed, findings);
  const double cost = GraspCost(door, *robot_);
  if (cost > RuleLimit("OPN005"))
    findings.push_back(FindingOf("OPN005", "door.json: handle_from_grasp", Number(cost)));
  return findings;
}

}  // namespace doorforge
