// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A file from outside with what `doorforge validate` says of it: each finding at its place.

import { ObjectModel, canMove } from './object_model.js';
import { RecordView } from './record_view.js';
import { angleSlider, choice, h, number, toggle } from './dom.js';

const MOST_SLIDERS = 40;

const metreSlider = (title, [least, most], changed) => {
  const id = `slider-${title.replace(/\W+/g, '-').toLowerCase()}`;
  const value = h('output', { for: id }, '0 m');
  const input = h('input', { type: 'range', id, min: least, max: most, step: 'any', value: 0, oninput: () => changed(Number(input.value)) });
  const row = h('div', { class: 'slider' }, h('label', { for: id }, title), input, value);
  row.set = (metres) => {
    input.value = metres;
    value.textContent = `${number(metres)} m`;
    input.setAttribute('aria-valuetext', value.textContent);
  };
  return row;
};

export class ObjectView extends RecordView {
  constructor(content) {
    super(content);
    this.shown = { shapes: 'both', frames: false, pins: true };
    this.chip.hidden = true;
  }

  addTools() {
    this.tools.append(
      choice('shapes', [['visual', 'Visual'], ['collision', 'Collision'], ['both', 'Both']], 'both', (shapes) => this.show({ shapes })),
      h('div', { class: 'choice', role: 'group', 'aria-label': 'marks' },
        toggle('Frames', false, (frames) => this.show({ frames })),
        toggle('Numbers', true, (pins) => this.show({ pins }))),
      h('div', { class: 'choice', role: 'group', 'aria-label': 'look at' },
        h('button', { type: 'button', onclick: () => this.frameAll() }, 'All'),
        h('button', { type: 'button', onclick: () => this.step(-1) }, 'Previous finding'),
        h('button', { type: 'button', onclick: () => this.step(1) }, 'Next finding')));
  }

  load(item) {
    if (this.model) this.stage.scene.remove(this.model.root);
    this.item = item;
    this.chosen = null;
    this.values = (item.object?.joints ?? []).map(({ lower, upper }) => Math.min(Math.max(0, lower), upper));
    this.model = new ObjectModel({ ...item, object: item.object ?? { links: [], shapes: [], joints: [] } }, this.shapes, () => this.stage.changed());
    this.stage.scene.add(this.model.root);
    this.fillPanel();
    this.model.mark(null);
    this.model.show(this.shown);
    this.model.pose(this.values);
    this.picked.textContent = '';
    this.placeFloor();
    this.frameAll();
  }

  // Objects from outside need not stand at z = 0.
  placeFloor() {
    const box = this.model.box();
    this.stage.floor.position.z = box.min.z;
    this.stage.floor.visible = box.max.z - box.min.z > 0.2;
  }

  fillPanel() {
    const { item } = this;
    const count = (n, word) => `${n} ${word}${n === 1 ? '' : 's'}`;
    this.panel.replaceChildren(...[
      h('section', { 'aria-label': 'identity' },
        h('h1', {}, item.path), h('p', { class: 'soft' }, `${item.kind}, ${count(item.errors, 'error')}, ${count(item.warnings, 'warning')}`)),
      item.not_drawn ? h('p', { class: 'fault' }, item.not_drawn) : null,
      this.findings(), this.jointSliders(), this.notes()].filter(Boolean));
  }

  findings() {
    const { findings } = this.item;
    this.buttons = findings.map((finding, i) => h('button', { type: 'button', class: `finding ${finding.severity}`, 'data-code': finding.code, 'aria-pressed': 'false', onclick: () => this.choose(i) },
      h('b', {}, `${i + 1}. ${finding.code} ${finding.severity}`), h('span', {}, finding.rule),
      h('span', { class: 'soft' }, finding.where),
      h('span', { class: 'soft' }, `Measured ${finding.measured}; allowed: ${finding.allowed}`),
      h('span', { class: 'soft' }, `To fix: ${finding.fix}`)));
    return h('section', {}, h('h2', {}, `Findings: ${findings.length}`),
      findings.length ? h('ul', { class: 'findings' }, this.buttons.map((button) => h('li', {}, button))) : h('p', { class: 'soft' }, 'None.'));
  }

  jointSliders() {
    const joints = (this.item.object?.joints ?? []).map((joint, i) => ({ joint, i })).filter(({ joint }) => canMove(joint));
    if (joints.length === 0) return null;
    const rows = joints.slice(0, MOST_SLIDERS).map(({ joint, i }) => {
      const make = joint.type === 'prismatic' ? metreSlider : angleSlider;
      const row = make(joint.name || `joint ${i + 1}`, [joint.lower, joint.upper], (value) => {
        this.values[i] = Math.min(Math.max(value, joint.lower), joint.upper);
        row.set(this.values[i]);
        this.model.pose(this.values);
      });
      row.set(this.values[i]);
      return row;
    });
    const more = joints.length > rows.length ? h('p', { class: 'soft' }, `${joints.length - rows.length} more joints are not listed.`) : null;
    return h('section', { class: 'joints' }, h('h2', {}, 'Joints'), ...rows, more ?? '');
  }

  notes() {
    const notes = [...this.item.notes, ...(this.item.object?.left_out ?? [])];
    if (notes.length === 0) return null;
    return h('section', {}, h('h2', {}, 'Notes'), h('ul', { class: 'notes' }, notes.map((note) => h('li', {}, note))));
  }

  step(by) {
    const { length } = this.item.findings;
    if (length) this.choose(((this.chosen ?? (by > 0 ? -1 : 0)) + by + length) % length);
  }

  /** Shows what a finding is about. */
  choose(i) {
    this.chosen = i;
    const finding = this.item.findings[i];
    this.model.show(this.shown);
    const box = this.model.mark(i);
    this.buttons.forEach((button, k) => button.setAttribute('aria-pressed', String(k === i)));
    this.buttons[i].scrollIntoView({ block: 'nearest' });
    this.picked.textContent = `${i + 1}. ${finding.code}: ${this.placeOf(finding)}`;
    if (box.isEmpty()) this.frameAll();
    else this.stage.frame(box.expandByScalar(0.05 * this.model.size), { keep: true });
  }

  placeOf({ mark }) {
    const { object } = this.item;
    const has = (value) => value !== null && value !== undefined;
    if (!object || !mark) return 'the file as a whole';
    if (mark.edges) return `${mark.edges.count} edges of ${object.shapes[mark.shape].name}`;
    if (has(mark.joint)) return `joint ${object.joints[mark.joint].name}`;
    if (has(mark.shape)) return `shape ${object.shapes[mark.shape].name} of link ${object.links[mark.link].name}`;
    if (has(mark.link)) return `link ${object.links[mark.link].name}`;
    return 'the file as a whole';
  }

  click({ offsetX, offsetY }) {
    if (this.down && Math.hypot(offsetX - this.down[0], offsetY - this.down[1]) > 4) return; // it was a turn
    const pin = this.shown.pins ? this.stage.pick(offsetX, offsetY, this.model.pins()) : null;
    if (pin) return this.choose(pin.object.userData.finding);
    const shape = this.stage.pick(offsetX, offsetY, this.model.meshes())?.object.userData.shape;
    this.picked.textContent = shape ? `${shape.name}, on link ${this.item.object.links[shape.link].name}` : '';
  }
}
