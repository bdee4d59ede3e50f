// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

const WIDTH = 330;
const HEIGHT = 120;
const LEFT = 40;
const BOTTOM = 18;
const NS = 'http://www.w3.org/2000/svg';

const s = (tag, attributes, text) => {
  const element = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== undefined) element.textContent = text;
  return element;
};

/**
 * Quantities over time, with a line where the film stands; `at(seconds)` moves it. `series` are pairs of a class, which
 * gives the colour, and numbers; the axis reaches from `least` or below to `most` or above.
 */
export const curves = ({ title, times, series, unit, least, most }) => {
  const first = times[0];
  const span = Math.max(1e-6, times.at(-1) - first);
  const bottom = series.reduce((so, [, values]) => Math.min(so, ...values), least);
  const top = series.reduce((so, [, values]) => Math.max(so, ...values), most);
  const x = (t) => LEFT + ((t - first) / span) * (WIDTH - LEFT - 6);
  const y = (value) => 6 + (1 - (value - bottom) / (top - bottom)) * (HEIGHT - BOTTOM - 6);
  const reached = series.map(([name, values]) => `${name.replaceAll('-', ' ')} up to ${Math.max(...values).toFixed(0)}${unit}`).join(', ');
  const chart = s('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'curves', role: 'img', 'aria-label': `${title} over ${span.toFixed(1)} s: ${reached}.` });
  for (const value of [0, top]) {
    chart.append(s('line', { x1: LEFT, x2: WIDTH - 6, y1: y(value), y2: y(value), class: 'axis' }));
    chart.append(s('text', { x: LEFT - 4, y: y(value) + 4, 'text-anchor': 'end' }, `${value.toFixed(0)}${unit}`));
  }
  chart.append(s('text', { x: WIDTH - 6, y: HEIGHT - 3, 'text-anchor': 'end' }, `${times.at(-1).toFixed(1)} s`), s('text', { x: LEFT, y: HEIGHT - 3 }, `${first.toFixed(1)} s`));
  for (const [name, values] of series)
    chart.append(s('polyline', { class: name, points: times.map((t, i) => `${x(t).toFixed(1)},${y(values[i]).toFixed(1)}`).join(' ') }));
  const cursor = s('line', { class: 'cursor', y1: 6, y2: HEIGHT - BOTTOM });
  chart.append(cursor);
  chart.at = (t) => {
    cursor.setAttribute('x1', x(t));
    cursor.setAttribute('x2', x(t));
  };
  return chart;
};
