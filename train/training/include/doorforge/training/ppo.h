// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/mlp.h"

// Proximal policy optimisation (Schulman et al. 2017) of a policy that reads a few numbers: many
// steppers play side by side, then actor and critic learn from what they saw, and so on.

namespace doorforge {

/// Settings of the learner. In brackets DoorGym's (repository 903493a), where they differ.
struct PpoConfig {
  std::uint64_t decisions = 1000000;  ///< Of all steppers together; the last update ends beyond.
  int steppers = 32;                  ///< They play in each update [8]
  int steps = 128;                    ///< so many decisions each [4096].
  int epochs = 10;                    ///< Passes over an update's decisions.
  int minibatch = 256;
  double learning_rate = 3e-4;  ///< At the beginning [1e-3 throughout];
  double final_rate = 0.1;      ///< at the end it is this part of that, on a straight line.
  double gamma = 0.99;
  double lambda = 0.95;
  double clip = 0.2;             ///< Of the ratio.
  double value_clip = 0;         ///< Of the value's change in an update; 0: none [0.2].
  double entropy = 0.001;        ///< Its weight in the objective [0.01].
  double value = 0.5;            ///< Weight of the value's loss.
  double gradient_norm = 0.5;    ///< Of each network's gradient, at most.
  double target_kl = 0.03;       ///< An update's passes end where the policy moved farther [none].
  double begin_deviation = 0.6;  ///< Of each number of an action, to begin with [1].
  int hidden = 64;               ///< Width of the two hidden layers, tanh.
  std::uint64_t seed = 7;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("decisions", self.decisions);
    visit("steppers", self.steppers);
    visit("steps", self.steps);
    visit("epochs", self.epochs);
    visit("minibatch", self.minibatch);
    visit("learning_rate", self.learning_rate);
    visit("final_rate", self.final_rate);
    visit("gamma", self.gamma);
    visit("lambda", self.lambda);
    visit("clip", self.clip);
    visit("value_clip", self.value_clip);
    visit("entropy", self.entropy);
    visit("value", self.value);
    visit("gradient_norm", self.gradient_norm);
    visit("target_kl", self.target_kl);
    visit("begin_deviation", self.begin_deviation);
    visit("hidden", self.hidden);
    visit("seed", self.seed);
  }
};

/// Throws Error(kInvalidConfig) that names the first field of `path` that is out of its range.
void CheckPpoConfig(const PpoConfig& config, const std::string& path);

/// What an action led to.
struct PpoStep {
  std::vector<float> observation;  ///< After it.
  double reward = 0;
  bool terminated = false;  ///< Nothing comes after it: its value is 0.
  bool truncated = false;   ///< The episode was cut off: it would have gone on.
  bool success = false;     ///< Of the episode so far; counted where it ends.
};

/// An environment to learn in. Belongs to one thread at a time.
class PpoStepper {
 public:
  virtual ~PpoStepper() = default;
  /// Begins an episode that is a pure function of its number. @returns The observation.
  virtual std::vector<float> Reset(std::uint64_t episode) = 0;
  /// @param action Not limited to any range.
  virtual PpoStep Step(std::span<const float> action) = 0;
};

/// What is to be learned.
struct PpoTask {
  int observation_size = 1;
  int action_size = 1;
  /// A new stepper, equal to all others; called from several threads at once.
  std::function<std::unique_ptr<PpoStepper>()> make;
};

/// Actor, its spread, and critic, as flat vectors.
struct PpoNetworks {
  MlpShape actor_shape;
  MlpShape critic_shape;
  std::vector<float> actor = {};          ///< MlpLayout(actor_shape): the mean of the action.
  std::vector<float> log_deviation = {};  ///< One number an action's number.
  std::vector<float> critic = {};         ///< MlpLayout(critic_shape): the value.
};
PpoNetworks InitialPpoNetworks(const PpoTask& task, const PpoConfig& config);

/// One update, for the curve. Means over its episodes and minibatches.
struct PpoUpdate {
  double decisions = 0;  ///< So many were taken up to its end.
  double episodes = 0;   ///< So many ended in it.
  double reward = 0;     ///< Sum of an episode's rewards.
  double success = 0;    ///< Share of the episodes.
  double policy_loss = 0;
  double value_loss = 0;
  double entropy = 0;  ///< Of the policy [nat].
  double kl = 0;       ///< From the policy before the update to the one after [nat].
  double clipped = 0;  ///< Share of ratios beyond the clip.
};
/// The names of its numbers, in the order of the struct, for files.
struct PpoColumn {
  const char* name;
  double PpoUpdate::*value;
};
std::span<const PpoColumn> PpoColumns();

/// All that a training needs to go on as if it had never stopped: steppers begin anew with each
/// update, so nothing of an episode is in it.
struct PpoState {
  PpoNetworks networks;
  /// Adam's moments of actor, spread and critic, one after the other.
  std::vector<float> first_moment, second_moment;
  std::uint64_t gradient_steps = 0;
  std::vector<PpoUpdate> updates;  ///< One an update done.
};
PpoState InitialPpoState(const PpoTask& task, const PpoConfig& config);

/// Number of updates that the decisions of a config take.
std::uint64_t PpoUpdatesOf(const PpoConfig& config);

/// How a training is carried out; none of it changes the result.
struct PpoHooks {
  int threads = 0;  ///< 0: all processors.
  /// Called after every update.
  std::function<void(const PpoState&)> on_update = {};
  /// Asked before every update, and between the episodes of one; true ends the training with the
  /// last update that was completed.
  std::function<bool()> stop = {};
};

/// Goes on from a state until all updates are done, or `stop` ends it.
///
/// An update: stepper i plays `steps` decisions with noise of the stream "ppo/<update>/<i>" and
/// episodes (update * steppers + i) * steps + k for k = 0, 1, ... The last one is cut off, with the
/// critic's value of what would have come. Then the passes over all decisions in an order drawn
/// from "ppo/<update>/order". Threads share the steppers alone; libtorch runs on one. So the same
/// state and config give the same bytes for any number of threads.
///
/// @throws Error(kInvalidConfig) as CheckPpoConfig(); Error(kIncomplete) where a loss or a reward
///     stops being finite; what the steppers throw.
PpoState TrainPpo(const PpoTask& task, const PpoConfig& config, PpoState state,
                  const PpoHooks& hooks);

}  // namespace doorforge
