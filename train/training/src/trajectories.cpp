// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/trajectories.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"

#include "point_net_loss.h"
#include "sharded_step.h"
#include "trajectory_loss.h"

namespace doorforge {
namespace {

constexpr double kAsAsked = 0.15;  // VAT-MART's: within this share of the angle

constexpr std::array<TrajectoryColumn, 6> kTrajectoryColumns = {{
    {"episodes", &TrajectoryRound::episodes},
    {"success", &TrajectoryRound::success},
    {"proposer", &TrajectoryRound::proposer},
    {"critic", &TrajectoryRound::critic},
    {"affordance", &TrajectoryRound::affordance},
    {"probability", &TrajectoryRound::probability},
}};

template <class T>
void AddTo(std::vector<T>& to, std::span<const T> from) {
  to.insert(to.end(), from.begin(), from.end());
}

std::span<const float> RowAt(const std::vector<float>& values, std::size_t row, std::size_t width) {
  return std::span(values).subspan(row * width, width);
}

LearnedVector Begun(std::vector<float> parameters) {
  LearnedVector vector{std::move(parameters), {}, {}, 0};
  vector.first_moment.resize(vector.parameters.size());
  vector.second_moment = vector.first_moment;
  return vector;
}

internal::AdamState AdamOf(LearnedVector& vector) {
  return {vector.parameters, vector.first_moment, vector.second_moment, vector.steps};
}

std::string StreamOf(std::size_t round, const char* what) {
  return "trajectory/" + std::to_string(round) + "/" + what;
}

/// What a network of a round learns from, and what is drawn for it.
class RoundLessons {
 public:
  RoundLessons(const TrajectorySamples& samples, const TrajectoryLearning& config)
      : samples_(samples), config_(config) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (samples.opening_rad[i] >= config.least_opening_rad) opened_.push_back(i);
    Require(!opened_.empty(), ErrorCode::kIncomplete,
            "trajectories: no episode has opened its door; play more of them (episodes)");
  }

  std::size_t DrawOpened(Rng& rng) const {
    return opened_[rng.Index(static_cast<std::uint32_t>(opened_.size()))];
  }
  std::size_t DrawAny(Rng& rng) const {
    return rng.Index(static_cast<std::uint32_t>(samples_.size()));
  }

  // What one came to or, the other half of the time and of those that came to nothing, another.
  float DrawAngle(std::size_t sample, Rng& rng) const {
    const float own = samples_.opening_rad[sample];
    const bool other = rng.Uniform() < 0.5;
    const std::size_t drawn = DrawOpened(rng);
    return other || own < config_.least_opening_rad ? samples_.opening_rad[drawn] : own;
  }

  bool IsAsAsked(std::size_t sample, float asked_rad) const {
    return std::abs(samples_.opening_rad[sample] - asked_rad) < kAsAsked * asked_rad;
  }

 private:
  const TrajectorySamples& samples_;
  const TrajectoryLearning& config_;
  std::vector<std::size_t> opened_;
};

// A contact with what is asked for there, and what the critic makes of proposals for it.
struct RatedContact {
  float asked_rad = 0;
  float probability = 0;
};

/// The steps of all networks in a round.
class RoundLearning {
 public:
  RoundLearning(const TrajectoryLearning& config, const TrajectoryHooks& hooks,
                const TrajectorySamples& samples, TrajectoryState& state)
      : config_(config),
        hooks_(hooks),
        samples_(samples),
        state_(state),
        lessons_(samples, config),
        round_(state.rounds.size()) {}

  // False where it was stopped.
  bool Run(TrajectoryRound& report) {
    return TeachProposer(report.proposer) && TeachCritic(report.critic) && Rate(report) &&
           TeachAffordance(report.affordance);
  }

 private:
  bool TeachProposer(double& loss) {
    const std::size_t latent = static_cast<std::size_t>(state_.shape.latent);
    std::vector<std::size_t> drawn;
    std::vector<float> noise;
    const auto draw = [&](Rng& rng) {
      drawn.push_back(lessons_.DrawOpened(rng));
      for (std::size_t k = 0; k < latent; ++k) noise.push_back(static_cast<float>(rng.Normal()));
    };
    const auto clear = [&] { drawn.clear(), noise.clear(); };
    const auto loss_of = [&](std::span<const std::size_t> rows, std::span<float> gradient) {
      internal::ProposerBatch batch{.size = static_cast<int>(rows.size())};
      for (const std::size_t row : rows) {
        const std::size_t sample = drawn[row];
        AddSeen(sample, samples_.opening_rad[sample], batch.points, batch.targets);
        AddTo(batch.trajectory, TrajectoryAt(sample));
        AddTo(batch.noise, RowAt(noise, row, latent));
      }
      return internal::ProposerLossOf(
          state_.shape, state_.proposer.parameters, batch,
          {config_.waypoint_weight, config_.rotation_weight, config_.latent_weight}, Weight(),
          gradient);
    };
    return Steps("proposer", state_.proposer, {clear, draw, loss_of}, loss);
  }

