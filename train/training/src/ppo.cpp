// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/ppo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"

#include "adam.h"
#include "head_objectives.h"
#include "ppo_advantage.h"
#include "ppo_loss.h"

namespace doorforge {
namespace {

using internal::PpoBatch;
using internal::PpoDecision;
using internal::PpoLoss;

constexpr float kActorLastScale = 0.01F;  // actions begin near their middle
constexpr float kCriticLastScale = 1;
constexpr double kLeastDeviation = 1e-8;

// What one stepper saw in an update.
struct Played {
  PpoBatch batch;  // advantages not normalised
  double episodes = 0;
  double reward = 0;
  double success = 0;
};

void Append(std::vector<float>& to, std::span<const float> from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Both networks by the library's own kernels, and the noise of one stepper.
struct Player {
  const PpoNetworks& networks;
  Mlp actor;
  Mlp critic;

  explicit Player(const PpoNetworks& from)
      : networks(from),
        actor(from.actor_shape, from.actor),
        critic(from.critic_shape, from.critic) {}

  double ValueOf(const std::vector<float>& observation) const {
    return double{critic(observation)[0]};
  }

  std::vector<float> ActionOf(const std::vector<float>& mean, Rng& rng) const {
    std::vector<float> action = mean;
    for (std::size_t i = 0; i < action.size(); ++i)
      action[i] += static_cast<float>(std::exp(double{networks.log_deviation[i]}) * rng.Normal());
    return action;
  }
};

// Whose turn it is: a stepper's part of an update.
struct Turn {
  std::uint64_t update;
  std::uint64_t stepper;
};

/// Plays one stepper's part of an update.
class Playing {
 public:
  Playing(const Player& player, const PpoConfig& config, Turn turn)
      : player_(player),
        config_(config),
        rng_(config.seed,
             "ppo/" + std::to_string(turn.update) + "/" + std::to_string(turn.stepper)),
        episode_((turn.update * static_cast<std::uint64_t>(config.steppers) + turn.stepper) *
                 static_cast<std::uint64_t>(config.steps)) {}

  Played Run(PpoStepper& stepper, const std::function<bool()>& stop) {
    for (int i = 0; i < config_.steps;) {
      if (stop && stop()) return {};
      i = PlayEpisode(stepper, i);
    }
    AddAdvantages();
    return std::move(played_);
  }

 private:
  // Returns how many decisions there are then.
  int PlayEpisode(PpoStepper& stepper, int done) {
    std::vector<float> observation = stepper.Reset(episode_++);
    double sum = 0;
    for (bool over = false; !over && done < config_.steps; ++done) {
      PpoStep step = Decide(stepper, observation);
      RequireFinite(step);
      sum += step.reward;
      over = step.terminated || step.truncated;
      PpoDecision& decision = decisions_.back();
      decision.ends = over || done + 1 == config_.steps;
      decision.reward = step.reward;
      if (!step.terminated) decision.next_value = player_.ValueOf(step.observation);
      if (over) NoteEpisode(sum, step.success);
      observation = std::move(step.observation);
    }
    return done;
  }

  PpoStep Decide(PpoStepper& stepper, const std::vector<float>& observation) {
    const std::vector<float> mean = player_.actor(observation);
    const std::vector<float> action = player_.ActionOf(mean, rng_);
    const double value = player_.ValueOf(observation);
    decisions_.push_back({.value = value});
    Append(played_.batch.observations, observation);
    Append(played_.batch.actions, action);
    played_.batch.values.push_back(static_cast<float>(value));
    played_.batch.log_probabilities.push_back(
        static_cast<float>(internal::LogProbability(action, mean, player_.networks.log_deviation)));
    return stepper.Step(action);
  }

  static void RequireFinite(const PpoStep& step) {
    const bool finite =
        std::isfinite(step.reward) &&
        std::ranges::all_of(step.observation, [](float x) { return std::isfinite(x); });
    Require(finite, ErrorCode::kIncomplete,
            "ppo: a reward or an observation is not finite; the last update is kept");
  }

  void NoteEpisode(double reward, bool success) {
    played_.episodes += 1;
    played_.reward += reward;
    played_.success += success ? 1 : 0;
  }

  void AddAdvantages() {
    const auto advantages = internal::AdvantagesOf(decisions_, config_.gamma, config_.lambda);
    for (std::size_t i = 0; i < advantages.size(); ++i) {
      played_.batch.advantages.push_back(static_cast<float>(advantages[i]));
      played_.batch.returns.push_back(static_cast<float>(advantages[i] + decisions_[i].value));
    }
  }

  const Player& player_;
  const PpoConfig& config_;
  Rng rng_;
  std::uint64_t episode_;
  std::vector<PpoDecision> decisions_;
  Played played_;
};

void Join(const Played& from, Played& to) {
  Append(to.batch.observations, from.batch.observations);
  Append(to.batch.actions, from.batch.actions);
  Append(to.batch.log_probabilities, from.batch.log_probabilities);
  Append(to.batch.values, from.batch.values);
  Append(to.batch.advantages, from.batch.advantages);
  Append(to.batch.returns, from.batch.returns);
  to.episodes += from.episodes;
  to.reward += from.reward;
  to.success += from.success;
}

// To mean 0 and deviation 1 over the update, summed in the order of the steppers.
void Normalise(std::vector<float>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const float value : values) squares += (double{value} - mean) * (double{value} - mean);
  const double deviation = std::sqrt(squares / count) + kLeastDeviation;
  for (float& value : values) value = static_cast<float>((double{value} - mean) / deviation);
}

std::vector<std::size_t> DrawnOrder(std::size_t count, Rng& rng) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[rng.Index(static_cast<std::uint32_t>(i))]);
  return order;
}

