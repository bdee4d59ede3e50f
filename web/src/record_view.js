// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A door or a part: the stage with its buttons, and beside it sliders, facts and findings.

import { LiveLatch } from './latch.js';
import { linkPoses } from './kinematics.js';
import { Model, Shapes } from './model.js';
import { Stage } from './stage.js';
import { angleSlider, choice, copyButton, degrees, h, number, toggle } from './dom.js';

const angle = (radians) => `${number(degrees(radians))}°`;

export class RecordView {
  constructor(content) {
    this.content = content;
    this.shapes = new Shapes(content);
    this.shown = { shapes: 'visual', frames: false, grasp: false, scale: true };
    this.canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-label': '3D view. Arrow keys turn it, with Shift they move it, plus and minus zoom, Home shows all.' });
    this.chip = h('p', { class: 'chip', role: 'status' });
    this.picked = h('p', { class: 'picked', role: 'status' });
    this.holder = h('div', { class: 'canvas' }, this.canvas, this.chip, this.picked);
    this.tools = h('div', { class: 'tools', role: 'toolbar', 'aria-label': 'what is drawn' });
    this.panel = h('div', { class: 'panel', tabindex: 0, role: 'region', 'aria-label': 'facts' });
    this.element = h('div', { class: 'record' }, h('section', { class: 'stage', 'aria-label': 'the door in 3D' }, this.holder, this.tools), this.panel);
  }

  /** To be called once the element is in the page. */
  start() {
    this.stage = new Stage(this.canvas);
    this.stage.home = () => this.frameAll();
    this.canvas.addEventListener('pointerdown', ({ offsetX, offsetY }) => (this.down = [offsetX, offsetY]));
    this.canvas.addEventListener('click', (event) => this.click(event));
    this.addTools();
  }

  addTools() {
    this.tools.append(
      choice('shapes', [['visual', 'Visual'], ['collision', 'Collision'], ['both', 'Both']], 'visual', (shapes) => this.show({ shapes })),
      h('div', { class: 'choice', role: 'group', 'aria-label': 'marks' },
        toggle('Frames', false, (frames) => this.show({ frames })),
        toggle('Grasp', false, (grasp) => this.show({ grasp })),
        toggle('Scale', true, (scale) => this.show({ scale }))),
      h('div', { class: 'choice', role: 'group', 'aria-label': 'look at' },
        h('button', { type: 'button', onclick: () => this.frameAll() }, 'All'),
        h('button', { type: 'button', onclick: () => this.frameHandle() }, 'Handle'),
        h('button', { type: 'button', onclick: () => this.play() }, 'Play')));
  }

  /** Takes its meshes from another content from now on. */
  use(content) {
    this.content = content;
    this.shapes.dispose();
    this.shapes = new Shapes(content);
  }

  load(record) {
    this.stop();
    if (this.model) this.stage.scene.remove(this.model.root);
    this.record = record;
    this.latch = new LiveLatch(record);
    this.model = new Model(record, this.shapes, () => this.stage.changed());
    this.stage.scene.add(this.model.root);
    this.stage.floor.visible = !(record.kind === 'part' && record.role === 'handle');
    this.fillPanel();
    this.model.show(this.shown);
    this.moved();
    this.frameAll();
  }

  show(change) {
    Object.assign(this.shown, change);
    this.model.show(this.shown);
  }

  frameAll() {
    this.stage.frame(this.model.box());
  }

  frameHandle() {
    this.stage.frame(this.model.handleBox());
  }

  get isPartOfHandle() {
    return this.record.kind === 'part' && this.record.role === 'handle';
  }

  // A part has one joint, which its kind tells; a door two.
  angles() {
    return this.record.joints.length === 2 ? [this.latch.hinge, this.latch.handle] : [this.latch.hinge];
  }

  turnHandle(radians) {
    this.latch.turnHandle(radians);
    this.moved();
  }

  moveHinge(radians) {
    this.latch.moveHinge(radians);
    this.moved();
  }

  moved() {
    this.poses = linkPoses(this.record, this.angles());
    this.model.pose(this.poses, this.latch.bolt);
    this.sliders.forEach((slider, i) => slider.set(this.angles()[i]));
    const latched = this.record.latch.type !== 'none';
    this.chip.hidden = !latched;
    this.chip.dataset.locked = this.latch.isLocked();
    this.chip.textContent = this.latch.isLocked() ? 'Locked' : 'Free';
  }

  fillPanel() {
    const { record } = this;
    const [first, second] = record.joints;
    const handleOnly = this.isPartOfHandle;
    this.sliders = [angleSlider(handleOnly ? 'Handle' : 'Hinge', [first.lower_rad, first.upper_rad], (a) => this.moveHinge(a))];
    if (second) this.sliders.push(angleSlider('Handle', [second.lower_rad, second.upper_rad], (a) => this.turnHandle(a)));
    this.panel.replaceChildren(
      h('section', { 'aria-label': 'identity' },
        h('h1', {}, record.id), h('p', { class: 'soft' }, this.subtitle(), ' ', copyButton(record.id, 'id'))),
      ...(record.faults ?? []).map((fault) => h('p', { class: 'fault', role: 'alert' }, fault)),
      h('section', {}, h('h2', {}, 'Joints'), ...this.sliders, this.unlockNote()),
      ...[this.findings(), this.facts()].filter(Boolean));
  }

