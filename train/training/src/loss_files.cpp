// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/loss_files.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include "doorforge/core/committed_file.h"
#include "doorforge/training/event_log.h"

namespace doorforge {
namespace {

// A line a step; a loss that is not known yet is left out.
std::string LossLines(const TrainerState& state, const TrainingPace& pace) {
  const std::vector<LossColumn> columns = LossColumnsOf(state.networks.family);
  std::string text;
  const auto add = [&](const char* name, double value) {
    char number[64];
    std::snprintf(number, sizeof number, "\": %.9g", value);
    text.append(", \"").append(name).append(number);
  };
  for (std::size_t i = 0; i < state.steps.size(); ++i) {
    text += "{\"step\": " + std::to_string(i + 1) +
            ", \"epoch\": " + std::to_string(i / pace.steps_per_epoch + 1);
    add("learning_rate", LearningRateAt(pace.config, {i, pace.steps_per_epoch}));
    for (const LossColumn& column : columns) {
      const std::optional<double> value = state.steps[i].*(column.value);
      if (value && std::isfinite(*value)) add(column.name, *value);
    }
    text += "}\n";
  }
  return text;
}

// The steps' losses, and behind each epoch those of the validation.
std::vector<ScalarEvent> EventsOf(const TrainerState& state) {
  const std::size_t per_epoch = state.epochs.empty() ? 0 : state.steps.size() / state.epochs.size();
  std::vector<ScalarEvent> events;
  const auto add = [&](const char* kind, std::size_t step, const StageLosses& losses) {
    for (const LossColumn& column : LossColumnsOf(state.networks.family)) {
      const std::optional<double> value = losses.*(column.value);
      if (value && std::isfinite(*value))
        events.push_back({step, std::string(kind) + column.name, *value});
    }
  };
  for (std::size_t i = 0; i < state.steps.size(); ++i) add("train/", i + 1, state.steps[i]);
  for (std::size_t i = 0; i < state.epochs.size(); ++i)
    add("validation/", (i + 1) * per_epoch, state.epochs[i].validation);
  return events;
}

}  // namespace

std::vector<TrainingCurve> CurvesOf(const TrainerState& state) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<TrainingCurve> curves;
  for (const LossColumn& column : LossColumnsOf(state.networks.family)) {
    TrainingCurve& curve = curves.emplace_back();
    curve.name = column.name;
    for (std::size_t e = 0; e < state.epochs.size(); ++e) {
      curve.epoch.push_back(static_cast<double>(e + 1));
      curve.train.push_back((state.epochs[e].train.*(column.value)).value_or(kUnknown));
      curve.validation.push_back((state.epochs[e].validation.*(column.value)).value_or(kUnknown));
    }
  }
  return curves;
}

void WriteLosses(const std::filesystem::path& folder, const TrainerState& state,
                 const TrainingPace& pace) {
  CommitFile(folder / "losses.jsonl", LossLines(state, pace));
  CommitFile(folder / "events.out.tfevents.doorforge", TensorboardEvents(EventsOf(state)));
  WriteTrainingCurves(folder, CurvesOf(state));
}

}  // namespace doorforge