PpoBatch RowsOf(const PpoBatch& all, std::span<const std::size_t> rows) {
  const std::size_t seen = all.observations.size() / all.size();
  const std::size_t done = all.actions.size() / all.size();
  PpoBatch batch;
  for (const std::size_t row : rows) {
    Append(batch.observations, std::span(all.observations).subspan(row * seen, seen));
    Append(batch.actions, std::span(all.actions).subspan(row * done, done));
    batch.log_probabilities.push_back(all.log_probabilities[row]);
    batch.values.push_back(all.values[row]);
    batch.advantages.push_back(all.advantages[row]);
    batch.returns.push_back(all.returns[row]);
  }
  return batch;
}

void LimitNorm(std::span<float> gradient, double most) {
  double squares = 0;
  for (const float g : gradient) squares += double{g} * double{g};
  const double norm = std::sqrt(squares);
  if (norm <= most) return;
  for (float& g : gradient) g = static_cast<float>(double{g} * (most / norm));
}

/// The passes over an update's decisions.
class Learning {
 public:
  Learning(const PpoConfig& config, PpoState& state) : config_(config), state_(state) {}

  void Run(const PpoBatch& batch, PpoUpdate& update) {
    const double rate = RateNow();
    int minibatches = 0;
    Rng rng(config_.seed, "ppo/" + std::to_string(state_.updates.size()) + "/order");
    for (int epoch = 0; epoch < config_.epochs; ++epoch) {
      const auto order = DrawnOrder(batch.size(), rng);
      double kl = 0;
      int parts = 0;
      for (std::size_t first = 0; first < order.size(); first += Minibatch()) {
        const auto rows =
            std::span(order).subspan(first, std::min(Minibatch(), order.size() - first));
        const PpoLoss loss = internal::PpoLossOf(state_.networks, RowsOf(batch, rows), config_);
        Add(loss, update);
        kl += loss.kl;
        ++parts;
        Step(loss, rate);
      }
      minibatches += parts;
      update.kl = kl / parts;
      if (config_.target_kl > 0 && update.kl > config_.target_kl) break;
    }
    for (double PpoUpdate::*mean : {&PpoUpdate::policy_loss, &PpoUpdate::value_loss,
                                    &PpoUpdate::entropy, &PpoUpdate::clipped})
      update.*mean /= minibatches;
  }

 private:
  std::size_t Minibatch() const { return static_cast<std::size_t>(config_.minibatch); }

  double RateNow() const {
    const double done =
        static_cast<double>(state_.updates.size()) / static_cast<double>(PpoUpdatesOf(config_));
    return config_.learning_rate * (1 - (1 - config_.final_rate) * done);
  }

  static void Add(const PpoLoss& loss, PpoUpdate& update) {
    update.policy_loss += loss.policy;
    update.value_loss += loss.value;
    update.entropy += loss.entropy;
    update.clipped += loss.clipped;
  }

  void Step(PpoLoss loss, double rate) {
    PpoNetworks& networks = state_.networks;
    Require(std::isfinite(loss.policy) && std::isfinite(loss.value), ErrorCode::kIncomplete,
            "ppo: a loss is not finite; the last update is kept");
    ++state_.gradient_steps;
    const std::size_t acting = networks.actor.size() + networks.log_deviation.size();
    LimitNorm(std::span(loss.gradient).first(acting), config_.gradient_norm);
    LimitNorm(std::span(loss.gradient).subspan(acting), config_.gradient_norm);
    std::size_t at = 0;
    for (std::vector<float>* part : {&networks.actor, &networks.log_deviation, &networks.critic}) {
      const auto slice = [&](std::vector<float>& all) {
        return std::span(all).subspan(at, part->size());
      };
      internal::AdamStep({rate, 0}, state_.gradient_steps, slice(loss.gradient),
                         {*part, slice(state_.first_moment), slice(state_.second_moment)});
      at += part->size();
    }
  }

  const PpoConfig& config_;
  PpoState& state_;
};

/// One training, with the steppers that it plays with.
class PpoTraining {
 public:
  PpoTraining(const PpoTask& task, const PpoConfig& config, const PpoHooks& hooks)
      : task_(task),
        config_(config),
        hooks_(hooks),
        steppers_(static_cast<std::size_t>(config.steppers)) {}

  PpoState Run(PpoState state) {
    while (state.updates.size() < PpoUpdatesOf(config_)) {
      const std::optional<Played> played = Play(state);
      if (!played) break;
      Learn(*played, state);
      if (hooks_.on_update) hooks_.on_update(state);
    }
    return state;
  }

