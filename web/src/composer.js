// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Doors composed in the browser: a body, a handle, settings; the server composes, this page shows.

import { Content } from './content.js';
import { EpisodeView } from './episode_view.js';
import { Grid } from './grid.js';
import { OwnMesh } from './own_mesh.js';
import { RecordView } from './record_view.js';
import { copyButton, h } from './dom.js';

const LENGTHS = [['leaf_width_m', 'Leaf width'], ['leaf_height_m', 'Leaf height'], ['handle_height_m', 'Handle height'], ['backset_m', 'Handle to edge']];
const CHOICES = [
  ['hinge_side', 'Hinged', ['left', 'right']], ['opening', 'Opens', ['pull', 'push']], ['latch', 'Latch', ['auto', 'none', 'effort', 'bolt']],
  ['handle_sense', 'Handle unlocks', ['as_made', 'reversed']],
];
// What most doors do without.
const MORE_CHOICES = [
  ['place', 'Handle goes', ['auto', 'seat', 'plane', 'author', 'axis']], ['handle_turn_deg', 'Handle turned [deg]', [0, 90, 180, 270]],
];
const MORE_NUMBERS = [
  ['unlock_angle_rad', 'Unlocks at [rad]', 0, 0.01], ['handle_done_angle_rad', 'Handle done at [rad]', 0, 0.01], ['lock_effort_nm', 'Latch effort [N m]', 0, 1], ['bolt_throw_m', 'Bolt throw [m]', 0.002, 0.001],
  ['hinge_spring_nm_per_rad', 'Hinge spring [N m/rad]', 0, 0.1], ['handle_spring_nm_per_rad', 'Handle spring [N m/rad]', 0, 0.1], ['hinge_damping_nm_s', 'Hinge damping [N m s]', 0, 0.01], ['handle_damping_nm_s', 'Handle damping [N m s]', 0, 0.01],
  ['seed', 'Seed', 0, 1],
];
const MORE_CHECKS = [['relatch', 'Locks again'], ['unlocks_ajar', 'Unlocks ajar']];
const PAUSE = 250; // [ms] after the last change, before the server is asked

export class ComposerView {
  constructor(content) {
    this.document = content.document;
    this.chosen = { body: '', handle: '' };
    this.settings = {};
    this.view = new RecordView(content);
    this.status = h('p', { role: 'status', class: 'asked' });
    this.refusals = {}; // by what was asked: 'files', 'door', 'film', 'download'
    this.pending = 0; // requests without an answer
    this.grids = Object.fromEntries(['body', 'handle'].map((role) => [role, new Grid(128, 132, () => this.card(role))]));
    this.command = h('code', { tabindex: 0 });
    this.copy = copyButton('', 'command');
    this.copyYaml = copyButton('', 'YAML', 'copy as YAML');
    this.notes = h('ul', { class: 'notes', hidden: true, 'aria-label': 'what was assumed of your mesh' });
    this.own = {}; // meshes that were dropped and are on the door, by role
    this.element = h('div', { class: 'composer' }, this.shelf(), h('div', { class: 'made' }, this.controls(), this.view.element));
  }

  shelf() {
    const categories = [...new Set(this.document.parts.map(({ category }) => category))].sort();
    this.category = h('select', { id: 'category', onchange: () => this.fillShelf() }, categories.map((value) => h('option', { value }, value)));
    return h('section', { class: 'shelf', 'aria-label': 'parts' }, h('h1', {}, 'Compose a door'),
      h('div', {}, h('label', { for: 'category' }, 'Category'), this.category),
      this.dropZone(),
      h('h2', {}, 'Body'), this.grids.body.element, h('h2', {}, 'Handle'), this.grids.handle.element);
  }