  subtitle() {
    const { record } = this;
    const words = [record.category, record.mechanism === 'none' ? null : record.mechanism, record.kind === 'part' ? record.role : null];
    return words.filter(Boolean).join(', ');
  }

  unlockNote() {
    const { latch } = this.record;
    if (latch.type === 'none') return null;
    const law = latch.type === 'bolt' ? 'A bolt behind a strike' : `An effort of ${number(latch.lock_effort_nm)} N m`;
    return h('p', { class: 'soft' }, `${law} holds the leaf until the handle has turned ${angle(latch.unlock_angle_rad)}.`);
  }

  findings() {
    const { findings } = this.record;
    if (!findings) return null;
    const list = findings.map((finding) => h('li', {}, h('button', { type: 'button', class: `finding ${finding.severity}`, 'data-code': finding.code, onclick: () => this.point(finding) },
      h('b', {}, `${finding.code} ${finding.severity}`), h('span', {}, finding.rule),
      h('span', { class: 'soft' }, `${finding.where}: ${finding.measured}; allowed: ${finding.allowed}`),
      h('span', { class: 'soft' }, `To fix: ${finding.fix}`))));
    return h('section', {}, h('h2', {}, `Findings: ${findings.length}`),
      findings.length ? h('ul', { class: 'findings' }, list) : h('p', { class: 'soft' }, 'None by the rules of doorforge validate (profile physics).'));
  }

  facts() {
    const { record } = this;
    const size = this.model.box().getSize(this.stage.camera.position.clone());
    const rows = [
      ['Width, height, depth', `${size.y.toFixed(3)} x ${size.z.toFixed(3)} x ${size.x.toFixed(3)} m`],
      record.body ? ['Body', record.body] : null,
      record.handle ? ['Handle', record.handle] : null,
      record.hinge_side ? ['Hinged, opens', `${record.hinge_side}, ${record.opening}`] : null,
      ...record.links.map(({ name, mass_kg }) => [`Mass of ${name}`, `${number(mass_kg)} kg`]),
      ...record.joints.map((joint) => [`Limits of ${joint.name}`, `${angle(joint.lower_rad)} to ${angle(joint.upper_rad)}`]),
      ...record.joints.filter(({ effort_limit_nm }) => effort_limit_nm).map((joint) => [`Effort of ${joint.name}`, `${number(joint.effort_limit_nm)} N m, damping ${number(joint.damping_nm_s)} N m s`]),
      ...this.latchFacts(),
      ['Licence', record.license || 'none stated'],
      record.source ? ['Source', record.source] : null,
      record.physics_source ? ['Physics from', record.physics_source] : null,
    ];
    return h('section', {}, h('h2', {}, 'Record'), h('dl', {}, rows.filter(Boolean).map(([term, text]) => h('div', {}, h('dt', {}, term), h('dd', {}, text)))));
  }

  latchFacts() {
    const { latch } = this.record;
    if (this.record.kind === 'part') return [];
    if (latch.type === 'none') return [['Latch', 'none']];
    return [
      ['Latch', latch.type === 'bolt' ? `bolt, ${number(1000 * latch.bolt_throw_m)} mm` : `effort, ${number(latch.lock_effort_nm)} N m`],
      ['Unlocks at', angle(latch.unlock_angle_rad)],
      ['Handle done at', angle(latch.handle_done_angle_rad)],
      ['Springs', `hinge ${number(latch.hinge_spring_nm_per_rad)}, handle ${number(latch.handle_spring_nm_per_rad)} N m/rad`],
    ];
  }

  /** Shows what a finding is about. */
  point(finding) {
    const box = this.model.mark(finding.places);
    this.marked = finding.places;
    this.picked.textContent = `${finding.code}: ${finding.places.join(', ') || 'the record as a whole'}`;
    if (!box.isEmpty()) this.stage.frame(box.expandByScalar(0.05), { keep: true });
  }

  click({ offsetX, offsetY }) {
    if (this.down && Math.hypot(offsetX - this.down[0], offsetY - this.down[1]) > 4) return; // it was a turn
    const hit = this.stage.pick(offsetX, offsetY, this.model.meshes());
    const piece = hit?.object.userData.piece;
    this.marked = piece ? [piece.name] : [];
    this.model.mark(this.marked);
    this.picked.textContent = piece ? `${piece.name}, on link ${this.record.links[piece.link].name}` : '';
  }

  stop() {
    this.playing = false;
  }

  /** Turns the handle, opens the door, lets go of the handle and shuts the door. */
  async play() {
    if (this.playing) return this.stop();
    this.playing = true;
    const { record } = this;
    const open = record.joints[0].upper_rad;
    const turned = Math.min((record.latch.handle_done_angle_rad || record.joints[1]?.upper_rad) ?? 0, record.joints[1]?.upper_rad ?? 0);
    const handle = (a) => this.turnHandle(a);
    const hinge = (a) => this.moveHinge(a);
    await this.sweep(hinge, 0, 0, 100);
    if (turned > 0) await this.sweep(handle, 0, turned, 700);
    await this.sweep(hinge, 0, open, 1200);
    if (turned > 0) await this.sweep(handle, turned, 0, 400);
    await this.sweep(hinge, open, 0, 1200);
    this.stop();
  }

  async sweep(move, from, to, duration) {
    const start = performance.now();
    for (let share = 0; share < 1 && this.playing; ) {
      share = Math.min(1, (performance.now() - start) / duration);
      move(from + (to - from) * share * share * (3 - 2 * share));
      await new Promise(requestAnimationFrame);
    }
  }
}
