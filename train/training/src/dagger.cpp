// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/dagger.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"

#include "point_net_loss.h"
#include "sharded_step.h"

namespace doorforge {
namespace {

using internal::PointNetBatch;

template <class T>
void AppendRow(const std::vector<T>& from, std::size_t row, std::size_t width, std::vector<T>& to) {
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(row * width);
  to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(width));
}

template <class T>
void AddAll(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

template <class T>
void EraseRows(std::size_t rows, std::size_t width, std::vector<T>& values) {
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows * width));
}

PointNetBatch DaggerBatchOf(const DaggerSamples& samples, std::span<const std::size_t> rows) {
  PointNetBatch batch{.size = static_cast<int>(rows.size())};
  const auto count = static_cast<std::size_t>(samples.points);
  batch.points.reserve(rows.size() * count * kSightPoint);
  for (const std::size_t row : rows) {
    AppendSightPoints(std::span(samples.xyz).subspan(3 * row * count, 3 * count),
                      std::span(samples.label).subspan(row * count, count), batch.points);
    AppendRow(samples.own, row, kSightOwn, batch.own);
    AppendRow(samples.taught, row, kHandActions, batch.targets);
  }
  return batch;
}

// What one episode left, and how it went.
struct DaggerEpisode {
  DaggerSamples samples;
  std::size_t teacher_acted = 0;
  double squared_error = 0;
  bool success = false;
  bool stopped = false;
};

/// Plays an episode of a round.
class DaggerPlaying {
 public:
  DaggerPlaying(const PointNet& student, double teacher_share, Rng rng)
      : student_(student), teacher_share_(teacher_share), rng_(rng) {}

  DaggerEpisode Run(DaggerStepper& stepper, int points, const std::function<bool()>& stop) {
    episode_.samples.points = points;
    for (DaggerStep step; !step.over;) {
      if (stop && stop()) {
        episode_.stopped = true;
        break;
      }
      step = Decide(stepper);
      episode_.success = step.success;
    }
    return std::move(episode_);
  }

 private:
  DaggerStep Decide(DaggerStepper& stepper) {
    const HandSight sight = stepper.See();
    const std::vector<float> taught = stepper.Teach();
    episode_.samples.Add(sight, taught);
    std::vector<float> points;
    AppendSightPoints(sight.xyz, sight.label, points);
    const std::vector<float> says = student_(points, sight.own);
    for (std::size_t i = 0; i < taught.size(); ++i) {
      const double error = double{says[i]} - double{taught[i]};
      episode_.squared_error += error * error;
    }
    const bool teacher = rng_.Uniform() < teacher_share_;
    episode_.teacher_acted += teacher ? 1 : 0;
    return stepper.Step(teacher ? taught : says);
  }

  const PointNet& student_;
  double teacher_share_;
  Rng rng_;
  DaggerEpisode episode_;
};

/// The student's steps of the gradient in a round.
class DaggerLearning {
 public:
  DaggerLearning(const DaggerConfig& config, const DaggerHooks& hooks, DaggerState& state)
      : config_(config), hooks_(hooks), state_(state) {}

  // The mean squared error; nothing where it was stopped.
  std::optional<double> Run(const DaggerSamples& samples) {
    const std::size_t round = state_.rounds.size();
    const auto steps =
        static_cast<std::size_t>(round == 0 ? config_.cloning_minibatches : config_.minibatches);
    Rng rng(config_.seed, "dagger/" + std::to_string(round) + "/order");
    double sum = 0;
    for (std::size_t i = 0; i < steps; ++i) {
      if (hooks_.stop && hooks_.stop()) return std::nullopt;
      std::vector<std::size_t> rows(static_cast<std::size_t>(config_.minibatch));
      for (std::size_t& row : rows) row = rng.Index(static_cast<std::uint32_t>(samples.size()));
      sum += Step(samples, rows);
      if (hooks_.on_progress) hooks_.on_progress(i + 1, steps);
    }
    return sum / static_cast<double>(steps);
  }