  // Files of one's own: dropped anywhere on the page, or chosen.
  dropZone() {
    const input = h('input', { type: 'file', id: 'file', multiple: true, accept: '.stl,.obj,.glb,.mtl,.png,.jpg,.jpeg', onchange: () => {
      const files = [...input.files];
      input.value = ''; // so that the same file can be chosen again
      this.drop(files);
    } });
    this.ownRows = Object.fromEntries(['body', 'handle'].map((role) => [role, this.ownRow(role)]));
    const zone = h('div', { class: 'drop' }, h('label', { for: 'file' }, 'Your own handle, leaf, or both: drop STL, OBJ or GLB here'), input, Object.values(this.ownRows));
    for (const kind of ['dragover', 'drop']) window.addEventListener(kind, (event) => event.preventDefault());
    window.addEventListener('dragover', () => zone.classList.add('over'));
    window.addEventListener('dragleave', () => zone.classList.remove('over'));
    window.addEventListener('drop', (event) => {
      zone.classList.remove('over');
      this.drop([...event.dataTransfer.files]);
    });
    return zone;
  }

  ownRow(role) {
    const named = role === 'body' ? 'leaf' : role;
    return h('div', { class: 'own-row', id: `own-row-${role}`, hidden: true }, h('span', { class: 'name' }),
      h('button', { type: 'button', class: 'small own-edit', 'aria-label': `turn it: your ${named}`, onclick: () => this.own[role].show(this.element) }, 'turn it'),
      h('button', { type: 'button', class: 'small own-remove', 'aria-label': `remove: your ${named}`, onclick: () => this.removeOwn(role) }, 'remove'));
  }

  /** Sends the files to the server, which reads them; then asks how the mesh is meant, and the others beside it. */
  async drop(files) {
    this.refuse('files', '');
    const most = this.document.most_file_bytes;
    const tooLarge = files.find(({ size }) => size > most);
    if (tooLarge) return this.refuse('files', `${tooLarge.name}: has ${Math.round(tooLarge.size / 2 ** 20)} MiB, a dropped file may have ${most / 2 ** 20}; doorforge compose takes 512`);
    const kept = {};
    const meshes = [];
    for (const file of files) {
      const bytes = await this.ask('files', `/file?name=${encodeURIComponent(file.name)}`, file);
      if (bytes === null) return;
      const content = await Content.fromBytes(bytes);
      kept[content.document.name] = content.document.file;
      if (content.document.shown.length > 0) meshes.push(content);
    }
    if (meshes.length === 0) return this.refuse('files', 'drop a mesh: STL, OBJ or GLB');
    this.offer(meshes, meshes[0], kept);
  }

  /** Asks about one of several meshes; those that are not fixed around it come after it, a leaf after a handle and the other way round. */
  offer(meshes, mesh, files, role = 'handle') {
    this.offered?.dispose();
    const own = new OwnMesh(mesh, meshes.filter((other) => other !== mesh), {
      applied: () => {
        this.putOn(own);
        const left = own.others.filter(({ document }) => document.name !== own.beside);
        if (left.length > 0) this.offer(left, left[0], files, own.role === 'handle' ? 'body' : 'handle');
      },
      closed: () => !Object.values(this.own).includes(own) && own.dispose(),
      instead: (name) => this.offer(meshes, meshes.find(({ document }) => document.name === name), files, own.role),
    });
    Object.assign(own, { files, role });
    this.offered = own;
    own.show(this.element);
  }

  putOn(own) {
    const other = this.own[own.role === 'body' ? 'handle' : 'body'];
    const twice = Object.keys(own.files).find((name) => other && other !== own && name in other.files && other.files[name] !== own.files[name]);
    if (twice) return this.refuse('files', `${twice}: another file of this name is on the door; rename one of them`);
    for (const [role, before] of Object.entries(this.own)) {
      if (before === own) this.forget(role); // it was the other half
      else if (role === own.role) before.dispose();
    }
    this.own[own.role] = own;
    this.offered = null;
    this.ownRows[own.role].firstChild.textContent = `${own.role === 'body' ? 'leaf' : 'handle'}: ${own.name}${own.beside ? `, with ${own.beside}` : ''}`;
    this.ownRows[own.role].hidden = false;
    this.refreshShelf();
    this.changed(0);
  }

