// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Doors composed in the browser: a body, a handle, settings; the server composes, this page shows.

import { Content } from './content.js';
import { EpisodeView } from './episode_view.js';
import { Grid } from './grid.js';
import { RecordView } from './record_view.js';
import { copyButton, h } from './dom.js';

const LENGTHS = [['leaf_width_m', 'Leaf width'], ['leaf_height_m', 'Leaf height'], ['handle_height_m', 'Handle height'], ['backset_m', 'Handle to edge']];
const CHOICES = [
  ['hinge_side', 'Hinged', ['left', 'right']], ['opening', 'Opens', ['pull', 'push']], ['latch', 'Latch', ['auto', 'none', 'effort', 'bolt']],
  ['handle_sense', 'Handle unlocks', ['as_made', 'reversed']],
];
const PAUSE = 250; // [ms] after the last change, before the server is asked

export class ComposerView {
  constructor(content) {
    this.document = content.document;
    this.chosen = { body: '', handle: '' };
    this.settings = {};
    this.view = new RecordView(content);
    this.status = h('p', { role: 'status', class: 'asked' });
    this.grids = Object.fromEntries(['body', 'handle'].map((role) => [role, new Grid(128, 132, () => this.card(role))]));
    this.command = h('code', { tabindex: 0 });
    this.copy = copyButton('', 'command');
    this.element = h('div', { class: 'composer' }, this.shelf(), h('div', { class: 'made' }, this.controls(), this.view.element));
  }

  shelf() {
    const categories = [...new Set(this.document.parts.map(({ category }) => category))].sort();
    this.category = h('select', { id: 'category', onchange: () => this.fillShelf() }, categories.map((value) => h('option', { value }, value)));
    return h('section', { class: 'shelf', 'aria-label': 'parts' }, h('h1', {}, 'Compose a door'),
      h('div', {}, h('label', { for: 'category' }, 'Category'), this.category),
      h('h2', {}, 'Body'), this.grids.body.element, h('h2', {}, 'Handle'), this.grids.handle.element);
  }

  controls() {
    const length = ([key, title]) => h('div', {}, h('label', { for: key }, `${title} [m]`), h('input', { type: 'number', id: key, min: 0, max: 4, step: 0.01, placeholder: 'as made', oninput: ({ target }) => this.set(key, target.value === '' ? null : Number(target.value)) }));
    const pick = ([key, title, values]) => h('div', {}, h('label', { for: key }, title), h('select', { id: key, onchange: ({ target }) => this.set(key, target.value) }, values.map((value) => h('option', { value }, value.replace('_', ' ')))));
    const scale = h('div', {}, h('label', { for: 'handle_scale' }, 'Handle scale'), h('input', { type: 'number', id: 'handle_scale', min: 0.5, max: 2, step: 0.05, value: 1, oninput: ({ target }) => this.set('handle_scale', target.value === '' ? null : Number(target.value)) }));
    const mirrored = h('div', { class: 'check' }, h('input', { type: 'checkbox', id: 'handle_mirrored', onchange: ({ target }) => this.set('handle_mirrored', target.checked) }), h('label', { for: 'handle_mirrored' }, 'Handle mirrored'));
    this.format = h('select', { id: 'format' }, h('option', { value: '' }, 'door folder'), this.document.formats.map((value) => h('option', { value }, value)));
    return h('section', { class: 'controls', 'aria-label': 'settings' },
      h('form', { class: 'settings', onsubmit: (event) => event.preventDefault() }, LENGTHS.map(length), scale, CHOICES.map(pick), mirrored),
      h('div', { class: 'actions' },
        h('button', { type: 'button', id: 'open', onclick: () => this.open() }, 'Does it open?'),
        h('div', {}, h('label', { for: 'format' }, 'Download as'), this.format), h('button', { type: 'button', id: 'download', onclick: () => this.download() }, 'Download'), this.status),
      h('p', { class: 'command' }, this.command, this.copy));
  }

  start() {
    this.view.start();
    this.fillShelf();
  }

  parts(role) {
    return this.document.parts.filter((part) => part.role === role && part.category === this.category.value);
  }

  fillShelf() {
    for (const role of ['body', 'handle']) {
      const parts = this.parts(role);
      this.grids[role].show(parts);
      this.chosen[role] = parts[0]?.id ?? '';
    }
    this.changed(0);
  }

  card(role) {
    const image = h('img', { alt: '', width: 128, height: 96 });
    const name = h('span', { class: 'name' });
    let part = null;
    const button = h('button', { type: 'button', class: 'open', onclick: () => {
      this.chosen[role] = part.id;
      this.grids[role].refresh();
      this.changed(0);
    } }, image, name);
    return {
      element: h('li', { class: 'card part' }, button),
      fill: (item) => {
        if (part !== item) image.src = `/thumbnail/${encodeURIComponent(item.id)}`;
        part = item;
        name.textContent = item.id;
        button.setAttribute('aria-pressed', String(this.chosen[role] === item.id));
      },
    };
  }

  set(key, value) {
    if (value === null) delete this.settings[key];
    else this.settings[key] = value;
    this.changed(PAUSE);
  }

  get request() {
    return JSON.stringify({ ...this.chosen, settings: this.settings });
  }

  changed(pause) {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.compose(), pause);
  }

  /** The bytes of an answer; what is refused is said, and gives null. */
  async ask(path, request) {
    this.status.textContent = 'asking ...';
    this.status.classList.remove('refused');
    let message = '';
    try {
      const answer = await fetch(path, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: request });
      if (answer.ok) {
        this.status.textContent = '';
        return new Uint8Array(await answer.arrayBuffer());
      }
      message = (await answer.json()).error;
    } catch {
      message = 'the server does not answer; is doorforge serve still running?';
    }
    this.status.textContent = message;
    this.status.classList.add('refused');
    return null;
  }

  async compose() {
    const { request } = this;
    const bytes = await this.ask('/compose', request);
    if (bytes === null || request !== this.request) return; // another one is on its way
    const content = await Content.fromBytes(bytes);
    this.composed = request;
    this.view.use(content);
    this.view.load(content.document.records[0]);
    this.command.textContent = this.copy.text = content.document.command;
    document.documentElement.dataset.composed = request;
  }

  async open() {
    const bytes = await this.ask('/open', this.request);
    if (bytes === null) return;
    const content = await Content.fromBytes(bytes);
    const film = new EpisodeView(content);
    const close = h('button', { type: 'button', class: 'close', onclick: () => dialog.close() }, 'Back to the door');
    const dialog = h('dialog', { 'aria-label': 'does it open', onclose: () => {
      film.pause();
      film.stage.renderer.dispose();
      film.stage.renderer.forceContextLoss();
      dialog.remove();
    } }, close, film.element);
    this.element.append(dialog);
    dialog.showModal();
    film.start();
    film.load(content.document.episodes[0]);
    this.film = film;
    film.toggle();
  }

  async download() {
    const format = this.format.value;
    const bytes = await this.ask(`/download?format=${format}`, this.request);
    if (bytes === null) return;
    const link = h('a', { href: URL.createObjectURL(new Blob([bytes], { type: 'application/zip' })), download: `${this.view.record.id}${format ? `_${format}` : ''}.zip` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    this.downloaded = bytes;
  }
}