 private:
  // From the first learning rate to the last, by the share of the rounds that are done.
  double RateNow() const {
    const int last = std::max(config_.rounds - 1, 1);
    const double done = std::min(static_cast<double>(state_.rounds.size()) / last, 1.0);
    return config_.learning_rate * std::pow(config_.final_rate, done);
  }

  double Step(const DaggerSamples& samples, std::span<const std::size_t> rows) {
    const double weight = 1.0 / (static_cast<double>(rows.size()) * kHandActions);
    const auto loss = [&](std::span<const std::size_t> part, std::span<float> gradient) {
      return internal::PointNetLossOf({state_.shape}, state_.network, DaggerBatchOf(samples, part),
                                      weight, gradient);
    };
    return weight * internal::ShardedStep(rows, loss,
                                          {.learning_rate = RateNow(),
                                           .gradient_norm = config_.gradient_norm,
                                           .threads = hooks_.threads},
                                          {state_.network, state_.first_moment,
                                           state_.second_moment, state_.gradient_steps});
  }

  const DaggerConfig& config_;
  const DaggerHooks& hooks_;
  DaggerState& state_;
};

/// One training with its samples.
class DaggerTraining {
 public:
  DaggerTraining(const DaggerTask& task, const DaggerConfig& config, const DaggerHooks& hooks)
      : task_(task), config_(config), hooks_(hooks) {}

  DaggerState Run(DaggerState state, DaggerSamples samples) {
    while (std::cmp_less(state.rounds.size(), config_.rounds)) {
      DaggerRound round;
      const std::optional<DaggerSamples> fresh = Play(state, round);
      if (!fresh) break;
      samples.Append(*fresh);
      samples.KeepLast(static_cast<std::size_t>(config_.buffer));
      DaggerState next = state;
      const std::optional<double> loss = DaggerLearning(config_, hooks_, next).Run(samples);
      if (!loss) break;
      round.loss = *loss;
      next.rounds.push_back(round);
      state = std::move(next);
      if (hooks_.on_round) hooks_.on_round(state, *fresh);
    }
    return state;
  }

 private:
  // Nothing where it was stopped.
  std::optional<DaggerSamples> Play(const DaggerState& state, DaggerRound& round) const {
    const PointNet student(state.shape, state.network);
    const std::size_t number = state.rounds.size();
    const auto count = static_cast<std::size_t>(config_.episodes);
    const double share = std::pow(config_.teacher_share, static_cast<double>(number));
    std::vector<DaggerEpisode> played(count);
    std::atomic<std::size_t> done = 0;
    ParallelFor(count, hooks_.threads, [&](std::size_t i) {
      if (hooks_.stop && hooks_.stop()) return;
      const auto stepper = task_.make();
      stepper->Reset(number * count + i);
      Rng rng(config_.seed, "dagger/" + std::to_string(number) + "/" + std::to_string(i));
      played[i] = DaggerPlaying(student, share, rng).Run(*stepper, task_.points, hooks_.stop);
      if (hooks_.on_progress) hooks_.on_progress(++done, count);
    });
    DaggerSamples fresh{.points = task_.points};
    for (const DaggerEpisode& episode : played) {
      if (episode.stopped || episode.samples.size() == 0) return std::nullopt;
      fresh.Append(episode.samples);
      round.teacher += static_cast<double>(episode.teacher_acted);
      round.success += episode.success ? 1 : 0;
      round.error += episode.squared_error;
    }
    const auto decisions = static_cast<double>(fresh.size());
    round.decisions = decisions + (state.rounds.empty() ? 0 : state.rounds.back().decisions);
    round.episodes = static_cast<double>(count);
    round.teacher /= decisions;
    round.success /= static_cast<double>(count);
    round.error /= decisions * kHandActions;
    return fresh;
  }

  const DaggerTask& task_;
  const DaggerConfig& config_;
  const DaggerHooks& hooks_;
};

