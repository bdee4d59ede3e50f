// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/policy/trajectory_networks.h"

namespace doorforge {

/// Settings of learning to say whole trajectories, in the manner of VAT-MART (Wu et al. 2022).
struct TrajectoryLearning {
  int rounds = 4;          ///< In the first one rules act, in the others what was learned so far.
  int episodes = 1500;     ///< Of a round.
  int minibatches = 1500;  ///< Steps of the gradient of each network in a round.
  int minibatch = 32;      ///< Trajectories, drawn from all so far.
  /// Who has opened less far teaches no trajectory [rad]; what was not asked for by 15 % is a
  /// failure to the critic.
  double least_opening_rad = 0.17;
  int explored_contacts = 4;    ///< In later rounds, see TrajectoryChoice::contacts,
  int explored_proposals = 10;  ///< and proposals: fewer than the policy has later, to try more.
  int rated_proposals = 100;    ///< At a contact, for what the affordance learns of it.
  double waypoint_weight = 10;  ///< See ProposerLossOf().
  double rotation_weight = 5;
  double latent_weight = 0.2;
  double learning_rate = 1e-3;
  double final_rate = 0.1;  ///< The learning rate of the last round, times learning_rate.
  double weight_decay = 1e-5;
  double gradient_norm = 10;  ///< A longer gradient is cut to this.
  std::uint64_t seed = 7;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("rounds", self.rounds);
    visit("episodes", self.episodes);
    visit("minibatches", self.minibatches);
    visit("minibatch", self.minibatch);
    visit("least_opening_rad", self.least_opening_rad);
    visit("explored_contacts", self.explored_contacts);
    visit("explored_proposals", self.explored_proposals);
    visit("rated_proposals", self.rated_proposals);
    visit("waypoint_weight", self.waypoint_weight);
    visit("rotation_weight", self.rotation_weight);
    visit("latent_weight", self.latent_weight);
    visit("learning_rate", self.learning_rate);
    visit("final_rate", self.final_rate);
    visit("weight_decay", self.weight_decay);
    visit("gradient_norm", self.gradient_norm);
    visit("seed", self.seed);
  }
};

/// Throws Error(kInvalidConfig) that names the first field of `path` that is out of its range.
void CheckTrajectoryLearning(const TrajectoryLearning& config, const std::string& path);

/// What one episode came to.
struct TrajectoryTrial {
  DoorSight sight;
  Eigen::Vector3f contact_m = Eigen::Vector3f::Zero();
  std::vector<float> numbers;  ///< Of the trajectory that was tried.
  bool moved = true;      ///< False: the grasp missed, and nobody knows what would have followed.
  float opening_rad = 0;  ///< Where the hinge was in the end, at least 0.
  bool opened = false;    ///< As the episode was judged.
};

/// Trials, one after the other.
struct TrajectorySamples {
  int points = 1;                        ///< Of each sight, P.
  int numbers = 6;                       ///< Of each trajectory.
  std::vector<float> xyz = {};           ///< n x P x 3 [m], world.
  std::vector<std::uint8_t> label = {};  ///< n x P.
  std::vector<float> contact_m = {};     ///< n x 3.
  std::vector<float> trajectory = {};    ///< n x numbers.
  std::vector<float> opening_rad = {};   ///< n.

  std::size_t size() const { return opening_rad.size(); }
  void Add(const TrajectoryTrial& trial);
  void Append(const TrajectorySamples& others);
  DoorSight SightOf(std::size_t sample) const;
  TrajectoryTarget TargetOf(std::size_t sample, float opening_rad) const;
};

/// What is learned. An episode is a pure function of its number and of who acts.
struct TrajectoryTask {
  int points = 1;  ///< Of a sight.
  /// Nothing where there was no handle to be seen. Rules act where `acts` is null. Called by
  /// several threads at once.
  std::function<std::optional<TrajectoryTrial>(std::uint64_t episode, const TrajectoryRater* acts)>
      play;
};

/// What a round came to.
struct TrajectoryRound {
  double episodes = 0;  ///< All so far.
  double success = 0;   ///< Share of its episodes that opened.
  double proposer = 0;  ///< Mean losses over its steps.
  double critic = 0;
  double affordance = 0;
  double probability = 0;  ///< Mean of what the affordance was taught in it.
};

/// Numbers of a round by their names, for files.
struct TrajectoryColumn {
  const char* name;
  double TrajectoryRound::*value;
};
std::span<const TrajectoryColumn> TrajectoryColumns();

/// Parameters and Adam's memory of them.
struct LearnedVector {
  std::vector<float> parameters;
  std::vector<float> first_moment;
  std::vector<float> second_moment;
  std::uint64_t steps = 0;
};

/// What a training goes on from, beside the samples.
struct TrajectoryState {
  TrajectoryShape shape;
  LearnedVector proposer;  ///< The posterior's parameters behind it.
  LearnedVector critic;
  LearnedVector affordance;
  std::vector<TrajectoryRound> rounds;

  TrajectoryNetworks Networks() const;  ///< Without the posterior.
};

TrajectoryState InitialTrajectoryState(const TrajectoryShape& shape, std::uint64_t seed);

struct TrajectoryHooks {
  int threads = 0;  ///< 0: all processors; the result does not depend on it.
  std::function<void()> on_progress = nullptr;  ///< An episode, a step or a rated contact is done.
  /// A round is done: `fresh` are the samples that it added.
  std::function<void(const TrajectoryState&, const TrajectorySamples& fresh)> on_round = nullptr;
  /// True: ends with the last round that is done. Called by several threads at once.
  std::function<bool()> stop = nullptr;
};

/// Goes on from `state`, with the samples that it has learned from, to the last round.
///
/// A round plays the episodes of its numbers and adds them to the samples; of one of the first
/// round whose grasp missed the motion is another's. Then it teaches, from all samples,
///   the proposer: trajectories that opened by `least_opening_rad` or more, for the angle that they
///   came to;
///   the critic: of a trajectory, whether it comes to what is asked for, within 15 % of it; asked
///   for is what it came to, half of the time, and what another one came to;
///   the affordance: MeanOfBest() of the critic's ratings of proposals at a sample's contact.
/// Minibatches, asked angles and latent numbers are drawn from streams "trajectory/<round>/..." of
/// the seed. Deterministic: the same bytes for any number of threads, and where `state` is one that
/// on_round was given.
///
/// @throws Error(kInvalidConfig) as CheckTrajectoryLearning(); Error(kIncomplete) where no episode
///     opened, or a loss is not finite; what the task throws.
TrajectoryState TrainTrajectories(const TrajectoryTask& task, const TrajectoryLearning& config,
                                  TrajectoryState state, TrajectorySamples samples,
                                  const TrajectoryHooks& hooks);

}  // namespace doorforge
