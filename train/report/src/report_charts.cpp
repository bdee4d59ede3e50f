// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "report_charts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "doorforge/core/epoch_chart.h"
#include "doorforge/core/svg_plot.h"
#include "doorforge/report/html_numbers.h"

namespace doorforge::internal {
namespace {

using Episodes = std::span<const EvaluatedEpisode>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLastAngle = 90 * kDegree;
constexpr double kBarWidth = 300;  // of 308 units

// share of episodes whose peak is larger than x, as the corners of a falling staircase
PlotPoints Staircase(Episodes episodes) {
  std::vector<double> peaks;
  for (const EvaluatedEpisode& episode : episodes)
    peaks.push_back(std::clamp(episode.peak_hinge_rad, 0.0, kLastAngle));
  std::sort(peaks.begin(), peaks.end());
  PlotPoints corners = {{0, 1}};
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const auto n = static_cast<double>(peaks.size());
    corners.emplace_back(peaks[i], corners.back().second);
    corners.emplace_back(peaks[i], 1 - static_cast<double>(i + 1) / n);
  }
  corners.emplace_back(kLastAngle, corners.back().second);
  return corners;
}

std::string ThresholdLine(const SvgPlot& plot, double angle_rad) {
  return Fill(R"(<line class="threshold" x1="{x}" x2="{x}" y1="{top}" y2="{bottom}"/>)",
              {{"x", Fixed(plot.X(angle_rad), 1)},
               {"top", Fixed(plot.top, 1)},
               {"bottom", Fixed(plot.height - plot.bottom, 1)}});
}

std::string ThresholdMark(const SvgPlot& plot, const AngleSuccess& angle) {
  return Fill(
      R"(<g><title>beyond {angle}: {rate} ({interval}), {count} of {episodes} episodes</title>)"
      R"(<line class="whisker" x1="{x}" x2="{x}" y1="{low}" y2="{high}"/>)"
      R"(<circle class="mark" cx="{x}" cy="{y}" r="4.5"/></g>)",
      {{"angle", Degrees(angle.angle_rad)},
       {"rate", Percent(angle.success.rate)},
       {"interval", IntervalText(angle.success)},
       {"count", std::to_string(angle.success.successes)},
       {"episodes", std::to_string(angle.success.episodes)},
       {"x", Fixed(plot.X(angle.angle_rad), 1)},
       {"y", Fixed(plot.Y(angle.success.rate), 1)},
       {"low", Fixed(plot.Y(angle.success.low), 1)},
       {"high", Fixed(plot.Y(angle.success.high), 1)}});
}

}  // namespace

std::string RateBar(const SuccessRate& rate, const SuccessRate& reference) {
  const auto x = [](double share) { return Fixed(4 + share * kBarWidth, 1); };
  std::string mark;
  if (reference.episodes > 0) {
    mark =
        Fill(R"(<path class="reference" d="M{x} 3l5 5l-5 5l-5 -5z"/>)", {{"x", x(reference.rate)}});
  }
  return Fill(
      R"(<svg class="bar" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 308 32" role="img" aria-label="{rate}, interval {interval}">)"
      R"(<title>{rate}, 95 % interval {interval}</title>)"
      R"(<rect class="track" x="4" y="13" width="300" height="12" rx="2"/>)"
      R"(<rect class="fill" x="4" y="13" width="{width}" height="12" rx="2"/>)"
      R"(<path class="whisker" d="M{low} 19H{high}M{low} 15v8M{high} 15v8"/>{mark}</svg>)",
      {{"rate", Percent(rate.rate)},
       {"interval", IntervalText(rate)},
       {"width", Fixed(rate.rate * kBarWidth, 1)},
       {"low", x(rate.low)},
       {"high", x(rate.high)},
       {"mark", mark}});
}

std::string AngleChart(Episodes episodes, Episodes reference) {
  SvgPlot plot;
  plot.x_range = {0, kLastAngle};
  std::vector<PlotTick> shares;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) shares.emplace_back(share, Percent(share));
  std::vector<PlotTick> angles;
  for (const double angle : {0.0, 0.1 / kDegree, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0})
    angles.emplace_back(angle * kDegree, Fixed(angle, 0) + "°");
  std::string svg = HorizontalGrid(plot, shares) + VerticalTicks(plot, angles) +
                    AxisTitles(plot, "door angle", "episodes that passed it");
  for (const double angle : kSuccessAngles) svg += ThresholdLine(plot, angle);
  if (!reference.empty()) svg += Line(plot, Staircase(reference), "reference");
  svg += Line(plot, Staircase(episodes), "policy");
  for (const AngleSuccess& angle : Summarise(episodes).over_angle)
    svg += ThresholdMark(plot, angle);
  return SvgElement(plot, "Share of episodes whose door passed an angle", svg);
}

std::string LossChart(const LossCurve& loss) {
  return EpochChart({loss.name, loss.unit, loss.epoch, loss.train, loss.validation});
}

}  // namespace doorforge::internal
