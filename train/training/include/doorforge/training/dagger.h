// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/point_net.h"
#include "doorforge/policy/hand_sight.h"

namespace doorforge {

/// Settings of behaviour cloning and DAgger (Ross et al. 2011) from a teacher.
struct DaggerConfig {
  int rounds = 10;                ///< The first clones: the teacher alone acts.
  int episodes = 32;              ///< Of a round.
  double teacher_share = 0.5;     ///< At a decision of round r the teacher acts with this to the r.
  int cloning_minibatches = 400;  ///< Steps of the gradient in the first round,
  int minibatches = 200;          ///< and in each of the others.
  int minibatch = 64;             ///< Decisions, drawn from all that are kept.
  int buffer = 100000;            ///< So many decisions are kept, the newest.
  double learning_rate = 1e-3;
  double final_rate = 0.05;  ///< The learning rate of the last round, times learning_rate.
  double gradient_norm = 1;  ///< A longer gradient is cut to this.
  int point_hidden = 128;    ///< Sizes of the student, see PointNetShape.
  int point_features = 256;
  int cloud_hidden = 256;
  int cloud_features = 112;
  int hidden = 512;
  int last_hidden = 64;
  std::uint64_t seed = 7;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("rounds", self.rounds);
    visit("episodes", self.episodes);
    visit("teacher_share", self.teacher_share);
    visit("cloning_minibatches", self.cloning_minibatches);
    visit("minibatches", self.minibatches);
    visit("minibatch", self.minibatch);
    visit("buffer", self.buffer);
    visit("learning_rate", self.learning_rate);
    visit("final_rate", self.final_rate);
    visit("gradient_norm", self.gradient_norm);
    visit("point_hidden", self.point_hidden);
    visit("point_features", self.point_features);
    visit("cloud_hidden", self.cloud_hidden);
    visit("cloud_features", self.cloud_features);
    visit("hidden", self.hidden);
    visit("last_hidden", self.last_hidden);
    visit("seed", self.seed);
  }
};

/// Throws Error(kInvalidConfig) that names the first field of `path` that is out of its range.
void CheckDaggerConfig(const DaggerConfig& config, const std::string& path);

/// Decisions that the teacher has labelled, one after the other.
struct DaggerSamples {
  int points = 1;                        ///< Of each sight, P.
  std::vector<float> xyz = {};           ///< n x P x 3, see HandSight.
  std::vector<std::uint8_t> label = {};  ///< n x P.
  std::vector<float> own = {};           ///< n x kSightOwn.
  std::vector<float> taught = {};        ///< n x kHandActions: what the teacher would do.

  std::size_t size() const { return own.size() / kSightOwn; }
  /// A sight of fewer points is filled up by repeating its first.
  void Add(const HandSight& sight, std::span<const float> action);
  void Append(const DaggerSamples& others);
  /// Leaves the newest alone.
  void KeepLast(std::size_t count);
};

/// What one decision led to.
struct DaggerStep {
  bool over = false;
  bool success = false;  ///< So far.
};

/// Episodes in which a student acts and a teacher says what it would do. Serves one thread.
class DaggerStepper {
 public:
  virtual ~DaggerStepper() = default;
  virtual void Reset(std::uint64_t episode) = 0;
  virtual HandSight See() = 0;
  /// kHandActions numbers within [-1, 1].
  virtual std::vector<float> Teach() = 0;
  virtual DaggerStep Step(std::span<const float> action) = 0;
};

/// What is learned; episodes are pure functions of their numbers.
struct DaggerTask {
  int points = 1;                                        ///< Of a sight, at most.
  std::function<std::unique_ptr<DaggerStepper>()> make;  ///< Called by several threads at once.
};

/// What a round came to.
struct DaggerRound {
  double decisions = 0;  ///< All so far.
  double episodes = 0;   ///< Of this round.
  double teacher = 0;    ///< Share of its decisions in which the teacher acted.
  double success = 0;    ///< Share of its episodes, whoever acted.
  double error = 0;      ///< Mean squared, of the student before it learned from this round's.
  double loss = 0;       ///< Mean squared error over the round's steps of the gradient.
};

/// Numbers of a round by their names, for files.
struct DaggerColumn {
  const char* name;
  double DaggerRound::*value;
};
std::span<const DaggerColumn> DaggerColumns();

/// What a training goes on from, beside the samples.
struct DaggerState {
  PointNetShape shape;
  std::vector<float> network;
  std::vector<float> first_moment;  ///< Of Adam.
  std::vector<float> second_moment;
  std::uint64_t gradient_steps = 0;
  std::vector<DaggerRound> rounds;
};

DaggerState InitialDaggerState(const DaggerConfig& config);

struct DaggerHooks {
  int threads = 0;  ///< 0: all processors; the result does not depend on it.
  std::function<void(std::size_t done, std::size_t of)> on_progress = nullptr;  ///< In a round.
  /// A round is done: `fresh` are the samples that it added.
  std::function<void(const DaggerState&, const DaggerSamples& fresh)> on_round = nullptr;
  /// True: ends with the last round that is done. Called by several threads at once.
  std::function<bool()> stop = nullptr;
};

/// Goes on from `state`, with the samples that it has learned from, to the last round.
///
/// In a round the episodes of its numbers are played, at each decision by the teacher with the
/// chance of the round, drawn from the stream "dagger/<round>/<episode>" of the seed, else by the
/// student; the teacher labels all. Then the student learns by Adam from minibatches of the stream
/// "dagger/<round>/order": mean squared error of its numbers to the teacher's. Deterministic: the
/// same bytes for any number of threads, and where `state` is one that on_round was given.
///
/// @throws Error(kInvalidConfig) as CheckDaggerConfig(); Error(kIncomplete) where a loss is not
///     finite; what the task throws.
DaggerState TrainDagger(const DaggerTask& task, const DaggerConfig& config, DaggerState state,
                        DaggerSamples samples, const DaggerHooks& hooks);

}  // namespace doorforge
