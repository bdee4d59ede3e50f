// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/episode_recorder.h"

#include <algorithm>

#include "doorforge/rollout/proprioception.h"

namespace doorforge::internal {

void EpisodeRecorder::Note(const Observation& observation, const Action& asked,
                           const Action& executed, const WorldState& state) {
  Decision decision;
  decision.cloud = observation.cloud;
  decision.proprioception = observation.proprioception;
  decision.action = ToVector(asked);
  decision.executed = ToVector(executed);
  decision.time_s = state.time_s;
  decision.hinge_rad = state.hinge_rad;
  decision.handle_rad = state.handle_rad;
  decision.state = JointsOf(state);
  decisions_.push_back(std::move(decision));
}

void EpisodeRecorder::RateAll(double reward) {
  for (Decision& decision : decisions_) decision.angle_gain_rad = reward;
}

JointState EpisodeRecorder::JointsOf(const WorldState& state) const {
  JointState joints{};
  if (HasProprioception(robot_)) {
    const ProprioceptionPlaces places = ProprioceptionPlacesOf(robot_);
    for (std::size_t place = 0; place < places.size(); ++place)
      if (places.at(place) >= 0) joints.at(place) = state.robot_position[places.at(place)];
  }
  joints[kStateHinge] = state.hinge_rad;
  joints[kStateHandle] = state.handle_rad;
  joints[kStateBolt] = state.bolt_m;
  return joints;
}

}  // namespace doorforge::internal
