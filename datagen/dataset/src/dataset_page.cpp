// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "doorforge/core/html_text.h"
#include "doorforge/dataset/describe_episodes.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;
using page::Escape;
using page::Fixed;
using page::PngUri;

constexpr std::string_view kStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #fbfbf9; --card: #ffffff; --ink: #16191d; --soft: #59626c; --rule: #dfe2e5;
  --track: #eceef0; --good: #1f66ad; --cause: #a34a00;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #121518; --card: #1a1e22; --ink: #e9ebee; --soft: #a2abb5; --rule: #333a41;
    --track: #272d33; --good: #74b3f2; --cause: #f0a35e;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; }
main, header, footer { max-width: 1080px; margin: 0 auto; padding: 0 24px; }
header { padding-top: 48px; }
footer { padding-top: 40px; padding-bottom: 48px; color: var(--soft); font-size: 0.9rem; }
section { margin-top: 48px; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 10px; letter-spacing: -0.015em; }
h2 { font-size: 1.35rem; margin: 0 0 6px; }
h3 { font-size: 1rem; margin: 24px 0 4px; }
p { max-width: 72ch; margin: 6px 0 14px; }
.soft { color: var(--soft); }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 14px; margin: 24px 0; }
.figure { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 12px 16px; }
.figure b { display: block; font-size: 1.6rem; line-height: 1.2; white-space: nowrap; }
.figure span { color: var(--soft); font-size: 0.9rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: 0.95rem; }
th { text-align: left; font-weight: 600; color: var(--soft); font-size: 0.86rem; padding: 6px 14px 6px 0;
  border-bottom: 1px solid var(--rule); }
td { padding: 5px 14px 5px 0; border-bottom: 1px solid var(--rule); }
.number { text-align: right; white-space: nowrap; }
.groups { table-layout: fixed; min-width: 720px; }
.groups th:nth-child(1) { width: 22%; }
.groups th:nth-child(2), .groups th:nth-child(3) { width: 11%; }
.groups th:nth-child(4) { width: 22%; }
svg { display: block; }
svg.share { width: 180px; height: 14px; }
.track { fill: var(--track); }
.good { fill: var(--good); }
.bad { fill: var(--cause); }
.axis { stroke: var(--rule); stroke-width: 1; }
svg text { font: 11px system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; fill: var(--soft); }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 18px; margin: 12px 0; }
figure { margin: 0; background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 12px 14px; }
figure svg { width: 100%; height: auto; }
figcaption { font-size: 0.88rem; color: var(--soft); overflow-wrap: anywhere; }
figcaption b { color: var(--ink); }
img { display: block; width: 100%; height: auto; border-radius: 6px; margin-bottom: 8px; background: #ffffff; }
)css";

// Groups of three digits, with a narrow space that does not break.
std::string Number(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, "\u202f");
  return text;
}

double ShareOf(const EpisodeGroup& group) {
  return group.episodes > 0
             ? static_cast<double>(group.succeeded) / static_cast<double>(group.episodes)
             : 0;
}

std::string Figure(const std::string& value, const std::string& meaning) {
  return "<div class=\"figure\"><b>" + value + "</b><span>" + meaning + "</span></div>\n";
}

std::string ShareBar(double share) {
  return "<svg class=\"share\" viewBox=\"0 0 180 14\"><rect class=\"track\" width=\"180\" "
         "height=\"14\" rx=\"3\"/><rect class=\"good\" width=\"" +
         Fixed(180 * share, 1) + "\" height=\"14\" rx=\"3\"/></svg>";
}

std::string CausesOf(const EpisodeGroup& group) {
  std::vector<std::pair<std::uint64_t, std::string>> causes;
  for (const auto& [cause, count] : group.causes) causes.emplace_back(count, cause);
  std::sort(causes.rbegin(), causes.rend());
  std::string text;
  for (const auto& [count, cause] : causes)
    text += (text.empty() ? "" : ", ") + Number(count) + " " + Escape(cause);
  return text;
}

