// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/training_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "doorforge/core/config_io.h"
#include "doorforge/core/epoch_chart.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/page_style.h"
#include "doorforge/core/svg_plot.h"

namespace doorforge {
namespace {

using page::Escape;
using page::Fill;
using page::Fixed;

// A loss as people think of it.
struct ShownLoss {
  std::string_view name;  // of LossColumn
  const char* title;
  const char* unit;
  double factor;
};
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::array<ShownLoss, 8> kShown = {{
    {"actor.position_m", "Actor: hand position, mean L1", "mm", 1000},
    {"actor.rotation_rad", "Actor: hand rotation, geodesic angle", "deg", kDegrees},
    {"actor.divergence", "Actor: divergence from N(0, I)", "nat", 1},
    {"critic.score_rad", "Critic: angle gained, mean L1", "deg", kDegrees},
    {"discriminator.score_rad", "Discriminator: the door's angle, mean L1", "deg", kDegrees},
    {"affordance.score_rad", "Affordance: the best ratings, mean L1", "deg", kDegrees},
    {"mask.cross_entropy", "Mask: cross entropy of a point", "nat", 1},
    {"place.cross_entropy", "Place: cross entropy of a point", "nat", 1},
}};

ShownLoss ShownAs(const std::string& name) {
  for (const ShownLoss& shown : kShown)
    if (shown.name == name) return shown;
  return {name, name.c_str(), "", 1};
}

// The epoch of which the loss's network is kept as the best, or 0.
int BestEpochOf(const std::string& loss, const TrainerState& state) {
  const NetworkNames names = NamesOf(state.networks.family);
  return loss.starts_with(std::string(names.actor) + ".") ? state.best.epochs.actor
                                                          : state.best.epochs.critic;
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

std::string LossFigure(const TrainingCurve& curve, const TrainerState& state) {
  const ShownLoss shown = ShownAs(curve.name);
  const std::string chart =
      page::EpochChart({shown.title, shown.unit, curve.epoch, Scaled(curve.train, shown.factor),
                        Scaled(curve.validation, shown.factor),
                        static_cast<double>(BestEpochOf(curve.name, state))});
  return Fill(R"(<figure class="card"><h3>{title}</h3>{chart}</figure>)",
              {{"title", Escape(shown.title)}, {"chart", chart}});
}

// Over the whole run, with the part that is done drawn through and the rest dashed.
std::string RateFigure(const TrainerState& state, const TrainingPace& pace) {
  constexpr std::uint64_t kMostPoints = 400;
  const auto per_epoch = static_cast<double>(pace.steps_per_epoch);
  const std::uint64_t total =
      pace.steps_per_epoch * static_cast<std::uint64_t>(EpochsOf(pace.config));
  const std::uint64_t stride = std::max<std::uint64_t>(1, total / kMostPoints);
  page::PlotPoints done;
  page::PlotPoints to_come;
  double largest = 0;
  for (std::uint64_t step = 0; step < total; step += stride) {
    const double rate = LearningRateAt(pace.config, {step, pace.steps_per_epoch});
    largest = std::max(largest, rate);
    (step < state.step ? done : to_come).emplace_back(static_cast<double>(step) / per_epoch, rate);
  }
  page::SvgPlot plot;
  plot.width = 460;
  plot.height = 230;
  plot.left = 80;  // rates have many digits
  plot.x_range = {0, static_cast<double>(EpochsOf(pace.config))};
  plot.y_range = {0, largest > 0 ? largest * 1.05 : 1};
  const std::string svg = page::HorizontalGrid(plot, page::RoundTicks(0, plot.y_range.second, 4)) +
                          page::VerticalTicks(plot, page::RoundTicks(0, plot.x_range.second, 5)) +
                          page::AxisTitles(plot, "epochs done", "learning rate") +
                          page::Line(plot, to_come, "validation") +
                          page::Line(plot, done, "training");
  return Fill(
      R"(<figure class="card"><h3>Learning rate</h3>{chart}<figcaption>Solid: so far; dashed: still to come.</figcaption></figure>)",
      {{"chart", page::SvgElement(plot, "Learning rate over the epochs", svg)}});
}

std::string Number(double value) { return std::isfinite(value) ? Fixed(value, 3) : "–"; }

std::string TableRow(std::size_t row, const std::vector<TrainingCurve>& curves,
                     const TrainerState& state) {
  std::string cells;
  for (const TrainingCurve& curve : curves) {
    const double factor = ShownAs(curve.name).factor;
    const bool is_best = BestEpochOf(curve.name, state) == static_cast<int>(row) + 1;
    cells +=
        Fill(R"(<td class="number">{train}</td><td class="number">{open}{validation}{close}</td>)",
             {{"train", Number(factor * curve.train[row])},
              {"validation", Number(factor * curve.validation[row])},
              {"open", is_best ? "<b>" : ""},
              {"close", is_best ? "</b>" : ""}});
  }
  return "<tr><td>" + std::to_string(row + 1) + "</td>" + cells + "</tr>";
}

// "actor.position" of "actor.position_m", which is not shown in metres.
std::string NameWithoutUnit(const std::string& name) { return name.substr(0, name.rfind('_')); }

std::string EpochTable(const std::vector<TrainingCurve>& curves, const TrainerState& state) {
  std::string titles;
  std::string sides;
  for (const TrainingCurve& curve : curves) {
    const ShownLoss shown = ShownAs(curve.name);
    titles += Fill(R"(<th class="number" colspan="2">{title} [{unit}]</th>)",
                   {{"title", Escape(NameWithoutUnit(curve.name))}, {"unit", shown.unit}});
    sides += R"(<th class="number">training</th><th class="number">validation</th>)";
  }
  std::string rows;
  for (std::size_t row = 0; row < state.epochs.size(); ++row) rows += TableRow(row, curves, state);
  return Fill(
      R"(<section><h2>Every epoch</h2><div class="scroll"><table><thead><tr><th></th>{titles}</tr><tr><th>epoch</th>{sides}</tr></thead><tbody>{rows}</tbody></table></div></section>)",
      {{"titles", titles}, {"sides", sides}, {"rows", rows}});
}

std::string Charts(const std::vector<TrainingCurve>& curves, const TrainerState& state,
                   const TrainingRun& run) {
  std::string figures;
  if (!state.epochs.empty())
    for (const TrainingCurve& curve : curves) figures += LossFigure(curve, state);
  const std::string first =
      state.epochs.empty() ? "<p>No epoch is done yet; the curves begin with the first.</p>" : "";
  return Fill(
      R"(<section><h2>Losses</h2>{first}<div class="legend"><span><svg viewBox="0 0 34 12"><path class="line training" d="M1 6H33"/></svg>training</span>)"
      R"(<span><svg viewBox="0 0 34 12"><path class="line validation" d="M1 6H33"/></svg>validation</span>)"
      R"(<span><svg viewBox="0 0 34 12"><path class="best" d="M17 0V12"/></svg>best epoch of the network, as in the folder best</span></div><div class="two">{figures}{rate}</div></section>)",
      {{"first", first}, {"figures", figures}, {"rate", RateFigure(state, run.pace)}});
}

std::string Entry(const std::string& name, const std::string& value) {
  return "<dt>" + Escape(name) + "</dt><dd>" + Escape(value) + "</dd>";
}

std::string Settings(const TrainingRun& run) {
  const PolicyProvenance& provenance = run.provenance;
  std::string entries = Entry("data", "sha256 " + provenance.dataset_sha256);
  if (!provenance.from_weights_sha256.empty())
    entries += Entry("began with", "weights of sha256 " + provenance.from_weights_sha256);
  const nlohmann::ordered_json config = ToJson(provenance.config);
  for (const auto& [key, value] : config.items())
    entries += Entry(key, value.is_string() ? value.get<std::string>() : JsonText(value));
  return "<section><h2>Settings</h2><dl>" + entries + "</dl></section>";
}

std::string Figure(const std::string& value, const std::string& meaning) {
  return Fill(R"(<div class="figure"><b>{value}</b><span>{meaning}</span></div>)",
              {{"value", Escape(value)}, {"meaning", Escape(meaning)}});
}

// How far it is, in large figures.
std::string Figures(const TrainerState& state, const TrainingRun& run) {
  const NetworkNames names = NamesOf(state.networks.family);
  std::string figures =
      Figure(
          std::to_string(state.epochs.size()) + " of " + std::to_string(EpochsOf(run.pace.config)),
          "epochs done") +
      Figure(std::to_string(state.step),
             "steps, " + std::to_string(run.pace.steps_per_epoch) + " an epoch") +
      Figure(std::to_string(run.train_samples),
             "samples for training, " + std::to_string(run.validation_samples) + " for validation");
  for (const auto& [name, epoch] : {std::pair(names.actor, state.best.epochs.actor),
                                    std::pair(names.critic, state.best.epochs.critic)})
    if (epoch > 0) figures += Figure(std::to_string(epoch), "best epoch, " + std::string(name));
  return figures;
}

}  // namespace

std::string TrainingPage(const TrainerState& state, const TrainingRun& run) {
  const bool is_done = state.epochs.size() >= static_cast<std::size_t>(EpochsOf(run.pace.config));
  const std::vector<TrainingCurve> curves = CurvesOf(state);
  // the policy keeps even a faulty page from asking the network for anything
  return Fill(
      R"(<!DOCTYPE html>
<html lang="en" xmlns="http://www.w3.org/1999/xhtml">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'"/>
{refresh}<title>doorforge training: {stage}</title>
<style>{style}</style>
</head>
<body>
<header>
<p class="over">doorforge training</p>
<h1>Stage {stage}: {headline}</h1>
<div class="figures">{figures}</div>
</header>
<main>
{charts}
{table}
{settings}
</main>
<footer>Made by doorforge {version}. The same numbers for programs: losses.json and losses.jsonl beside this page.</footer>
</body>
</html>
)",
      {{"refresh", is_done ? "" : "<meta http-equiv=\"refresh\" content=\"30\"/>\n"},
       {"stage", Escape(run.provenance.stage)},
       {"style", std::string(page::kPageStyle)},
       {"headline", is_done ? "trained" : "not at its end yet"},
       {"figures", Figures(state, run)},
       {"charts", Charts(curves, state, run)},
       {"table", state.epochs.empty() ? "" : EpochTable(curves, state)},
       {"settings", Settings(run)},
       {"version", Escape(run.provenance.code_version)}});
}

}  // namespace doorforge
