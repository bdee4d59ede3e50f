// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

// Line charts as SVG. Colours and fonts come from the page's style sheet by class.

namespace doorforge::page {

using PlotPoints = std::vector<std::pair<double, double>>;

/// Maps values to pixels and draws the frame around the curves.
struct SvgPlot {
  double width = 720;
  double height = 320;
  double left = 68;
  double right = 16;
  double top = 14;
  double bottom = 44;
  std::pair<double, double> x_range{0, 1};
  std::pair<double, double> y_range{0, 1};

  double X(double value) const;
  double Y(double value) const;
};

/// A tick and its label.
using PlotTick = std::pair<double, std::string>;

/// Grid lines with their labels, and the titles of both axes.
std::string HorizontalGrid(const SvgPlot& plot, const std::vector<PlotTick>& ticks);
std::string VerticalTicks(const SvgPlot& plot, const std::vector<PlotTick>& ticks);
std::string AxisTitles(const SvgPlot& plot, const std::string& x, const std::string& y);

/// A line through the points; those with a y that is not finite interrupt it.
std::string Line(const SvgPlot& plot, const PlotPoints& points, const std::string& css_class);

/// About `count` round numbers that cover [low, high], with labels.
std::vector<PlotTick> RoundTicks(double low, double high, int count);

/// The <svg> around `content`; `description` is read out to those who cannot see the chart.
std::string SvgElement(const SvgPlot& plot, const std::string& description,
                       const std::string& content);

}  // namespace doorforge::page