  removeOwn(role) {
    this.own[role].dispose();
    this.forget(role);
    this.refreshShelf();
    this.changed(0);
  }

  forget(role) {
    delete this.own[role];
    this.ownRows[role].hidden = true;
  }

  refreshShelf() {
    for (const grid of Object.values(this.grids)) grid.refresh();
  }

  /** A refusal stays until the same is asked again or the user goes on; an answer to something else takes nothing away. */
  refuse(asked, message) {
    this.refusals[asked] = message;
    this.tell();
  }

  tell() {
    const said = Object.values(this.refusals).filter(Boolean).join('; ');
    this.status.textContent = said || (this.pending > 0 ? 'asking ...' : '');
    this.status.classList.toggle('refused', said !== '');
  }

  // The settings behind "More": numbers that are empty as by default, choices, words.
  more() {
    const { settings, presets } = this.document;
    const numbers = MORE_NUMBERS.map(([key, title, min, step]) => h('div', {}, h('label', { for: key }, title), h('input', { type: 'number', id: key, min, step, placeholder: settings[key] > 0 ? settings[key] : key === 'seed' ? 'none' : 'as made', oninput: ({ target }) => this.set(key, target.value === '' ? null : Number(target.value)) })));
    const pick = (key, title, values, read) => h('div', {}, h('label', { for: key }, title), h('select', { id: key, onchange: ({ target }) => this.set(key, read(target.value)) }, values.map((value) => h('option', { value, selected: value === settings[key] }, value))));
    const choices = MORE_CHOICES.map(([key, title, values]) => pick(key, title, values, (text) => (typeof values[0] === 'number' ? Number(text) : text)));
    const chosenPresets = Object.entries(presets).map(([key, values]) => pick(key, key === 'joints' ? 'Springs and damping of' : 'Masses of', values, (text) => text));
    const words = [['id', 'Id of the door', (text) => text || null], ['license_allow', 'Licences allowed', (text) => (text.trim() === '' ? null : text.split(',').map((word) => word.trim()))]]
      .map(([key, title, read]) => h('div', {}, h('label', { for: key }, title), h('input', { type: 'text', id: key, placeholder: key === 'id' ? 'of its parts' : 'any', oninput: ({ target }) => this.set(key, read(target.value)) })));
    const checks = MORE_CHECKS.map(([key, title]) => h('div', { class: 'check' }, h('input', { type: 'checkbox', id: key, onchange: ({ target }) => this.set(key, target.checked) }), h('label', { for: key }, title)));
    return h('details', { class: 'more' }, h('summary', {}, 'More settings'), h('div', { class: 'settings' }, choices, numbers, chosenPresets, words, checks));
  }

