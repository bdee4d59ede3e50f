// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

import { degrees } from './dom.js';

const WIDTH = 330;
const HEIGHT = 120;
const LEFT = 34;
const BOTTOM = 18;
const NS = 'http://www.w3.org/2000/svg';

const s = (tag, attributes, text) => {
  const element = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== undefined) element.textContent = text;
  return element;
};

/** Hinge and handle over time, with a line where the film stands; `at(seconds)` moves it. */
export const curves = ({ times, hinge, handle }) => {
  const first = times[0];
  const span = Math.max(1e-6, times.at(-1) - first);
  const all = [...hinge, ...handle].map(degrees);
  const least = Math.min(0, ...all);
  const most = Math.max(10, ...all);
  const x = (t) => LEFT + ((t - first) / span) * (WIDTH - LEFT - 6);
  const y = (angle) => 6 + (1 - (angle - least) / (most - least)) * (HEIGHT - BOTTOM - 6);
  const chart = s('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'curves', role: 'img', 'aria-label': `Angles over ${span.toFixed(1)} s: the hinge reaches ${Math.max(...hinge.map(degrees)).toFixed(0)} degrees, the handle ${Math.max(...handle.map(degrees)).toFixed(0)}.` });
  for (const angle of [0, most]) {
    chart.append(s('line', { x1: LEFT, x2: WIDTH - 6, y1: y(angle), y2: y(angle), class: 'axis' }));
    chart.append(s('text', { x: LEFT - 4, y: y(angle) + 4, 'text-anchor': 'end' }, `${angle.toFixed(0)}°`));
  }
  chart.append(s('text', { x: WIDTH - 6, y: HEIGHT - 3, 'text-anchor': 'end' }, `${times.at(-1).toFixed(1)} s`), s('text', { x: LEFT, y: HEIGHT - 3 }, `${first.toFixed(1)} s`));
  for (const [name, angles] of [['hinge', hinge], ['handle', handle]])
    chart.append(s('polyline', { class: name, points: times.map((t, i) => `${x(t).toFixed(1)},${y(degrees(angles[i])).toFixed(1)}`).join(' ') }));
  const cursor = s('line', { class: 'cursor', y1: 6, y2: HEIGHT - BOTTOM });
  chart.append(cursor);
  chart.at = (t) => {
    cursor.setAttribute('x1', x(t));
    cursor.setAttribute('x2', x(t));
  };
  return chart;
};
