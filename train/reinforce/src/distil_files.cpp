// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/distil_files.h"

#include <algorithm>
#include <array>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/safetensors.h"
#include "doorforge/training/event_log.h"

#include "curve_page.h"
#include "training_state.h"

namespace doorforge {
namespace {

constexpr const char* kDistilKind = "doorforge.dagger";

DaggerSamples SamplesOfRound(const internal::RoundSamples& round, int points) {
  const std::uint64_t count = round.Rows("own");
  const auto each = static_cast<std::uint64_t>(points);
  DaggerSamples samples{.points = points};
  samples.xyz = round.Values<float>("xyz", {count, each, 3});
  samples.label = round.Values<std::uint8_t>("label", {count, each});
  samples.own = round.Values<float>("own", {count, kSightOwn});
  samples.taught = round.Values<float>("taught", {count, kHandActions});
  return samples;
}

// Calls visit(name, vector) for all flat vectors.
template <class State, class Visit>
void VisitDistilVectors(State& state, const Visit& visit) {
  visit("student", state.network);
  visit("adam.first", state.first_moment);
  visit("adam.second", state.second_moment);
}

std::vector<ScalarEvent> DistilEvents(const DaggerState& state) {
  std::vector<ScalarEvent> events;
  for (const DaggerRound& round : state.rounds)
    for (const DaggerColumn& column : DaggerColumns().subspan(1))
      events.push_back({static_cast<std::uint64_t>(round.decisions),
                        "train/" + std::string(column.name), round.*column.value});
  return events;
}

struct DistilChart {
  const char* title;
  const char* axis;
  double DaggerRound::*value;
};
constexpr std::array<DistilChart, 4> kDistilCharts = {{
    {"Success of a round's episodes, whoever acted", "share", &DaggerRound::success},
    {"Decisions in which the teacher acted", "share", &DaggerRound::teacher},
    {"Error on a round's decisions before learning from them", "mean square", &DaggerRound::error},
    {"Loss over a round's steps", "mean square", &DaggerRound::loss},
}};

std::string DistilPage(const DaggerState& state, const DaggerConfig& config,
                       const PpoOrigin& origin) {
  const double done = state.rounds.empty() ? 0 : state.rounds.back().decisions;
  const std::size_t rounds = state.rounds.size();
  internal::CurvePage page{
      .name = "dagger",
      .method = "Cloning and DAgger onto the cloud",
      .is_done = std::cmp_greater_equal(rounds, config.rounds),
      .figures = {{std::to_string(rounds), "rounds done of " + std::to_string(config.rounds)},
                  {std::to_string(static_cast<std::uint64_t>(done)), "decisions labelled"}},
      .x_axis = "thousand decisions",
      .x_most = std::max(done, 1.0) / 1000,
      .charts = {}};
  for (const DistilChart& chart : kDistilCharts) {
    page.charts.push_back({chart.title, chart.axis, {}});
    for (const DaggerRound& round : state.rounds)
      page.charts.back().points.emplace_back(round.decisions / 1000, round.*chart.value);
  }
  return internal::TextOf(page, origin);
}

}  // namespace

std::string WriteDistilSamples(const std::filesystem::path& folder, std::uint64_t round,
                               const DaggerSamples& samples) {
  const std::uint64_t count = samples.size();
  const auto points = static_cast<std::uint64_t>(samples.points);
  TensorFile file;
  file.tensors["xyz"] = MakeTensor<float>(samples.xyz, {count, points, 3});
  file.tensors["label"] = MakeTensor<std::uint8_t>(samples.label, {count, points});
  file.tensors["own"] = MakeTensor<float>(samples.own, {count, kSightOwn});
  file.tensors["taught"] = MakeTensor<float>(samples.taught, {count, kHandActions});
  return internal::WriteRoundSamples(folder, round, file);
}

DaggerSamples ReadDistilSamples(const std::filesystem::path& folder, const DistilProgress& progress,
                                const DaggerTask& task, std::size_t buffer) {
  std::vector<DaggerSamples> newest;  // the last round first
  std::size_t found = 0;
  for (std::size_t round = progress.samples_sha256.size(); round > 0 && found < buffer; --round) {
    newest.push_back(SamplesOfRound(
        internal::ReadRoundSamples(folder, round - 1, progress.samples_sha256[round - 1]),
        task.points));
    found += newest.back().size();
  }
  DaggerSamples samples{.points = task.points};
  for (auto round = newest.rbegin(); round != newest.rend(); ++round) samples.Append(*round);
  samples.KeepLast(buffer);
  return samples;
}

void WriteDistilState(const std::filesystem::path& folder, const DistilProgress& progress,
                      const PpoOrigin& origin) {
  const DaggerState& state = progress.state;
  TensorFile file;
  VisitDistilVectors(state, [&](const std::string& name, const std::vector<float>& values) {
    file.tensors[name] = MakeTensor<float>(values, {values.size()});
  });
  file.tensors["rounds"] =
      MakeTensor<double>(internal::NumbersOfRows(state.rounds, DaggerColumns()),
                         {state.rounds.size(), DaggerColumns().size()});
  file.tensors["gradient_steps"] = MakeTensor<std::int64_t>(
      std::vector<std::int64_t>{static_cast<std::int64_t>(state.gradient_steps)}, {1});
  internal::NoteSamples(progress.samples_sha256, file);
  internal::WriteTrainingState(folder, kDistilKind, origin, std::move(file));
}

DistilProgress ReadDistilState(const std::filesystem::path& folder, const PpoOrigin& expected,
                               DaggerState initial) {
  const std::string path = (folder / internal::kTrainingState).string();
  const TensorFile file = internal::ReadTrainingState(folder, kDistilKind, expected);
  DistilProgress progress{std::move(initial), {}};
  DaggerState& state = progress.state;
  VisitDistilVectors(state, [&](const std::string& name, std::vector<float>& values) {
    values = ValuesOf<float>(TensorNamed(file, name, path), {values.size()}, path);
  });
  state.rounds =
      internal::RowsOfTensor<DaggerRound>(TensorNamed(file, "rounds", path), DaggerColumns(), path);
  state.gradient_steps = static_cast<std::uint64_t>(
      ValuesOf<std::int64_t>(TensorNamed(file, "gradient_steps", path), {1}, path)[0]);
  progress.samples_sha256 = internal::NotedSamples(file, state.rounds.size(), path);
  return progress;
}

void WriteDistilCurves(const std::filesystem::path& folder, const DaggerState& state,
                       const DaggerConfig& config, const PpoOrigin& origin) {
  CommitFile(folder / "losses.jsonl",
             internal::LinesOfRows(state.rounds, DaggerColumns(), "round"));
  CommitFile(folder / "events.out.tfevents.doorforge", TensorboardEvents(DistilEvents(state)));
  CommitFile(folder / "training.html", DistilPage(state, config, origin));
}

}  // namespace doorforge
