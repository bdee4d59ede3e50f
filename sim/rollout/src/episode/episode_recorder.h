// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/episode.h"

namespace doorforge::internal {

/// Collects the decisions of one stage.
class EpisodeRecorder {
 public:
  EpisodeRecorder(const RobotModel& robot, Stage stage) : robot_(robot), stage_(stage) {}

  bool Records(Stage stage) const { return stage == stage_; }
  /// A decision, before it is carried out.
  void Note(const Observation& observation, const Action& asked, const Action& executed,
            const WorldState& state);
  /// What the last one was worth.
  void Rate(double reward) { decisions_.back().angle_gain_rad = reward; }
  /// What all were worth: a choice of grasp is rated when the episode is over.
  void RateAll(double reward);

  std::vector<Decision> Take() { return std::move(decisions_); }

 private:
  JointState JointsOf(const WorldState& state) const;

  const RobotModel& robot_;
  Stage stage_;
  std::vector<Decision> decisions_;
};

}  // namespace doorforge::internal
