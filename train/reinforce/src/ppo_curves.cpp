// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "doorforge/core/committed_file.h"
#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/training/event_log.h"

#include "curve_page.h"

namespace doorforge {
namespace {

std::vector<ScalarEvent> PpoEvents(const PpoState& state) {
  std::vector<ScalarEvent> events;
  for (const PpoUpdate& update : state.updates)
    for (const PpoColumn& column : PpoColumns().subspan(1))
      events.push_back({static_cast<std::uint64_t>(update.decisions),
                        "train/" + std::string(column.name), update.*column.value});
  return events;
}

struct PpoChart {
  const char* title;
  const char* axis;
  double PpoUpdate::*value;
};
constexpr std::array<PpoChart, 6> kPpoCharts = {{
    {"Success: the door is open by the preset's rule", "share", &PpoUpdate::success},
    {"Reward of an episode", "sum", &PpoUpdate::reward},
    {"Value: half the squared error", "loss", &PpoUpdate::value_loss},
    {"Entropy of the policy", "nat", &PpoUpdate::entropy},
    {"How far an update moved the policy", "nat", &PpoUpdate::kl},
    {"Ratios beyond the clip", "share", &PpoUpdate::clipped},
}};

}  // namespace

void WritePpoCurves(const std::filesystem::path& folder, const PpoState& state) {
  CommitFile(folder / "losses.jsonl", internal::LinesOfRows(state.updates, PpoColumns(), "update"));
  CommitFile(folder / "events.out.tfevents.doorforge", TensorboardEvents(PpoEvents(state)));
}

std::string PpoPage(const PpoState& state, const PpoConfig& config, const PpoOrigin& origin) {
  const double done = state.updates.empty() ? 0 : state.updates.back().decisions;
  internal::CurvePage page{
      .name = "ppo",
      .method = "PPO from states",
      .is_done = state.updates.size() >= PpoUpdatesOf(config),
      .figures = {{std::to_string(state.updates.size()),
                   "updates done of " + std::to_string(PpoUpdatesOf(config))},
                  {std::to_string(static_cast<std::uint64_t>(done)), "decisions of all steppers"}},
      .x_axis = "thousand decisions",
      .x_most = std::max(static_cast<double>(config.decisions), done) / 1000,
      .charts = {}};
  for (const PpoChart& chart : kPpoCharts) {
    page.charts.push_back({chart.title, chart.axis, {}});
    for (const PpoUpdate& update : state.updates)
      page.charts.back().points.emplace_back(update.decisions / 1000, update.*chart.value);
  }
  return internal::TextOf(page, origin);
}

}  // namespace doorforge
