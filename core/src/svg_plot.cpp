// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/svg_plot.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/html_text.h"

namespace doorforge::page {
namespace {

double Along(double value, std::pair<double, double> range) {
  const double width = range.second - range.first;
  return width > 0 ? (value - range.first) / width : 0.5;
}

}  // namespace

double SvgPlot::X(double value) const {
  return left + Along(value, x_range) * (width - left - right);
}

double SvgPlot::Y(double value) const {
  return height - bottom - Along(value, y_range) * (height - top - bottom);
}

std::string HorizontalGrid(const SvgPlot& plot, const std::vector<PlotTick>& ticks) {
  std::string svg;
  for (const auto& [value, label] : ticks) {
    svg +=
        Fill(R"(<line class="grid" x1="{x1}" x2="{x2}" y1="{y}" y2="{y}"/>)"
             R"(<text class="tick" x="{tx}" y="{y}" dy="0.32em" text-anchor="end">{label}</text>)",
             {{"x1", Fixed(plot.left, 1)},
              {"x2", Fixed(plot.width - plot.right, 1)},
              {"y", Fixed(plot.Y(value), 1)},
              {"tx", Fixed(plot.left - 8, 1)},
              {"label", Escape(label)}});
  }
  return svg;
}

std::string VerticalTicks(const SvgPlot& plot, const std::vector<PlotTick>& ticks) {
  std::string svg;
  for (const auto& [value, label] : ticks) {
    svg += Fill(R"(<text class="tick" x="{x}" y="{y}" text-anchor="middle">{label}</text>)",
                {{"x", Fixed(plot.X(value), 1)},
                 {"y", Fixed(plot.height - plot.bottom + 17, 1)},
                 {"label", Escape(label)}});
  }
  return svg;
}

std::string AxisTitles(const SvgPlot& plot, const std::string& x, const std::string& y) {
  return Fill(
      R"(<text class="axis" x="{x}" y="{bottom}" text-anchor="middle">{x_title}</text>)"
      R"svg(<text class="axis" transform="rotate(-90)" x="{y}" y="12" text-anchor="middle">{y_title}</text>)svg",
      {{"x", Fixed((plot.left + plot.width - plot.right) / 2, 1)},
       {"bottom", Fixed(plot.height - 6, 1)},
       {"y", Fixed(-(plot.top + plot.height - plot.bottom) / 2, 1)},
       {"x_title", Escape(x)},
       {"y_title", Escape(y)}});
}

std::string Line(const SvgPlot& plot, const PlotPoints& points, const std::string& css_class) {
  std::string path;
  bool pen_down = false;
  for (const auto& [x, y] : points) {
    if (std::isfinite(y)) {
      path += pen_down ? 'L' : 'M';
      path += Fixed(plot.X(x), 1) + " " + Fixed(plot.Y(y), 1);
    }
    pen_down = std::isfinite(y);
  }
  return Fill(R"(<path class="line {class}" d="{path}"/>)", {{"class", css_class}, {"path", path}});
}

std::vector<PlotTick> RoundTicks(double low, double high, int count) {
  if (!(high > low)) return {{low, Fixed(low, 2)}};
  const double rough = (high - low) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  const double step = power * (ratio < 1.5 ? 1 : ratio < 3 ? 2 : ratio < 7 ? 5 : 10);
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  std::vector<PlotTick> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9); ++k)
    ticks.emplace_back(k * step + 0.0, Fixed(k * step + 0.0, digits));  // no "-0"
  return ticks;
}

std::string SvgElement(const SvgPlot& plot, const std::string& description,
                       const std::string& content) {
  return Fill(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-label="{label}">{content}</svg>)",
      {{"width", Fixed(plot.width, 0)},
       {"height", Fixed(plot.height, 0)},
       {"label", Escape(description)},
       {"content", content}});
}

}  // namespace doorforge::page
