// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/opening_trial.h"

#include <algorithm>
#include <cmath>

#include "doorforge/physics/robotless_door.h"

namespace doorforge {
namespace {

constexpr double kAjarRad = 0.01;  // as the latch law has it
constexpr double kRampS = 1;
constexpr double kHoldS = 0.5;    // at the full force
constexpr double kReturnS = 1;    // for the handle to spring back
constexpr double kOpeningS = 10;  // at most

// Radius of the grasp's circle about the hinge line.
double ArmOf(const DoorAsset& door) {
  const Eigen::Vector3d grasp =
      door.handle_joint.parent_from_child_at_zero * door.handle_from_grasp.translation();
  return (grasp - door.hinge.axis * door.hinge.axis.dot(grasp)).norm();
}

/// The hand of a trial: how hard it turns and pulls by now.
class Hand {
 public:
  Hand(const DoorAsset& door, const OpeningTrialConfig& config)
      : config_(config), arm_m_(ArmOf(door)) {}

  // It stops turning harder once the handle is done.
  double Turning(const RobotlessDoor& door) {
    if (!door.latch().handle_done) turning_ += config_.time_step_s / kRampS;
    return config_.handle_torque_nm * std::min(turning_, 1.0);
  }

  double Pulling(double times) {
    pulling_ += config_.time_step_s / kRampS;
    return times * config_.pull_n * arm_m_ * std::min(pulling_, 1.0);
  }

 private:
  const OpeningTrialConfig& config_;
  double arm_m_;
  double turning_ = 0;
  double pulling_ = 0;
};

int StepsOf(double seconds, const OpeningTrialConfig& config) {
  return static_cast<int>(std::lround(seconds / config.time_step_s));
}

void TryLocked(const DoorAsset& door, const OpeningTrialConfig& config, OpeningTrial& trial) {
  RobotlessDoor lone(door, config.time_step_s);
  Hand hand(door, config);
  for (int i = StepsOf(kRampS + kHoldS, config); i > 0 && lone.Finite(); --i) {
    lone.Step(hand.Pulling(config.overload), 0);
    trial.given_rad = std::max(trial.given_rad, lone.hinge_rad());
  }
  trial.held = lone.latch().locked && trial.given_rad < kAjarRad;
  trial.finite = trial.finite && lone.Finite();
}

void TryHandle(const DoorAsset& door, const OpeningTrialConfig& config, OpeningTrial& trial) {
  RobotlessDoor lone(door, config.time_step_s);
  Hand hand(door, config);
  for (int i = StepsOf(kRampS + kHoldS, config); i > 0 && lone.Finite(); --i) {
    lone.Step(0, hand.Turning(lone));
    trial.turned_rad = std::max(trial.turned_rad, lone.handle_rad());
    trial.unlocked = lone.latch().handle_done && !lone.latch().locked;
  }
  for (int i = StepsOf(kReturnS, config); i > 0 && lone.Finite(); --i) lone.Step(0, 0);
  trial.returned_rad = lone.handle_rad();
  trial.finite = trial.finite && lone.Finite();
}

void TryPull(const DoorAsset& door, const OpeningTrialConfig& config, OpeningTrial& trial) {
  RobotlessDoor lone(door, config.time_step_s);
  Hand hand(door, config);
  for (int i = StepsOf(kRampS + kHoldS, config);
       i > 0 && trial.latched && !lone.latch().handle_done && lone.Finite(); --i)
    lone.Step(0, hand.Turning(lone));
  for (int i = 1; i <= StepsOf(kOpeningS, config) && lone.Finite(); ++i) {
    lone.Step(hand.Pulling(1), trial.latched ? hand.Turning(lone) : 0);
    trial.opened_rad = std::max(trial.opened_rad, lone.hinge_rad());
    trial.opened_s = i * config.time_step_s;
    if (lone.hinge_rad() > config.open_rad) break;
  }
  trial.finite = trial.finite && lone.Finite();
}

}  // namespace

OpeningTrial TryOpening(const DoorAsset& door, const OpeningTrialConfig& config) {
  OpeningTrial trial;
  trial.latched = door.latch.type != LatchType::kNone;
  if (trial.latched) {
    TryLocked(door, config, trial);
    TryHandle(door, config, trial);
  }
  TryPull(door, config, trial);
  return trial;
}

}  // namespace doorforge
