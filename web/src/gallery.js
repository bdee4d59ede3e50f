// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Doors and parts to browse: filters, cards with pictures, and each in 3D when it is chosen.

import { Grid } from './grid.js';
import { RecordView } from './record_view.js';
import { copyButton, h } from './dom.js';

const FACETS = [['role', 'Kind'], ['category', 'Category'], ['mechanism', 'Mechanism'], ['license', 'Licence']];

// What the page's tables hold, in words.
const itemsOf = ({ items, words }) =>
  items.map(([id, role, category, mechanism, license, size, pictures, record]) => ({ id, role: words[role], category: words[category], mechanism: words[mechanism], license: words[license], size, pictures, record }));

export class Gallery {
  constructor(content) {
    this.content = content;
    this.items = itemsOf(content.document);
    this.pictures = new Map();
    this.grid = new Grid(content.document.items[0]?.[6].length > 1 ? 300 : 210, 214, () => this.card());
    this.count = h('p', { role: 'status', class: 'count' });
    this.element = h('div', { class: 'gallery' }, this.filters(), this.grid.element);
  }

  filters() {
    this.search = h('input', { type: 'search', id: 'search', placeholder: 'part of an id', oninput: () => this.filter() });
    this.chosen = {};
    const selects = FACETS.map(([key, title]) => {
      const values = [...new Set(this.items.map((item) => item[key]))].sort();
      if (values.length < 2) return null;
      const select = h('select', { id: `facet-${key}`, onchange: () => {
        this.chosen[key] = select.value;
        this.filter();
      } }, h('option', { value: '' }, 'any'), values.map((value) => h('option', { value }, value)));
      return h('div', {}, h('label', { for: `facet-${key}` }, title), select);
    });
    const bound = (id, title) => h('div', {}, h('label', { for: id }, title), h('input', { type: 'number', id, min: 0, max: 5000, step: 10, inputmode: 'numeric', oninput: () => this.filter() }));
    return h('form', { class: 'filters', 'aria-label': 'filters', onsubmit: (event) => event.preventDefault() },
      h('h1', {}, 'Doors and parts'),
      h('div', {}, h('label', { for: 'search' }, 'Id'), this.search), selects,
      bound('width-least', 'Width from [mm]'), bound('width-most', 'to [mm]'), bound('height-least', 'Height from [mm]'), bound('height-most', 'to [mm]'), this.count);
  }

  start() {
    this.filter();
  }

  // The number in a field, or what stands for an empty one.
  bound(id, otherwise) {
    const { value } = this.element.querySelector(`#${id}`);
    return value === '' ? otherwise : Number(value);
  }

  filter() {
    const words = this.search.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = Object.entries(this.chosen).filter(([, value]) => value !== '');
    const [wideFrom, wideTo] = [this.bound('width-least', 0), this.bound('width-most', Infinity)];
    const [highFrom, highTo] = [this.bound('height-least', 0), this.bound('height-most', Infinity)];
    const fits = (item) =>
      wanted.every(([key, value]) => item[key] === value) && words.every((word) => item.id.includes(word)) &&
      item.size[0] >= wideFrom && item.size[0] <= wideTo && item.size[1] >= highFrom && item.size[1] <= highTo;
    this.found = this.items.filter(fits);
    this.count.textContent = `${this.found.length} of ${this.items.length}`;
    this.grid.show(this.found);
  }

  // One address a picture, made when it is first seen.
  picture(place) {
    if (!this.pictures.has(place)) {
      const bytes = this.content.bytes(this.content.document.thumbnails[place]);
      this.pictures.set(place, URL.createObjectURL(new Blob([bytes], { type: 'image/jpeg' })));
    }
    return this.pictures.get(place);
  }

  card() {
    const images = [0, 1].map(() => h('img', { alt: '', width: 240, height: 180, decoding: 'async' }));
    const name = h('span', { class: 'name' });
    const words = h('span', { class: 'soft' });
    let shown = null;
    const button = h('button', { type: 'button', class: 'open', onclick: () => this.open(shown) }, h('span', { class: 'pictures' }, images), name);
    const copy = copyButton('', 'id');
    const element = h('li', { class: 'card' }, button, h('span', { class: 'under' }, words, copy));
    return {
      element,
      fill: (item) => {
        shown = item;
        images.forEach((image, i) => {
          image.hidden = item.pictures[i] === undefined;
          if (!image.hidden) image.src = this.picture(item.pictures[i]);
        });
        name.textContent = item.id.replaceAll('__', '__\u200b');
        words.textContent = `${item.category}${item.mechanism === 'none' ? '' : `, ${item.mechanism}`}, ${item.size[0]} x ${item.size[1]} mm`;
        copy.text = item.id;
        copy.setAttribute('aria-label', `copy id ${item.id}`);
      },
    };
  }

  record(item) {
    const [at, bytes] = item.record;
    return JSON.parse(new TextDecoder().decode(this.content.bytes({ at, bytes })));
  }

  /** Shows an item in 3D, above the gallery. */
  open(item) {
    if (!this.dialog) {
      this.view = new RecordView(this.content);
      const close = h('button', { type: 'button', class: 'close', onclick: () => this.dialog.close() }, 'Back to all');
      this.dialog = h('dialog', { 'aria-label': 'in 3D', onclose: () => this.view.stop() }, close, this.view.element);
      this.element.append(this.dialog);
      this.dialog.showModal();
      this.view.start();
    } else {
      this.dialog.showModal();
    }
    this.view.load(this.record(item));
    this.view.canvas.focus();
  }
}