  bool TeachCritic(double& loss) {
    std::vector<std::size_t> drawn;
    std::vector<float> asked;
    const auto draw = [&](Rng& rng) {
      drawn.push_back(lessons_.DrawAny(rng));
      asked.push_back(lessons_.DrawAngle(drawn.back(), rng));
    };
    const auto clear = [&] { drawn.clear(), asked.clear(); };
    const internal::PointNetLoss network{CriticShape(state_.shape),
                                         internal::PointNetError::kCrossEntropy};
    const auto loss_of = [&](std::span<const std::size_t> rows, std::span<float> gradient) {
      internal::PointNetBatch batch{.size = static_cast<int>(rows.size())};
      for (const std::size_t row : rows) {
        AddSeen(drawn[row], asked[row], batch.points, batch.own);
        AddTo(batch.own, TrajectoryAt(drawn[row]));
        batch.targets.push_back(lessons_.IsAsAsked(drawn[row], asked[row]) ? 1.0F : 0.0F);
      }
      return internal::PointNetLossOf(network, state_.critic.parameters, batch, Weight(), gradient);
    };
    return Steps("critic", state_.critic, {clear, draw, loss_of}, loss);
  }

  // What the critic of this round makes of this round's proposals, at all contacts so far.
  bool Rate(TrajectoryRound& report) {
    const TrajectoryRater rater(state_.Networks());
    rated_.resize(samples_.size());
    ParallelFor(rated_.size(), hooks_.threads, [&](std::size_t i) {
      if (hooks_.stop && hooks_.stop()) return;
      Rng rng(config_.seed, StreamOf(round_, "rated/") + std::to_string(i));
      const float asked_rad = samples_.opening_rad[lessons_.DrawOpened(rng)];
      const auto proposals = rater.Propose(samples_.SightOf(i), samples_.TargetOf(i, asked_rad),
                                           config_.rated_proposals, rng);
      rated_[i] = {asked_rad, MeanOfBest(proposals.probability)};
      Tell();
    });
    for (const RatedContact& rated : rated_)
      report.probability +=
          static_cast<double>(rated.probability) / static_cast<double>(rated_.size());
    return !(hooks_.stop && hooks_.stop());
  }

  bool TeachAffordance(double& loss) {
    std::vector<std::size_t> drawn;
    const auto draw = [&](Rng& rng) { drawn.push_back(lessons_.DrawAny(rng)); };
    const auto clear = [&] { drawn.clear(); };
    const internal::PointNetLoss network{AffordanceShape(state_.shape),
                                         internal::PointNetError::kCrossEntropy};
    const auto loss_of = [&](std::span<const std::size_t> rows, std::span<float> gradient) {
      internal::PointNetBatch batch{.size = static_cast<int>(rows.size())};
      for (const std::size_t row : rows) {
        AddSeen(drawn[row], rated_[drawn[row]].asked_rad, batch.points, batch.own);
        batch.targets.push_back(rated_[drawn[row]].probability);
      }
      return internal::PointNetLossOf(network, state_.affordance.parameters, batch, Weight(),
                                      gradient);
    };
    return Steps("affordance", state_.affordance, {clear, draw, loss_of}, loss);
  }

  // What a step draws, row by row, and learns.
  struct Lesson {
    std::function<void()> clear;
    std::function<void(Rng&)> draw;
    internal::LossOfRows loss;
  };

  bool Steps(const char* network, LearnedVector& vector, const Lesson& lesson, double& loss) {
    Rng rng(config_.seed, StreamOf(round_, network));
    std::vector<std::size_t> rows(static_cast<std::size_t>(config_.minibatch));
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    double sum = 0;
    for (int i = 0; i < config_.minibatches; ++i) {
      if (hooks_.stop && hooks_.stop()) return false;
      lesson.clear();
      for (std::size_t row = 0; row < rows.size(); ++row) lesson.draw(rng);
      sum += Weight() * internal::ShardedStep(rows, lesson.loss, Rates(), AdamOf(vector));
      Tell();
    }
    loss = sum / config_.minibatches;
    return true;
  }