  controls() {
    const length = ([key, title]) => h('div', {}, h('label', { for: key }, `${title} [m]`), h('input', { type: 'number', id: key, min: 0, max: 4, step: 0.01, placeholder: 'as made', oninput: ({ target }) => this.set(key, target.value === '' ? null : Number(target.value)) }));
    const pick = ([key, title, values]) => h('div', {}, h('label', { for: key }, title), h('select', { id: key, onchange: ({ target }) => this.set(key, target.value) }, values.map((value) => h('option', { value }, value.replace('_', ' ')))));
    const scale = h('div', {}, h('label', { for: 'handle_scale' }, 'Handle scale'), h('input', { type: 'number', id: 'handle_scale', min: 0.5, max: 2, step: 0.05, value: 1, oninput: ({ target }) => this.set('handle_scale', target.value === '' ? null : Number(target.value)) }));
    const mirrored = h('div', { class: 'check' }, h('input', { type: 'checkbox', id: 'handle_mirrored', onchange: ({ target }) => this.set('handle_mirrored', target.checked) }), h('label', { for: 'handle_mirrored' }, 'Handle mirrored'));
    this.format = h('select', { id: 'format' }, h('option', { value: '' }, 'door folder'), this.document.formats.map((value) => h('option', { value }, value)));
    return h('section', { class: 'controls', 'aria-label': 'settings' },
      h('form', { onsubmit: (event) => event.preventDefault() }, h('div', { class: 'settings' }, LENGTHS.map(length), scale, CHOICES.map(pick), mirrored), this.more()),
      h('div', { class: 'actions' },
        h('button', { type: 'button', id: 'open', onclick: () => this.open() }, 'Does it open?'),
        h('div', {}, h('label', { for: 'format' }, 'Download as'), this.format), h('button', { type: 'button', id: 'download', onclick: () => this.download() }, 'Download'), this.status),
      h('p', { class: 'command' }, this.command, this.copy, this.copyYaml), this.notes);
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
      this.chosen[role] = parts[0]?.id ?? '';
      this.grids[role].show(parts);
    }
    this.changed(0);
  }

  card(role) {
    const image = h('img', { alt: '', width: 128, height: 96, onload: () => (image.style.visibility = 'visible') });
    const name = h('span', { class: 'name' });
    let part = null;
    const button = h('button', { type: 'button', class: 'open', onclick: () => {
      this.chosen[role] = part.id;
      if (this.own[role]) this.removeOwn(role);
      this.grids[role].refresh();
      this.changed(0);
    } }, image, name);
    return {
      element: h('li', { class: 'card part' }, button),
      fill: (item) => {
        if (part !== item) {
          image.style.visibility = 'hidden'; // until it has come: a browser shows the one before
          image.src = `/thumbnail/${encodeURIComponent(item.id)}`;
        }
        part = item;
        name.textContent = item.id;
        button.setAttribute('aria-pressed', String(this.chosen[role] === item.id && !this.own[role]));
      },
    };
  }

  set(key, value) {
    if (value === null) delete this.settings[key];
    else this.settings[key] = value;
    this.changed(PAUSE);
  }

  get request() {
    const asked = { ...this.chosen, settings: this.settings };
    const own = Object.entries(this.own);
    for (const [role, { name, asked: mesh, files }] of own) Object.assign(asked, { [role]: name, [`${role}_mesh`]: mesh, files: { ...asked.files, ...files } });
    if (own.length === 2) asked.category = this.category.value; // nothing else tells it
    return JSON.stringify(asked);
  }

  changed(pause) {
    this.refusals = {};
    this.tell();
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.compose(), pause);
  }

  /** The bytes of an answer; what is refused is said if it `counts` still, and gives null. */
  async ask(asked, path, request, counts = () => true) {
    const type = request instanceof Blob ? 'application/octet-stream' : 'application/json';
    ++this.pending;
    this.tell();
    let bytes = null;
    let message = '';
    try {
      const answer = await fetch(path, { method: 'POST', headers: { 'Content-Type': type }, body: request });
      if (answer.ok) bytes = new Uint8Array(await answer.arrayBuffer());
      else message = (await answer.json()).error;
    } catch {
      message = 'the server does not answer; is doorforge serve still running?';
    }
    --this.pending;
    if (message && counts()) this.refusals[asked] = message;
    this.tell();
    return bytes;
  }

  async compose() {
    const { request } = this;
    const counts = () => request === this.request; // else another one is on its way
    const bytes = await this.ask('door', '/compose', request, counts);
    if (bytes === null || !counts()) return;
    const content = await Content.fromBytes(bytes);
    this.composed = request;
    this.view.use(content);
    this.view.load(content.document.records[0]);
    this.command.textContent = this.copy.text = content.document.command;
    this.copyYaml.text = content.document.yaml;
    this.notes.replaceChildren(...content.document.notes.map((note) => h('li', {}, note)));
    this.notes.hidden = content.document.notes.length === 0;
    document.documentElement.dataset.composed = request;
  }

  async open() {
    const bytes = await this.ask('film', '/open', this.request);
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
    const bytes = await this.ask('download', `/download?format=${format}`, this.request);
    if (bytes === null) return;
    const link = h('a', { href: URL.createObjectURL(new Blob([bytes], { type: 'application/zip' })), download: `${this.view.record.id}${format ? `_${format}` : ''}.zip` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    this.downloaded = bytes;
  }
}