std::string SuccessTable(const std::string& title,
                         const std::map<std::string, EpisodeGroup>& groups) {
  std::string html = "<div class=\"scroll\"><table class=\"groups\"><tr><th>" + title +
                     "</th><th class=\"number\">episodes</th><th class=\"number\">succeeded</th>"
                     "<th></th><th>the others</th></tr>\n";
  for (const auto& [name, group] : groups)
    html += "<tr><td>" + Escape(name) + "</td><td class=\"number\">" + Number(group.episodes) +
            "</td><td class=\"number\">" + Fixed(100 * ShareOf(group), 1) + " %</td><td>" +
            ShareBar(ShareOf(group)) + "</td><td class=\"soft\">" + CausesOf(group) +
            "</td></tr>\n";
  return html + "</table></div>\n";
}

// Bars over an axis from 0 to 120 degrees; the last one is what is beyond.
std::string HistogramFigure(const std::string& name, const AngleHistogram& histogram) {
  constexpr double kWidth = 300;
  constexpr double kHeight = 90;
  constexpr double kStep = kWidth / AngleHistogram::kBins;
  const std::uint64_t largest = std::max<std::uint64_t>(
      *std::max_element(histogram.counts.begin(), histogram.counts.end()), 1);
  std::string bars;
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    total += histogram.counts[i];
    const double height =
        kHeight * static_cast<double>(histogram.counts[i]) / static_cast<double>(largest);
    if (histogram.counts[i] > 0)
      bars += "<rect class=\"good\" x=\"" + Fixed(kStep * static_cast<double>(i) + 1, 1) +
              "\" y=\"" + Fixed(kHeight - height, 1) + "\" width=\"" + Fixed(kStep - 2, 1) +
              "\" height=\"" + Fixed(height, 1) + "\"><title>" +
              std::to_string(5 * static_cast<int>(i)) + "° on: " + Number(histogram.counts[i]) +
              "</title></rect>";
  }
  for (int degrees = 0; degrees <= 120; degrees += 30)
    bars += "<text x=\"" + Fixed(kStep * degrees / 5, 1) + "\" y=\"" + Fixed(kHeight + 14, 1) +
            "\">" + std::to_string(degrees) + "°</text>";
  return "<figure><svg viewBox=\"-4 0 330 108\" role=\"img\"><title>" + Escape(name) +
         "</title><line class=\"axis\" x1=\"0\" y1=\"90\" x2=\"300\" y2=\"90\"/>" + bars +
         "</svg><figcaption><b>" + Escape(name) + "</b>, " + Number(total) +
         " episodes</figcaption></figure>\n";
}

std::string StageSection(const StageEpisodes& stage) {
  std::string html = "<section><h2>Stage " + Escape(stage.stage) + "</h2>\n<p class=\"soft\">" +
                     Number(stage.all.succeeded) + " of " + Number(stage.all.episodes) +
                     " episodes succeeded.</p>\n" + SuccessTable("category", stage.by_category) +
                     SuccessTable("mechanism", stage.by_mechanism) +
                     SuccessTable("split", stage.by_split);
  html += "<h3>Largest hinge angle of each episode</h3>\n<div class=\"tiles\">\n";
  for (const auto& [name, group] : stage.by_category) html += HistogramFigure(name, group.hinge);
  html += "</div>\n<h3>Largest handle angle of each episode</h3>\n<div class=\"tiles\">\n";
  for (const auto& [name, group] : stage.by_mechanism) html += HistogramFigure(name, group.handle);
  return html + "</div></section>\n";
}

std::string Examples(const std::vector<ExampleEpisode>& examples) {
  if (examples.empty()) return "";
  std::string html =
      "<section><h2>Episodes</h2>\n<p class=\"soft\">What the camera saw at the first and at the "
      "last decision: the first episodes of each category that have a preview.</p>\n"
      "<div class=\"tiles\">\n";
  for (const ExampleEpisode& example : examples)
    html += "<figure><img alt=\"" + Escape(example.category) + "\" src=\"" + PngUri(example.png) +
            "\"/><figcaption><b>" + Escape(example.category) + "</b> " + Escape(example.part) +
            " " + Escape(example.key) + "<br/>" + Escape(example.door_id) + "<br/>" +
            Escape(example.detail) + "</figcaption></figure>\n";
  return html + "</div></section>\n";
}

// "ep000012" as 12, the number of the scene.
std::string NumberOfKey(const std::string& key) {
  const std::size_t digit = key.find_first_of("123456789");
  return digit == std::string::npos ? "0" : key.substr(digit);
}

