// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "report_style.h"

namespace doorforge::internal {

const std::string_view kReportStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #fbfbf9; --card: #ffffff; --ink: #16191d; --soft: #59626c; --rule: #dfe2e5;
  --track: #eceef0; --policy: #1f66ad; --expert: #a34a00; --cause: #8a5a00; --good: #1f66ad;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #121518; --card: #1a1e22; --ink: #e9ebee; --soft: #a2abb5; --rule: #333a41;
    --track: #272d33; --policy: #74b3f2; --expert: #f0a35e; --cause: #d9ad5b; --good: #74b3f2;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif;
}
main, header, footer { max-width: 1080px; margin: 0 auto; padding: 0 24px; }
header { padding-top: 56px; }
section { margin-top: 56px; }
h1 { font-size: 2.1rem; line-height: 1.2; font-weight: 680; letter-spacing: -0.015em; margin: 6px 0 12px; text-wrap: balance; }
h2 { font-size: 1.35rem; font-weight: 660; letter-spacing: -0.01em; margin: 0 0 4px; }
h3 { font-size: 1rem; font-weight: 640; margin: 0; }
p { max-width: 72ch; margin: 6px 0 14px; }
.over { color: var(--soft); font-size: 0.9rem; letter-spacing: 0.01em; }
.lead { font-size: 1.15rem; max-width: 66ch; }
.soft { color: var(--soft); }
a { color: var(--policy); }
nav { display: flex; flex-wrap: wrap; gap: 4px 18px; font-size: 0.92rem; margin: 18px 0 0; padding-bottom: 14px; border-bottom: 1px solid var(--rule); }
nav a { text-decoration: none; }
nav a:hover, nav a:focus-visible { text-decoration: underline; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(180px, 1fr)); gap: 14px; margin: 26px 0; }
.figure { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 14px 18px; }
.figure b { display: block; white-space: nowrap; font-size: 1.75rem; line-height: 1.15; font-weight: 660; letter-spacing: -0.02em; }
.figure.first b { color: var(--policy); }
.figure span { color: var(--soft); font-size: 0.9rem; }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: 0.9rem; margin-top: 6px; max-width: 80ch; }
img { display: block; width: 100%; height: auto; border-radius: 8px; border: 1px solid var(--rule); background: #ffffff; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: 0.95rem; }
th { text-align: left; font-weight: 600; color: var(--soft); font-size: 0.86rem; padding: 6px 14px 6px 0; border-bottom: 1px solid var(--rule); vertical-align: bottom; }
td { padding: 5px 14px 5px 0; border-bottom: 1px solid var(--rule); vertical-align: middle; }
td.number, th.number { text-align: right; white-space: nowrap; }
tr.overall td { font-weight: 640; }
tr.overall td.soft { font-weight: 400; }
.card { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 18px 20px; }
svg { display: block; width: 100%; height: auto; }
svg.bar { width: 308px; height: 32px; }
svg text { font: 12px system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; fill: var(--soft); font-variant-numeric: tabular-nums; }
.grid { stroke: var(--rule); stroke-width: 1; }
.threshold { stroke: var(--soft); stroke-width: 1; stroke-dasharray: 2 4; opacity: 0.7; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round; }
.line.policy, .line.training { stroke: var(--policy); }
.line.reference, .line.validation { stroke: var(--expert); stroke-dasharray: 6 4; }
.dot.training { fill: var(--policy); }
.dot.validation { fill: var(--expert); }
.mark { fill: var(--policy); stroke: var(--card); stroke-width: 1.5; }
.whisker { stroke: var(--ink); stroke-width: 1.4; fill: none; }
.track { fill: var(--track); }
.fill { fill: var(--policy); opacity: 0.72; }
.bar .reference { fill: var(--card); stroke: var(--expert); stroke-width: 1.8; }
.legend { display: flex; flex-wrap: wrap; gap: 6px 22px; font-size: 0.9rem; color: var(--soft); margin: 8px 0 12px; }
.legend svg { display: inline-block; width: 34px; height: 12px; vertical-align: -1px; margin-right: 7px; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(180px, 1fr)); gap: 18px; margin: 14px 0 26px; }
.tiles.small { grid-template-columns: repeat(auto-fill, minmax(130px, 1fr)); gap: 14px; }
.tiles figcaption { overflow-wrap: anywhere; font-size: 0.82rem; line-height: 1.4; }
.tiles figcaption b { color: var(--ink); font-weight: 600; }
.film { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 8px; }
.film figcaption { font-size: 0.82rem; margin-top: 3px; }
.three { display: grid; grid-template-columns: repeat(auto-fit, minmax(260px, 1fr)); gap: 18px; margin-top: 14px; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(400px, 100%), 1fr)); gap: 18px; margin-top: 14px; }
.cause { margin: 22px 0 34px; }
.cause .head { display: flex; flex-wrap: wrap; align-items: baseline; gap: 4px 14px; margin-bottom: 8px; }
.meter { height: 8px; border-radius: 4px; background: var(--track); margin: 4px 0 8px; overflow: hidden; }
.meter div { height: 8px; background: var(--cause); }
.dots { letter-spacing: 0.15em; color: var(--good); }
.filters { display: flex; flex-wrap: wrap; gap: 10px; margin: 10px 0; font-size: 0.92rem; }
.filters[hidden] { display: none; }
select, input { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--rule); border-radius: 6px; padding: 4px 8px; }
.rows { max-height: 540px; overflow: auto; border: 1px solid var(--rule); border-radius: 10px; padding: 0 0 0 14px; background: var(--card); }
.rows th { position: sticky; top: 0; background: var(--card); }
.rows td { font-size: 0.86rem; overflow-wrap: anywhere; }
.rows td.name { min-width: 220px; }
code, pre { font: 0.86rem/1.5 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace; }
pre { background: var(--card); border: 1px solid var(--rule); border-radius: 8px; padding: 12px 14px; overflow-x: auto; margin: 6px 0 14px; }
dl { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 4px 20px; margin: 12px 0; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
footer { margin-top: 64px; padding-bottom: 48px; color: var(--soft); font-size: 0.9rem; }
@media (max-width: 640px) { h1 { font-size: 1.6rem; } header { padding-top: 32px; } dl { grid-template-columns: 1fr; } }
@media print { nav, .filters { display: none; } .rows { max-height: none; } section { break-inside: avoid-page; } }
)css";

const std::string_view kReportScript = R"js(
(function () {
  var form = document.getElementById("filters");
  if (!form) return;
  var rows = Array.prototype.slice.call(document.querySelectorAll("#rows tr"));
  var shown = document.getElementById("shown");
  function apply() {
    var category = form.elements.category.value;
    var outcome = form.elements.outcome.value;
    var text = form.elements.text.value.toLowerCase();
    var count = 0;
    rows.forEach(function (row) {
      var fits = (!category || row.dataset.category === category);
      if (outcome) fits = fits ? row.dataset.outcome === outcome : false;
      if (text) fits = fits ? row.textContent.toLowerCase().indexOf(text) !== -1 : false;
      row.hidden = !fits;
      if (fits) count += 1;
    });
    shown.textContent = count + " of " + rows.length;
  }
  form.hidden = false;
  form.addEventListener("input", apply);
  form.addEventListener("submit", function (event) { event.preventDefault(); });
  apply();
})();
)js";

}  // namespace doorforge::internal