constexpr std::array<DaggerColumn, 6> kDaggerColumns = {{
    {"decisions", &DaggerRound::decisions},
    {"episodes", &DaggerRound::episodes},
    {"teacher", &DaggerRound::teacher},
    {"success", &DaggerRound::success},
    {"error", &DaggerRound::error},
    {"loss", &DaggerRound::loss},
}};

PointNetShape StudentShape(const DaggerConfig& config) {
  return SightShape({.point_hidden = config.point_hidden,
                     .point_features = config.point_features,
                     .cloud_hidden = config.cloud_hidden,
                     .cloud_features = config.cloud_features,
                     .hidden = config.hidden,
                     .last_hidden = config.last_hidden});
}

}  // namespace

std::span<const DaggerColumn> DaggerColumns() { return kDaggerColumns; }

void CheckDaggerConfig(const DaggerConfig& config, const std::string& path) {
  RequireRange(path, "rounds", config.rounds, 1, 10000);
  RequireRange(path, "episodes", config.episodes, 1, 100000);
  RequireRange(path, "teacher_share", config.teacher_share, 0, 1);
  RequireRange(path, "cloning_minibatches", config.cloning_minibatches, 1, 1e7);
  RequireRange(path, "minibatches", config.minibatches, 1, 1e7);
  RequireRange(path, "minibatch", config.minibatch, 1, 65536);
  RequireRange(path, "buffer", config.buffer, 1, 1e7);
  RequireRange(path, "learning_rate", config.learning_rate, 1e-9, 1);
  RequireRange(path, "final_rate", config.final_rate, 1e-6, 1);
  RequireRange(path, "gradient_norm", config.gradient_norm, 1e-6, 1e6);
  RequireRange(path, "point_hidden", config.point_hidden, 1, 256);
  RequireRange(path, "point_features", config.point_features, 32, 4096);
  RequireRange(path, "cloud_hidden", config.cloud_hidden, 1, 4096);
  RequireRange(path, "cloud_features", config.cloud_features, 1, 4096);
  RequireRange(path, "hidden", config.hidden, 1, 4096);
  RequireRange(path, "last_hidden", config.last_hidden, 1, 4096);
  Require(config.point_features % 32 == 0, ErrorCode::kInvalidConfig,
          path + ".point_features: " + std::to_string(config.point_features) +
              ", expected a multiple of 32");
}

void DaggerSamples::Add(const HandSight& sight, std::span<const float> action) {
  AddAll(sight.xyz, xyz);
  AddAll(sight.label, label);
  for (auto i = sight.label.size(); std::cmp_less(i, points); ++i) {
    AppendRow(sight.xyz, 0, 3, xyz);
    label.push_back(sight.label[0]);
  }
  own.insert(own.end(), sight.own.begin(), sight.own.end());
  taught.insert(taught.end(), action.begin(), action.end());
}

void DaggerSamples::Append(const DaggerSamples& others) {
  points = others.points;
  AddAll(others.xyz, xyz);
  AddAll(others.label, label);
  AddAll(others.own, own);
  AddAll(others.taught, taught);
}

void DaggerSamples::KeepLast(std::size_t count) {
  if (size() <= count) return;
  const std::size_t rows = size() - count;
  EraseRows(rows, 3 * static_cast<std::size_t>(points), xyz);
  EraseRows(rows, static_cast<std::size_t>(points), label);
  EraseRows(rows, kSightOwn, own);
  EraseRows(rows, kHandActions, taught);
}

DaggerState InitialDaggerState(const DaggerConfig& config) {
  CheckDaggerConfig(config, "config");
  DaggerState state;
  state.shape = StudentShape(config);
  state.network = PointNetInitialisation(state.shape, config.seed, "student.");
  state.first_moment.resize(state.network.size());
  state.second_moment = state.first_moment;
  return state;
}

DaggerState TrainDagger(const DaggerTask& task, const DaggerConfig& config, DaggerState state,
                        DaggerSamples samples, const DaggerHooks& hooks) {
  CheckDaggerConfig(config, "config");
  return DaggerTraining(task, config, hooks).Run(std::move(state), std::move(samples));
}

}  // namespace doorforge