 private:
  bool Stopped() const { return hooks_.stop && hooks_.stop(); }

  // Nothing where it was stopped.
  std::optional<Played> Play(const PpoState& state) {
    if (Stopped()) return std::nullopt;
    const Player player(state.networks);
    std::vector<Played> parts(steppers_.size());
    ParallelFor(parts.size(), hooks_.threads, [&](std::size_t i) {
      if (!steppers_[i]) steppers_[i] = task_.make();
      parts[i] =
          Playing(player, config_, {state.updates.size(), i}).Run(*steppers_[i], hooks_.stop);
    });
    Played all;
    for (const Played& part : parts) {
      if (part.batch.size() == 0) return std::nullopt;
      Join(part, all);
    }
    return all;
  }

  void Learn(Played played, PpoState& state) {
    PpoUpdate update;
    const double ended = std::max(played.episodes, 1.0);
    update.decisions = static_cast<double>((state.updates.size() + 1) * played.batch.size());
    update.episodes = played.episodes;
    update.reward = played.reward / ended;
    update.success = played.success / ended;
    Normalise(played.batch.advantages);
    Learning(config_, state).Run(played.batch, update);
    state.updates.push_back(update);
  }

  const PpoTask& task_;
  const PpoConfig& config_;
  const PpoHooks& hooks_;
  std::vector<std::unique_ptr<PpoStepper>> steppers_;
};

constexpr std::array<PpoColumn, 9> kPpoColumns = {{
    {"decisions", &PpoUpdate::decisions},
    {"episodes", &PpoUpdate::episodes},
    {"reward", &PpoUpdate::reward},
    {"success", &PpoUpdate::success},
    {"policy_loss", &PpoUpdate::policy_loss},
    {"value_loss", &PpoUpdate::value_loss},
    {"entropy", &PpoUpdate::entropy},
    {"kl", &PpoUpdate::kl},
    {"clipped", &PpoUpdate::clipped},
}};

}  // namespace

std::span<const PpoColumn> PpoColumns() { return kPpoColumns; }

void CheckPpoConfig(const PpoConfig& config, const std::string& path) {
  RequireRange(path, "decisions", static_cast<double>(config.decisions), 1, 1e12);
  RequireRange(path, "steppers", config.steppers, 1, 4096);
  RequireRange(path, "steps", config.steps, 1, 1e6);
  RequireRange(path, "epochs", config.epochs, 1, 1000);
  RequireRange(path, "minibatch", config.minibatch, 1, 1e6);
  RequireRange(path, "learning_rate", config.learning_rate, 1e-9, 1);
  RequireRange(path, "final_rate", config.final_rate, 0, 1);
  RequireRange(path, "gamma", config.gamma, 0, 1);
  RequireRange(path, "lambda", config.lambda, 0, 1);
  RequireRange(path, "clip", config.clip, 1e-3, 10);
  RequireRange(path, "value_clip", config.value_clip, 0, 1e6);
  RequireRange(path, "entropy", config.entropy, 0, 10);
  RequireRange(path, "value", config.value, 0, 100);
  RequireRange(path, "gradient_norm", config.gradient_norm, 1e-6, 1e6);
  RequireRange(path, "target_kl", config.target_kl, 0, 100);
  RequireRange(path, "begin_deviation", config.begin_deviation, 1e-3, 10);
  RequireRange(path, "hidden", config.hidden, 1, 4096);
}

std::uint64_t PpoUpdatesOf(const PpoConfig& config) {
  const auto each =
      static_cast<std::uint64_t>(config.steppers) * static_cast<std::uint64_t>(config.steps);
  return (config.decisions + each - 1) / each;
}

PpoNetworks InitialPpoNetworks(const PpoTask& task, const PpoConfig& config) {
  PpoNetworks networks{{task.observation_size, config.hidden, task.action_size},
                       {task.observation_size, config.hidden, 1}};
  networks.actor = MlpInitialisation(networks.actor_shape, config.seed, "actor.", kActorLastScale);
  networks.critic =
      MlpInitialisation(networks.critic_shape, config.seed, "critic.", kCriticLastScale);
  networks.log_deviation.assign(static_cast<std::size_t>(task.action_size),
                                static_cast<float>(std::log(config.begin_deviation)));
  return networks;
}

PpoState InitialPpoState(const PpoTask& task, const PpoConfig& config) {
  CheckPpoConfig(config, "config");
  PpoState state;
  state.networks = InitialPpoNetworks(task, config);
  state.first_moment.resize(state.networks.actor.size() + state.networks.log_deviation.size() +
                            state.networks.critic.size());
  state.second_moment = state.first_moment;
  return state;
}

PpoState TrainPpo(const PpoTask& task, const PpoConfig& config, PpoState state,
                  const PpoHooks& hooks) {
  CheckPpoConfig(config, "config");
  internal::UseOneTorchThread();
  return PpoTraining(task, config, hooks).Run(std::move(state));
}

}  // namespace doorforge
