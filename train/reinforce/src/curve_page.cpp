// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "curve_page.h"

#include <algorithm>

#include "doorforge/core/config_io.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/page_style.h"

namespace doorforge::internal {
namespace {

using page::Escape;
using page::Fill;

std::string FigureOf(const CurveChart& chart, const CurvePage& of) {
  double low = 0;
  double high = 0;
  for (const auto& [x, y] : chart.points) {
    low = std::min(low, y);
    high = std::max(high, y);
  }
  page::SvgPlot plot;
  plot.width = 460;
  plot.height = 230;
  plot.x_range = {0, of.x_most};
  plot.y_range = {low, high > low ? high : low + 1};
  const std::string svg =
      page::HorizontalGrid(plot, page::RoundTicks(low, plot.y_range.second, 4)) +
      page::VerticalTicks(plot, page::RoundTicks(0, plot.x_range.second, 5)) +
      page::AxisTitles(plot, of.x_axis, chart.axis) + page::Line(plot, chart.points, "training");
  return Fill(
      R"(<figure class="card"><h3>{title}</h3>{chart}</figure>)",
      {{"title", Escape(chart.title)}, {"chart", page::SvgElement(plot, chart.title, svg)}});
}

std::string SettingsOf(const PpoOrigin& origin) {
  std::string entries = "<dt>doors</dt><dd>sha256 " + Escape(origin.doors_sha256) + "</dd>";
  const nlohmann::ordered_json config = ParseJson(origin.config, "config");
  for (const auto& [section, settings] : config.items())
    entries += "<dt>" + Escape(section) + "</dt><dd>" + Escape(JsonText(settings)) + "</dd>";
  return "<section><h2>Settings</h2><dl>" + entries + "</dl></section>";
}

}  // namespace

std::string TextOf(const CurvePage& page, const PpoOrigin& origin) {
  std::string figures;
  for (const CurveChart& chart : page.charts) figures += FigureOf(chart, page);
  std::string numbers;
  for (const CurveFigure& figure : page.figures)
    numbers += R"(<div class="figure"><b>)" + Escape(figure.number) + "</b><span>" +
               Escape(figure.of) + "</span></div>";
  return Fill(
      R"(<!DOCTYPE html>
<html lang="en" xmlns="http://www.w3.org/1999/xhtml">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'"/>
{refresh}<title>doorforge training: {name}</title>
<style>{style}</style>
</head>
<body>
<header>
<p class="over">doorforge training</p>
<h1>{method}: {headline}</h1>
<div class="figures">{numbers}</div>
</header>
<main>
<section><h2>Curves</h2><div class="two">{figures}</div></section>
{settings}
</main>
<footer>The same numbers for programs: losses.jsonl beside this page.</footer>
</body>
</html>
)",
      {{"refresh", page.is_done ? "" : "<meta http-equiv=\"refresh\" content=\"30\"/>\n"},
       {"style", std::string(page::kPageStyle)},
       {"name", page.name},
       {"method", page.method},
       {"headline", page.is_done ? "trained" : "not at its end yet"},
       {"numbers", numbers},
       {"figures", figures},
       {"settings", SettingsOf(origin)}});
}

}  // namespace doorforge::internal