  // From the first learning rate to the last, by the share of the rounds that are done.
  internal::StepRates Rates() const {
    const double done =
        std::min(static_cast<double>(round_) / std::max(config_.rounds - 1, 1), 1.0);
    return {.learning_rate = config_.learning_rate * std::pow(config_.final_rate, done),
            .gradient_norm = config_.gradient_norm,
            .weight_decay = config_.weight_decay,
            .threads = hooks_.threads};
  }

  double Weight() const { return 1.0 / config_.minibatch; }

  void AddSeen(std::size_t sample, float asked_rad, std::vector<float>& points,
               std::vector<float>& own) const {
    const TrajectoryTarget target = samples_.TargetOf(sample, asked_rad);
    AppendDoorPoints(samples_.SightOf(sample), target.contact_m, points);
    AppendTarget(target, own);
  }

  std::span<const float> TrajectoryAt(std::size_t sample) const {
    return RowAt(samples_.trajectory, sample, static_cast<std::size_t>(samples_.numbers));
  }

  void Tell() {
    if (!hooks_.on_progress) return;
    const std::scoped_lock lock(telling_);
    hooks_.on_progress();
  }

  const TrajectoryLearning& config_;
  const TrajectoryHooks& hooks_;
  const TrajectorySamples& samples_;
  TrajectoryState& state_;
  RoundLessons lessons_;
  std::size_t round_;
  std::vector<RatedContact> rated_;
  std::mutex telling_;
};

/// One training with its samples.
class TrajectoryTraining {
 public:
  TrajectoryTraining(const TrajectoryTask& task, const TrajectoryLearning& config,
                     const TrajectoryHooks& hooks)
      : task_(task), config_(config), hooks_(hooks) {}

  TrajectoryState Run(TrajectoryState state, TrajectorySamples samples) {
    while (std::cmp_less(state.rounds.size(), config_.rounds)) {
      TrajectoryRound round;
      const std::optional<TrajectorySamples> fresh = Play(state, round);
      if (!fresh) break;
      samples.Append(*fresh);
      TrajectoryState next = state;
      if (!RoundLearning(config_, hooks_, samples, next).Run(round)) break;
      next.rounds.push_back(round);
      state = std::move(next);
      if (hooks_.on_round) hooks_.on_round(state, *fresh);
    }
    return state;
  }

 private:
  // Nothing where it was stopped.
  std::optional<TrajectorySamples> Play(const TrajectoryState& state, TrajectoryRound& round) {
    const std::size_t number = state.rounds.size();
    const auto count = static_cast<std::size_t>(config_.episodes);
    std::optional<TrajectoryRater> learned;
    if (number > 0) learned.emplace(state.Networks());
    std::vector<std::optional<TrajectoryTrial>> trials(count);
    std::mutex telling;
    ParallelFor(count, hooks_.threads, [&](std::size_t i) {
      if (hooks_.stop && hooks_.stop()) return;
      trials[i] = task_.play(number * count + i, learned ? &*learned : nullptr);
      if (!hooks_.on_progress) return;
      const std::scoped_lock lock(telling);
      hooks_.on_progress();
    });
    if (hooks_.stop && hooks_.stop()) return std::nullopt;
    CompleteMissed(trials, number);
    TrajectorySamples fresh{.points = task_.points,
                            .numbers = TrajectoryNumbers(state.shape.waypoints)};
    for (const auto& trial : trials) {
      if (!trial) continue;
      fresh.Add(*trial);
      round.success += trial->opened ? 1.0 / static_cast<double>(count) : 0;
    }
    round.episodes = static_cast<double>((number + 1) * count);
    return fresh;
  }

  // A grasp that missed is known to fail whatever follows: it gets the motion of one that did not.
  void CompleteMissed(std::vector<std::optional<TrajectoryTrial>>& trials,
                      std::size_t round) const {
    std::vector<std::size_t> moved;
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (trials[i] && trials[i]->moved) moved.push_back(i);
    if (moved.empty()) return;
    Rng rng(config_.seed, StreamOf(round, "missed"));
    for (auto& trial : trials) {
      if (!trial || trial->moved) continue;
      const auto& other = trials[moved[rng.Index(static_cast<std::uint32_t>(moved.size()))]];
      std::copy(other->numbers.begin() + 6, other->numbers.end(), trial->numbers.begin() + 6);
    }
  }

