// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/epoch_chart.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/html_text.h"
#include "doorforge/core/svg_plot.h"

namespace doorforge::page {
namespace {

double Largest(const EpochCurve& curve) {
  double largest = 0;
  for (const auto* values : {&curve.train, &curve.validation}) {
    for (const double value : *values) {
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  }
  return largest > 0 ? largest : 1;
}

double Smallest(const EpochCurve& curve) {
  double smallest = 0;
  for (const auto* values : {&curve.train, &curve.validation}) {
    for (const double value : *values) {
      if (std::isfinite(value)) smallest = std::min(smallest, value);
    }
  }
  return smallest;
}

// epochs are whole numbers, and so are their ticks
std::vector<PlotTick> EpochTicks(const EpochCurve& curve) {
  std::vector<PlotTick> ticks;
  for (const auto& [value, label] : RoundTicks(curve.epoch.front(), curve.epoch.back(), 5)) {
    if (value == std::floor(value)) ticks.emplace_back(value, Fixed(value, 0));
  }
  return ticks;
}

PlotPoints PointsOf(const std::vector<double>& x, const std::vector<double>& y) {
  PlotPoints points;
  for (std::size_t i = 0; i < x.size(); ++i) points.emplace_back(x[i], y[i]);
  return points;
}

std::string Dots(const SvgPlot& plot, const EpochCurve& curve, std::size_t i) {
  std::string dots;
  for (const auto& [values, name] :
       {std::pair(&curve.train, "training"), std::pair(&curve.validation, "validation")}) {
    const double value = (*values)[i];
    if (!std::isfinite(value)) continue;
    dots += Fill(
        R"(<circle class="dot {name}" cx="{x}" cy="{y}" r="2.6"><title>epoch {epoch}, {name}: {value}</title></circle>)",
        {{"name", name},
         {"x", Fixed(plot.X(curve.epoch[i]), 1)},
         {"y", Fixed(plot.Y(value), 1)},
         {"epoch", Fixed(curve.epoch[i], 0)},
         {"value", Fixed(value, 4)}});
  }
  return dots;
}

// The epoch whose networks are kept as the best.
std::string BestLine(const SvgPlot& plot, double epoch) {
  if (!(epoch > 0)) return {};
  return Fill(
      R"(<g><title>best epoch: {epoch}</title><line class="best" x1="{x}" x2="{x}" y1="{top}" y2="{bottom}"/></g>)",
      {{"epoch", Fixed(epoch, 0)},
       {"x", Fixed(plot.X(epoch), 1)},
       {"top", Fixed(plot.top, 1)},
       {"bottom", Fixed(plot.height - plot.bottom, 1)}});
}

}  // namespace

std::string EpochChart(const EpochCurve& curve) {
  if (curve.epoch.empty()) return {};
  SvgPlot plot;
  plot.width = 460;
  plot.height = 230;
  plot.x_range = {curve.epoch.front(), curve.epoch.back()};
  plot.y_range = {Smallest(curve), Largest(curve) * 1.05};
  std::string svg = HorizontalGrid(plot, RoundTicks(plot.y_range.first, plot.y_range.second, 4)) +
                    VerticalTicks(plot, EpochTicks(curve)) + AxisTitles(plot, "epoch", curve.unit);
  svg += BestLine(plot, curve.best_epoch);
  svg += Line(plot, PointsOf(curve.epoch, curve.train), "training");
  svg += Line(plot, PointsOf(curve.epoch, curve.validation), "validation");
  for (std::size_t i = 0; i < curve.epoch.size(); ++i) svg += Dots(plot, curve, i);
  return SvgElement(plot, "Loss " + curve.name + " over the epochs", svg);
}

}  // namespace doorforge::page
