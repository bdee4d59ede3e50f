// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "report_style.h"

namespace doorforge::internal {

const std::string_view kReportStyle = R"css(
nav { display: flex; flex-wrap: wrap; gap: 4px 18px; font-size: 0.92rem; margin: 18px 0 0; padding-bottom: 14px; border-bottom: 1px solid var(--rule); }
nav a { text-decoration: none; }
nav a:hover, nav a:focus-visible { text-decoration: underline; }
.figure.first b { color: var(--policy); }
svg.bar { width: 308px; height: 32px; }
.threshold { stroke: var(--soft); stroke-width: 1; stroke-dasharray: 2 4; opacity: 0.7; }
.line.policy { stroke: var(--policy); }
.line.reference { stroke: var(--expert); stroke-dasharray: 6 4; }
.mark { fill: var(--policy); stroke: var(--card); stroke-width: 1.5; }
.whisker { stroke: var(--ink); stroke-width: 1.4; fill: none; }
.track { fill: var(--track); }
.fill { fill: var(--policy); opacity: 0.72; }
.bar .reference { fill: var(--card); stroke: var(--expert); stroke-width: 1.8; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(180px, 1fr)); gap: 18px; margin: 14px 0 26px; }
.tiles.small { grid-template-columns: repeat(auto-fill, minmax(130px, 1fr)); gap: 14px; }
.tiles figcaption { overflow-wrap: anywhere; font-size: 0.82rem; line-height: 1.4; }
.tiles figcaption b { color: var(--ink); font-weight: 600; }
.film { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 8px; }
.film figcaption { font-size: 0.82rem; margin-top: 3px; }
.three { display: grid; grid-template-columns: repeat(auto-fit, minmax(260px, 1fr)); gap: 18px; margin-top: 14px; }
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
@media print { nav, .filters { display: none; } .rows { max-height: none; } }
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
