// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/trajectory_files.h"

#include <algorithm>
#include <array>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/schemas/safetensors.h"
#include "doorforge/training/event_log.h"

#include "curve_page.h"
#include "training_state.h"

namespace doorforge {
namespace {

constexpr const char* kTrajectoryKind = "doorforge.trajectories";

struct LearnedName {
  const char* name;
  LearnedVector TrajectoryState::*vector;
};
constexpr std::array<LearnedName, 3> kLearned = {{{"proposer", &TrajectoryState::proposer},
                                                  {"critic", &TrajectoryState::critic},
                                                  {"affordance", &TrajectoryState::affordance}}};

// Calls visit(name, vector) for all flat vectors of one that is learned.
template <class Vector, class Visit>
void VisitLearned(const std::string& name, Vector& vector, const Visit& visit) {
  visit(name, vector.parameters);
  visit("adam.first." + name, vector.first_moment);
  visit("adam.second." + name, vector.second_moment);
}

struct TrajectoryChart {
  const char* title;
  const char* axis;
  double TrajectoryRound::*value;
};
constexpr std::array<TrajectoryChart, 5> kTrajectoryCharts = {{
    {"Success of a round's episodes; of the first by rules", "share", &TrajectoryRound::success},
    {"Proposer, over a round's steps", "loss", &TrajectoryRound::proposer},
    {"Critic, over a round's steps", "cross entropy", &TrajectoryRound::critic},
    {"Affordance, over a round's steps", "cross entropy", &TrajectoryRound::affordance},
    {"What the critic makes of the best proposals", "probability", &TrajectoryRound::probability},
}};

std::string TrajectoryPage(const TrajectoryState& state, const TrajectoryLearning& config,
                           const PpoOrigin& origin) {
  const double done = state.rounds.empty() ? 0 : state.rounds.back().episodes;
  const std::size_t rounds = state.rounds.size();
  internal::CurvePage page{
      .name = "trajectories",
      .method = "Whole trajectories from a cloud",
      .is_done = std::cmp_greater_equal(rounds, config.rounds),
      .figures = {{std::to_string(rounds), "rounds done of " + std::to_string(config.rounds)},
                  {std::to_string(static_cast<std::uint64_t>(done)), "episodes"}},
      .x_axis = "thousand episodes",
      .x_most = std::max(done, 1.0) / 1000,
      .charts = {}};
  for (const TrajectoryChart& chart : kTrajectoryCharts) {
    page.charts.push_back({chart.title, chart.axis, {}});
    for (const TrajectoryRound& round : state.rounds)
      page.charts.back().points.emplace_back(round.episodes / 1000, round.*chart.value);
  }
  return internal::TextOf(page, origin);
}

}  // namespace

std::string WriteTrajectorySamples(const std::filesystem::path& folder, std::uint64_t round,
                                   const TrajectorySamples& samples) {
  const std::uint64_t count = samples.size();
  const auto points = static_cast<std::uint64_t>(samples.points);
  const auto numbers = static_cast<std::uint64_t>(samples.numbers);
  TensorFile file;
  file.tensors["xyz"] = MakeTensor<float>(samples.xyz, {count, points, 3});
  file.tensors["label"] = MakeTensor<std::uint8_t>(samples.label, {count, points});
  file.tensors["contact_m"] = MakeTensor<float>(samples.contact_m, {count, 3});
  file.tensors["trajectory"] = MakeTensor<float>(samples.trajectory, {count, numbers});
  file.tensors["opening_rad"] = MakeTensor<float>(samples.opening_rad, {count});
  return internal::WriteRoundSamples(folder, round, file);
}

TrajectorySamples ReadTrajectorySamples(const std::filesystem::path& folder,
                                        const TrajectoryProgress& progress,
                                        TrajectorySamples empty) {
  const auto points = static_cast<std::uint64_t>(empty.points);
  const auto numbers = static_cast<std::uint64_t>(empty.numbers);
  TrajectorySamples all = std::move(empty);
  for (std::size_t i = 0; i < progress.samples_sha256.size(); ++i) {
    const auto round = internal::ReadRoundSamples(folder, i, progress.samples_sha256[i]);
    const std::uint64_t count = round.Rows("opening_rad");
    TrajectorySamples samples{.points = all.points, .numbers = all.numbers};
    samples.xyz = round.Values<float>("xyz", {count, points, 3});
    samples.label = round.Values<std::uint8_t>("label", {count, points});
    samples.contact_m = round.Values<float>("contact_m", {count, 3});
    samples.trajectory = round.Values<float>("trajectory", {count, numbers});
    samples.opening_rad = round.Values<float>("opening_rad", {count});
    all.Append(samples);
  }
  return all;
}

void WriteTrajectoryState(const std::filesystem::path& folder, const TrajectoryProgress& progress,
                          const PpoOrigin& origin) {
  const TrajectoryState& state = progress.state;
  TensorFile file;
  std::vector<std::int64_t> steps;
  for (const LearnedName& learned : kLearned) {
    const LearnedVector& vector = state.*learned.vector;
    VisitLearned(learned.name, vector,
                 [&](const std::string& name, const std::vector<float>& values) {
                   file.tensors[name] = MakeTensor<float>(values, {values.size()});
                 });
    steps.push_back(static_cast<std::int64_t>(vector.steps));
  }
  file.tensors["rounds"] =
      MakeTensor<double>(internal::NumbersOfRows(state.rounds, TrajectoryColumns()),
                         {state.rounds.size(), TrajectoryColumns().size()});
  file.tensors["gradient_steps"] = MakeTensor<std::int64_t>(steps, {steps.size()});
  internal::NoteSamples(progress.samples_sha256, file);
  internal::WriteTrainingState(folder, kTrajectoryKind, origin, std::move(file));
}

TrajectoryProgress ReadTrajectoryState(const std::filesystem::path& folder,
                                       const PpoOrigin& expected, TrajectoryState initial) {
  const std::string path = (folder / internal::kTrainingState).string();
  const TensorFile file = internal::ReadTrainingState(folder, kTrajectoryKind, expected);
  TrajectoryProgress progress{std::move(initial), {}};
  TrajectoryState& state = progress.state;
  const auto steps =
      ValuesOf<std::int64_t>(TensorNamed(file, "gradient_steps", path), {kLearned.size()}, path);
  for (std::size_t i = 0; i < kLearned.size(); ++i) {
    LearnedVector& vector = state.*kLearned.at(i).vector;
    VisitLearned(kLearned.at(i).name, vector,
                 [&](const std::string& name, std::vector<float>& values) {
                   values = ValuesOf<float>(TensorNamed(file, name, path), {values.size()}, path);
                 });
    vector.steps = static_cast<std::uint64_t>(steps[i]);
  }
  state.rounds = internal::RowsOfTensor<TrajectoryRound>(TensorNamed(file, "rounds", path),
                                                         TrajectoryColumns(), path);
  progress.samples_sha256 = internal::NotedSamples(file, state.rounds.size(), path);
  return progress;
}

void WriteTrajectoryCurves(const std::filesystem::path& folder, const TrajectoryState& state,
                           const TrajectoryLearning& config, const PpoOrigin& origin) {
  CommitFile(folder / "losses.jsonl",
             internal::LinesOfRows(state.rounds, TrajectoryColumns(), "round"));
  std::vector<ScalarEvent> events;
  for (const TrajectoryRound& round : state.rounds)
    for (const TrajectoryColumn& column : TrajectoryColumns().subspan(1))
      events.push_back({static_cast<std::uint64_t>(round.episodes),
                        "train/" + std::string(column.name), round.*column.value});
  CommitFile(folder / "events.out.tfevents.doorforge", TensorboardEvents(events));
  CommitFile(folder / "training.html", TrajectoryPage(state, config, origin));
}

}  // namespace doorforge
