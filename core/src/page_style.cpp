// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/page_style.h"

namespace doorforge::page {

const std::string_view kPageStyle = R"css(
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
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(180px, 1fr)); gap: 14px; margin: 26px 0; }
.figure { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 14px 18px; }
.figure b { display: block; white-space: nowrap; font-size: 1.75rem; line-height: 1.15; font-weight: 660; letter-spacing: -0.02em; }
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
svg text { font: 12px system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; fill: var(--soft); font-variant-numeric: tabular-nums; }
.grid { stroke: var(--rule); stroke-width: 1; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round; }
.line.training { stroke: var(--policy); }
.line.validation { stroke: var(--expert); stroke-dasharray: 6 4; }
.dot.training { fill: var(--policy); }
.dot.validation { fill: var(--expert); }
.best { stroke: var(--soft); stroke-width: 1.4; stroke-dasharray: 2 3; }
.legend { display: flex; flex-wrap: wrap; gap: 6px 22px; font-size: 0.9rem; color: var(--soft); margin: 8px 0 12px; }
.legend svg { display: inline-block; width: 34px; height: 12px; vertical-align: -1px; margin-right: 7px; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(400px, 100%), 1fr)); gap: 18px; margin-top: 14px; }
code, pre { font: 0.86rem/1.5 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace; }
pre { background: var(--card); border: 1px solid var(--rule); border-radius: 8px; padding: 12px 14px; overflow-x: auto; margin: 6px 0 14px; }
dl { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 4px 20px; margin: 12px 0; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
footer { margin-top: 64px; padding-bottom: 48px; color: var(--soft); font-size: 0.9rem; }
@media (max-width: 640px) { h1 { font-size: 1.6rem; } header { padding-top: 32px; } dl { grid-template-columns: 1fr; } }
@media print { section { break-inside: avoid-page; } }
)css";

}  // namespace doorforge::page
