// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The episodes of a report, one a row, and the films of those that have one.

import { EpisodeView } from './episode_view.js';
import { degrees, h } from './dom.js';

const STEP = 200; // rows that are in the document at first, and more each time

export class ReportView {
  constructor(content) {
    this.content = content;
    this.rows = content.document.rows;
    this.shownRows = STEP;
    this.count = h('p', { class: 'count', role: 'status' });
    this.body = h('tbody');
    this.more = h('button', { type: 'button', onclick: () => this.showMore() }, 'More');
    const values = (key) => [...new Set(this.rows.map((row) => row[key]).filter(Boolean))].sort();
    const pick = (key, title) => h('div', {}, h('label', { for: key }, title), (this[key] = h('select', { id: key, onchange: () => this.filter() }, h('option', { value: '' }, 'all'), values(key).map((value) => h('option', { value }, value.replaceAll('_', ' '))))));
    this.text = h('input', { id: 'text', type: 'search', oninput: () => this.filter() });
    this.element = h('div', { class: 'report' },
      h('section', { class: 'filters', 'aria-label': 'filters' }, h('h1', {}, content.document.title), this.count, pick('outcome', 'Outcome'), pick('category', 'Category'), h('div', {}, h('label', { for: 'text' }, 'Door or detail'), this.text)),
      h('section', { class: 'rows', tabindex: 0, 'aria-label': 'episodes' }, h('table', {}, h('thead', {}, h('tr', {}, ['Film', 'Door', 'Seed', 'Episode', 'Outcome', 'Hinge', 'Detail'].map((title) => h('th', { scope: 'col' }, title)))), this.body), this.more));
  }

  start() {
    this.filter();
    window.addEventListener('hashchange', () => this.openAddress());
    this.openAddress();
  }

  filter() {
    const text = this.text.value.trim().toLowerCase();
    this.chosen = this.rows.filter((row) => (!this.outcome.value || row.outcome === this.outcome.value) && (!this.category.value || row.category === this.category.value) && (!text || row.door.toLowerCase().includes(text) || row.detail.toLowerCase().includes(text)));
    this.shownRows = STEP;
    this.body.replaceChildren();
    this.fill();
  }

  showMore() {
    this.shownRows += STEP;
    this.fill();
  }

  fill() {
    const films = this.rows.filter(({ film }) => film !== undefined).length;
    this.count.textContent = `${this.chosen.length} of ${this.rows.length} episodes, ${films} with a film`;
    for (const row of this.chosen.slice(this.body.children.length, this.shownRows)) this.body.append(this.line(row));
    this.more.hidden = this.chosen.length <= this.shownRows;
  }

  line(row) {
    const film = row.film === undefined ? '' : h('button', { type: 'button', class: 'small', 'aria-label': `film of ${row.address}`, onclick: () => (location.hash = `#${row.address}`) }, 'Play');
    return h('tr', { class: row.outcome === 'opened' ? '' : 'failed' }, h('td', {}, film), h('td', { class: 'name' }, row.door), h('td', {}, row.seed), h('td', {}, row.number), h('td', {}, row.outcome.replaceAll('_', ' ')), h('td', {}, `${degrees(row.hinge).toFixed(0)}°`), h('td', { class: 'soft' }, row.detail));
  }

  openAddress() {
    const address = decodeURIComponent(location.hash.slice(1));
    const row = this.rows.find((candidate) => candidate.address === address);
    if (this.dialog?.open) this.dialog.close();
    if (row?.film !== undefined) this.open(row);
  }

  open(row) {
    const film = new EpisodeView(this.content);
    const dialog = h('dialog', { 'aria-label': `film of ${row.address}`, onclose: () => this.close(dialog, film) },
      h('button', { type: 'button', class: 'close', onclick: () => dialog.close() }, 'Back to the list'), film.element);
    document.body.append(dialog);
    dialog.showModal();
    film.start();
    film.load(this.content.document.episodes[row.film]);
    this.film = film;
    this.dialog = dialog;
  }

  close(dialog, film) {
    film.pause();
    film.stage.renderer.dispose();
    film.stage.renderer.forceContextLoss();
    dialog.remove();
    if (this.dialog !== dialog) return;
    this.dialog = this.film = null;
    if (location.hash) history.replaceState(null, '', location.pathname + location.search);
  }
}