  const TrajectoryTask& task_;
  const TrajectoryLearning& config_;
  const TrajectoryHooks& hooks_;
};

}  // namespace

std::span<const TrajectoryColumn> TrajectoryColumns() { return kTrajectoryColumns; }

void CheckTrajectoryLearning(const TrajectoryLearning& config, const std::string& path) {
  RequireRange(path, "rounds", config.rounds, 1, 10000);
  RequireRange(path, "episodes", config.episodes, 1, 1e7);
  RequireRange(path, "minibatches", config.minibatches, 1, 1e7);
  RequireRange(path, "minibatch", config.minibatch, 1, 65536);
  RequireRange(path, "least_opening_rad", config.least_opening_rad, 0.001, 3.14);
  RequireRange(path, "explored_contacts", config.explored_contacts, 1, 10000);
  RequireRange(path, "explored_proposals", config.explored_proposals, 1, 10000);
  RequireRange(path, "rated_proposals", config.rated_proposals, 1, 10000);
  RequireRange(path, "waypoint_weight", config.waypoint_weight, 0, 1e6);
  RequireRange(path, "rotation_weight", config.rotation_weight, 0, 1e6);
  RequireRange(path, "latent_weight", config.latent_weight, 0, 1e6);
  RequireRange(path, "learning_rate", config.learning_rate, 1e-9, 1);
  RequireRange(path, "final_rate", config.final_rate, 1e-6, 1);
  RequireRange(path, "weight_decay", config.weight_decay, 0, 1);
  RequireRange(path, "gradient_norm", config.gradient_norm, 1e-6, 1e6);
}

void TrajectorySamples::Add(const TrajectoryTrial& trial) {
  AddTo<float>(xyz, trial.sight.xyz);
  AddTo<std::uint8_t>(label, trial.sight.label);
  contact_m.insert(contact_m.end(), trial.contact_m.begin(), trial.contact_m.end());
  AddTo<float>(trajectory, trial.numbers);
  opening_rad.push_back(trial.opening_rad);
}

void TrajectorySamples::Append(const TrajectorySamples& others) {
  points = others.points;
  numbers = others.numbers;
  AddTo<float>(xyz, others.xyz);
  AddTo<std::uint8_t>(label, others.label);
  AddTo<float>(contact_m, others.contact_m);
  AddTo<float>(trajectory, others.trajectory);
  AddTo<float>(opening_rad, others.opening_rad);
}

DoorSight TrajectorySamples::SightOf(std::size_t sample) const {
  const auto count = static_cast<std::size_t>(points);
  const auto seen = RowAt(xyz, sample, 3 * count);
  const auto first = label.begin() + static_cast<std::ptrdiff_t>(sample * count);
  return {{seen.begin(), seen.end()}, {first, first + points}};
}

TrajectoryTarget TrajectorySamples::TargetOf(std::size_t sample, float asked_rad) const {
  const auto at = RowAt(contact_m, sample, 3);
  return {{at[0], at[1], at[2]}, asked_rad};
}

TrajectoryNetworks TrajectoryState::Networks() const {
  const std::size_t size = PointNetLayout(ProposerShape(shape)).size();
  return {shape,
          {proposer.parameters.begin(),
           proposer.parameters.begin() + static_cast<std::ptrdiff_t>(size)},
          {},
          critic.parameters,
          affordance.parameters};
}

TrajectoryState InitialTrajectoryState(const TrajectoryShape& shape, std::uint64_t seed) {
  CheckTrajectoryShape(shape, "config");
  TrajectoryNetworks networks = InitialTrajectoryNetworks(shape, seed);
  AddTo<float>(networks.proposer, networks.posterior);
  return {shape,
          Begun(std::move(networks.proposer)),
          Begun(std::move(networks.critic)),
          Begun(std::move(networks.affordance)),
          {}};
}

TrajectoryState TrainTrajectories(const TrajectoryTask& task, const TrajectoryLearning& config,
                                  TrajectoryState state, TrajectorySamples samples,
                                  const TrajectoryHooks& hooks) {
  CheckTrajectoryLearning(config, "config");
  return TrajectoryTraining(task, config, hooks).Run(std::move(state), std::move(samples));
}

}  // namespace doorforge