std::string Failures(const std::vector<UnwrittenEpisode>& failures, const std::string& seed,
                     const std::string& films) {
  if (failures.empty()) return "";
  std::string rows;
  for (const UnwrittenEpisode& failure : failures) {
    const std::string address = failure.door_id + "/" + seed + "/" + NumberOfKey(failure.key);
    const std::string link =
        films.empty() ? "" : "<a href=\"" + Escape(films + "#" + address) + "\">film</a>";
    rows += "<tr><td>" + Escape(failure.part) + "</td><td>" + Escape(failure.key) + "</td><td>" +
            Escape(failure.door_id) + "</td><td>" + Escape(failure.outcome) + "</td><td>" + link +
            "</td><td class=\"soft\">" + Escape(failure.detail) + "</td></tr>\n";
  }
  return "<section><h2>Failures</h2>\n<p class=\"soft\">Planned episodes that failed and are not "
         "in "
         "the data.</p>\n<div class=\"scroll\"><table><thead><tr><th>part</th><th>episode</th>"
         "<th>door</th><th>cause</th><th></th><th>detail</th></tr></thead><tbody>" +
         rows + "</tbody></table></div></section>\n";
}

struct Totals {
  std::uint64_t episodes = 0;
  std::uint64_t failed = 0;
  std::uint64_t decisions = 0;
  std::uint64_t bytes = 0;
};

Totals TotalsOf(const Json& dataset) {
  Totals totals;
  for (const Json& part : dataset.at("parts")) {
    totals.episodes += part.at("episodes").get<std::uint64_t>();
    totals.failed += part.at("failed_episodes").get<std::uint64_t>();
    totals.decisions += part.at("decisions").get<std::uint64_t>();
    totals.bytes += part.at("bytes").get<std::uint64_t>();
  }
  return totals;
}

// The page may be passed on; where the dataset lay is nobody's business.
std::string NameOfFolder(const std::string& folder) {
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string DoorTable(const Json& dataset) {
  std::string html =
      "<section><h2>Doors</h2>\n<div class=\"scroll\"><table><tr><th>category</th>"
      "<th>mechanism</th><th class=\"number\">doors</th></tr>\n";
  for (const Json& kind : dataset.at("doors"))
    html += "<tr><td>" + Escape(kind.at("category").get<std::string>()) + "</td><td>" +
            Escape(kind.at("mechanism").get<std::string>()) + "</td><td class=\"number\">" +
            Number(kind.at("doors").get<std::uint64_t>()) + "</td></tr>\n";
  return html + "</table></div></section>\n";
}

}  // namespace

std::string DatasetPage(const Json& dataset, const EpisodeDescription& description,
                        const std::string& films) {
  const Totals totals = TotalsOf(dataset);
  std::uint64_t doors = 0;
  for (const Json& kind : dataset.at("doors")) doors += kind.at("doors").get<std::uint64_t>();
  std::string html =
      "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\"><head>"
      "<meta charset=\"utf-8\"/><meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\"/><title>Door episodes</title><style>" +
      std::string(kStyle) + "</style></head><body>\n<header><h1>Door episodes</h1>\n" +
      "<p class=\"soft\">" + Escape(NameOfFolder(dataset.at("folder").get<std::string>())) +
      "</p></header>\n" + "<main><div class=\"figures\">\n" +
      Figure(Number(totals.episodes), "episodes written") +
      Figure(Number(totals.failed), "planned ones failed") +
      Figure(Number(totals.decisions), "decisions") + Figure(Number(doors), "doors") +
      Figure(Fixed(static_cast<double>(totals.bytes) / (1 << 20), 1) + " MiB", "of shards") +
      "</div>\n";
  for (const StageEpisodes& stage : description.stages) html += StageSection(stage);
  html += DoorTable(dataset) + Examples(description.examples) +
          Failures(description.unwritten, std::to_string(dataset.at("seed").get<std::uint64_t>()),
                   films) +
          "</main>\n<footer>doorforge " + Escape(dataset.at("code_version").get<std::string>()) +
          ", seed " + std::to_string(dataset.at("seed").get<std::uint64_t>()) +
          ", configuration SHA-256 " + Escape(dataset.at("config_sha256").get<std::string>()) +
          "</footer></body></html>\n";
  return html;
}

}  // namespace doorforge
