// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/page_style.h"
#include "doorforge/core/svg_plot.h"
#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/training/event_log.h"

namespace doorforge {
namespace {

using page::Escape;
using page::Fill;

// A line an update.
std::string PpoLines(const PpoState& state) {
  std::string text;
  for (std::size_t i = 0; i < state.updates.size(); ++i) {
    text += "{\"update\": " + std::to_string(i + 1);
    for (const PpoColumn& column : PpoColumns()) {
      char number[64];
      std::snprintf(number, sizeof number, "\": %.9g", state.updates[i].*column.value);
      text.append(", \"").append(column.name).append(number);
    }
    text += "}\n";
  }
  return text;
}

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

std::string PpoFigure(const PpoChart& chart, const PpoState& state, double most) {
  page::PlotPoints points;
  double low = 0;
  double high = 0;
  for (const PpoUpdate& update : state.updates) {
    points.emplace_back(update.decisions / 1000, update.*chart.value);
    low = std::min(low, update.*chart.value);
    high = std::max(high, update.*chart.value);
  }
  page::SvgPlot plot;
  plot.width = 460;
  plot.height = 230;
  plot.x_range = {0, most / 1000};
  plot.y_range = {low, high > low ? high : low + 1};
  const std::string svg =
      page::HorizontalGrid(plot, page::RoundTicks(low, plot.y_range.second, 4)) +
      page::VerticalTicks(plot, page::RoundTicks(0, plot.x_range.second, 5)) +
      page::AxisTitles(plot, "thousand decisions", chart.axis) +
      page::Line(plot, points, "training");
  return Fill(
      R"(<figure class="card"><h3>{title}</h3>{chart}</figure>)",
      {{"title", Escape(chart.title)}, {"chart", page::SvgElement(plot, chart.title, svg)}});
}

std::string PpoSettings(const PpoOrigin& origin) {
  std::string entries = "<dt>doors</dt><dd>sha256 " + Escape(origin.doors_sha256) + "</dd>";
  const nlohmann::ordered_json config = ParseJson(origin.config, "config");
  for (const auto& [section, settings] : config.items())
    entries += "<dt>" + Escape(section) + "</dt><dd>" + Escape(JsonText(settings)) + "</dd>";
  return "<section><h2>Settings</h2><dl>" + entries + "</dl></section>";
}

}  // namespace

void WritePpoCurves(const std::filesystem::path& folder, const PpoState& state) {
  CommitFile(folder / "losses.jsonl", PpoLines(state));
  CommitFile(folder / "events.out.tfevents.doorforge", TensorboardEvents(PpoEvents(state)));
}

std::string PpoPage(const PpoState& state, const PpoConfig& config, const PpoOrigin& origin) {
  const bool is_done = state.updates.size() >= PpoUpdatesOf(config);
  const double done = state.updates.empty() ? 0 : state.updates.back().decisions;
  std::string figures;
  for (const PpoChart& chart : kPpoCharts)
    figures += PpoFigure(chart, state, std::max(static_cast<double>(config.decisions), done));
  return Fill(
      R"(<!DOCTYPE html>
<html lang="en" xmlns="http://www.w3.org/1999/xhtml">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'"/>
{refresh}<title>doorforge training: ppo</title>
<style>{style}</style>
</head>
<body>
<header>
<p class="over">doorforge training</p>
<h1>PPO from states: {headline}</h1>
<div class="figures"><div class="figure"><b>{updates}</b><span>updates done of {all}</span></div><div class="figure"><b>{decisions}</b><span>decisions of all steppers</span></div></div>
</header>
<main>
<section><h2>Curves</h2><div class="two">{figures}</div></section>
{settings}
</main>
<footer>The same numbers for programs: losses.jsonl beside this page.</footer>
</body>
</html>
)",
      {{"refresh", is_done ? "" : "<meta http-equiv=\"refresh\" content=\"30\"/>\n"},
       {"style", std::string(page::kPageStyle)},
       {"headline", is_done ? "trained" : "not at its end yet"},
       {"updates", std::to_string(state.updates.size())},
       {"all", std::to_string(PpoUpdatesOf(config))},
       {"decisions", std::to_string(static_cast<std::uint64_t>(done))},
       {"figures", figures},
       {"settings", PpoSettings(origin)}});
}

}  // namespace doorforge
