// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// An episode as it was stored: robot and door at each instant, what the camera saw, where the hand was to go.

import { ArrowHelper, BufferAttribute, BufferGeometry, Color, Group, Matrix4, Mesh, MeshLambertMaterial, Points, PointsMaterial, Quaternion, SRGBColorSpace, Vector3 } from 'three';

import { curves } from './curves.js';
import { degrees, h, toggle } from './dom.js';
import { drawnBy } from './latch.js';
import { Model, Shapes } from './model.js';
import { Stage } from './stage.js';

const LABELS = [['body', 0x3b7dd8], ['handle', 0xe8842a], ['frame', 0x8a949e], ['robot', 0x3fa66b], ['other', 0x9466c4]]; // PointLabel
const NUMBERS = 7; // of a pose: position and quaternion

export class EpisodeView {
  constructor(content) {
    this.content = content;
    this.document = content.document;
    this.shapes = new Shapes(content);
    this.canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-label': '3D view of the episode. Arrow keys turn it, with Shift they move it, plus and minus zoom, Home shows all.' });
    this.chip = h('p', { class: 'chip', role: 'status' });
    this.play = h('button', { type: 'button', onclick: () => this.toggle() }, 'Play');
    this.time = h('output', { for: 'time' });
    this.slider = h('input', { type: 'range', id: 'time', step: 'any', min: 0, oninput: () => this.pause() || this.show(Number(this.slider.value)), onkeydown: (event) => this.key(event) });
    this.panel = h('div', { class: 'panel', tabindex: 0, role: 'region', 'aria-label': 'facts' });
    const scrubber = h('div', { class: 'scrubber' }, this.play, h('label', { for: 'time' }, 'Time'), this.slider, this.time);
    this.tools = h('div', { class: 'tools', role: 'toolbar', 'aria-label': 'what is drawn' });
    this.element = h('div', { class: 'record' }, h('section', { class: 'stage', 'aria-label': 'the episode in 3D' }, h('div', { class: 'canvas' }, this.canvas, this.chip), scrubber, this.tools), this.panel);
  }

  start() {
    this.stage = new Stage(this.canvas);
    this.stage.home = () => this.frameAll();
    this.robot = this.makeRobot();
    this.stage.scene.add(this.robot);
    this.arrow = new ArrowHelper(new Vector3(1, 0, 0), new Vector3(), 0.1, 0xd22b6f, 0.03, 0.02);
    this.stage.scene.add(this.arrow);
    const see = (name, text) => toggle(text, true, (value) => {
      this[name] = value;
      this.show(this.at);
    });
    this.withRobot = this.withCloud = this.withAction = true;
    this.tools.append(
      h('div', { class: 'choice', role: 'group', 'aria-label': 'marks' }, see('withRobot', 'Robot'), (this.cloudToggle = see('withCloud', 'Cloud')), see('withAction', 'Action')),
      h('div', { class: 'choice', role: 'group', 'aria-label': 'look at' }, h('button', { type: 'button', onclick: () => this.frameAll() }, 'All'), h('button', { type: 'button', onclick: () => this.frameHand() }, 'Hand')));
  }

  makeRobot() {
    const { robot } = this.document;
    const group = new Group();
    this.bodies = Array.from({ length: robot.bodies }, () => Object.assign(new Group(), { matrixAutoUpdate: false }));
    group.add(...this.bodies);
    for (const { mesh, color: [r, g, b], body } of robot.pieces) {
      const material = new MeshLambertMaterial();
      material.color.setRGB(r, g, b, SRGBColorSpace);
      this.bodies[body].add(new Mesh(this.shapes.geometry(mesh), material));
    }
    return group;
  }

  load(episode) {
    this.pause();
    if (this.model) this.stage.scene.remove(this.model.root);
    if (this.points) this.stage.scene.remove(this.points);
    this.episode = episode;
    this.record = this.document.records[episode.record];
    this.model = new Model(this.record, this.shapes, () => this.stage.changed());
    this.model.show({ shapes: 'visual', frames: false, grasp: false, scale: false });
    this.stage.scene.add(this.model.root);
    this.frameCount = episode.times.length;
    this.poseCount = 3 + this.document.robot.bodies;
    this.numbers = this.content.floats(episode.poses, this.frameCount * this.poseCount * NUMBERS);
    this.clouds = this.readClouds();
    this.cloudToggle.hidden = this.clouds === null;
    this.charts = this.makeCharts();
    this.slider.max = this.frameCount - 1;
    this.fillPanel();
    this.show(0);
    this.frameAll();
  }

  readClouds() {
    const { cloud } = this.episode;
    this.points = null;
    if (!cloud) return null;
    const total = cloud.counts.reduce((sum, count) => sum + count, 0);
    const at = this.content.start;
    const steps = new Int16Array(this.content.buffer, at + cloud.points, total * 3);
    const labels = new Uint8Array(this.content.buffer, at + cloud.labels, total);
    this.points = new Points(new BufferGeometry(), new PointsMaterial({ size: 3, sizeAttenuation: false, vertexColors: true }));
    this.points.frustumCulled = false;
    this.stage.scene.add(this.points);
    let begin = 0;
    return cloud.counts.map((count) => {
      const range = [begin, (begin += count)];
      return { steps: steps.subarray(3 * range[0], 3 * range[1]), labels: labels.subarray(...range) };
    });
  }

  fillPanel() {
    const { episode } = this;
    const seen = this.clouds ? LABELS.filter((_, label) => this.clouds.some(({ labels }) => labels.includes(label))) : [];
    this.panel.replaceChildren(
      h('section', {}, h('h1', {}, episode.title)),
      (this.now = h('p', { role: 'status' })),
      ...this.charts.map(({ title, chart, keys, note }) => h('section', {}, h('h2', {}, title), chart,
        h('p', { class: 'soft' }, keys.flatMap(([name, text]) => [h('span', { class: `key ${name}` }), `${text} `])), note ? h('p', { class: 'soft' }, note) : null)),
      ...(seen.length ? [h('section', {}, h('h2', {}, 'Cloud'), h('ul', { class: 'legend' }, seen.map(([name, color]) => h('li', {}, h('span', { class: 'key', style: `background:#${color.toString(16)}` }), name))))] : []),
      h('section', {}, h('h2', {}, 'Episode'), h('dl', {}, episode.facts.map(([term, text]) => h('div', {}, h('dt', {}, term), h('dd', {}, text))))));
    this.chip.textContent = episode.opened ? 'Opened' : 'Not opened';
    this.chip.dataset.locked = !episode.opened;
  }

  // Angles, forces and what was hidden, as far as the episode has them.
  makeCharts() {
    const { times, hinge, handle, force, net_force: netForce, hidden } = this.episode;
    const angles = { title: 'Angles', unit: '°', least: 0, most: 10, series: [['hinge', hinge.map(degrees)], ['handle', handle.map(degrees)]], keys: [['hinge', 'hinge'], ['handle', 'handle']] };
    const forces = force && { title: 'Forces on the door', unit: ' N', least: 0, most: 10, series: [['grip', force], ['net', netForce]], keys: [['grip', 'all contacts'], ['net', 'beyond the squeeze of the fingers']], note: 'At the instants shown; between them they may be greater.' };
    const names = Object.keys(hidden ?? {});
    const shares = names.length > 0 && { title: 'Hidden from the camera', unit: ' %', least: 0, most: 100, series: names.map((name, i) => [`hidden-${i}`, hidden[name].map((share) => 100 * share)]), keys: names.map((name, i) => [`hidden-${i}`, name]) };
    return [angles, forces, shares].filter(Boolean).map((drawn) => ({ ...drawn, chart: curves({ times, ...drawn }) }));
  }

  // The pose of a body between two frames.
  pose(body, frame, share) {
    const read = (f) => {
      const at = (f * this.poseCount + body) * NUMBERS;
      const n = this.numbers;
      return [new Vector3(n[at], n[at + 1], n[at + 2]), new Quaternion(n[at + 3], n[at + 4], n[at + 5], n[at + 6]).normalize()];
    };
    const [position, turn] = read(frame);
    if (share > 0) {
      const [next, nextTurn] = read(frame + 1);
      position.lerp(next, share);
      turn.slerp(nextTurn, share);
    }
    return new Matrix4().compose(position, turn, new Vector3(1, 1, 1));
  }

  mixed(numbers, frame, share) {
    return share > 0 ? numbers[frame] * (1 - share) + numbers[frame + 1] * share : numbers[frame];
  }

  /** Shows an instant: frame numbers with fractions between them. */
  show(at) {
    this.at = Math.min(Math.max(at, 0), this.frameCount - 1);
    const { episode } = this;
    const frame = Math.min(Math.floor(this.at), this.frameCount - 1);
    const share = this.at - frame;
    const door = [0, 1, 2].map((body) => this.pose(body, frame, share).elements);
    const handle = this.mixed(episode.handle, frame, share);
    const bolt = episode.bolt[frame] === null ? (this.record.bolt ? drawnBy(this.record.bolt, handle) : 0) : -episode.bolt[frame];
    this.poses = door;
    this.model.pose(door, bolt);
    this.bodies.forEach((body, i) => {
      body.matrix.copy(this.pose(3 + i, frame, share));
      body.matrixWorldNeedsUpdate = true;
    });
    this.robot.visible = this.withRobot;
    this.showCloud(frame);
    this.showAction(frame);
    this.slider.value = this.at;
    const seconds = this.mixed(episode.times, frame, share);
    this.time.textContent = `${seconds.toFixed(2)} s`;
    this.slider.setAttribute('aria-valuetext', `${seconds.toFixed(2)} seconds`);
    for (const { chart } of this.charts) chart.at(seconds);
    const force = episode.force ? `, ${this.mixed(episode.force, frame, share).toFixed(0)} N` : '';
    this.now.textContent = `${episode.phases[frame]}: hinge ${degrees(this.mixed(episode.hinge, frame, share)).toFixed(1)}°, handle ${degrees(handle).toFixed(1)}°${force}`;
    this.stage.changed();
  }

  // What the camera saw last.
  showCloud(frame) {
    if (!this.points) return;
    let last = frame;
    while (last > 0 && this.clouds[last].labels.length === 0) --last;
    const { steps, labels } = this.clouds[last];
    this.points.visible = this.withCloud && labels.length > 0;
    if (this.shownCloud === steps) return;
    this.shownCloud = steps;
    const { origin, step } = this.episode.cloud;
    const positions = Float32Array.from(steps, (count, i) => origin[i % 3] + step * count);
    const colors = new Float32Array(positions.length);
    const palette = LABELS.map(([, color]) => new Color(color).toArray());
    labels.forEach((label, i) => colors.set(palette[label] ?? palette[4], 3 * i));
    this.points.geometry.dispose();
    this.points.geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(positions, 3)).setAttribute('color', new BufferAttribute(colors, 3));
  }

  showAction(frame) {
    const asked = this.episode.asked[frame];
    this.arrow.visible = this.withAction && asked !== null;
    if (!this.arrow.visible) return;
    const from = new Vector3(...this.episode.hands[frame]);
    const way = new Vector3(...asked).sub(from);
    this.arrow.position.copy(from);
    this.arrow.setDirection(way.clone().normalize());
    this.arrow.setLength(Math.max(0.02, way.length()), 0.03, 0.02);
  }

  frameAll() {
    const box = this.model.box();
    const base = new Vector3().setFromMatrixPosition(this.pose(this.poseCount - 1, 0, 0));
    box.expandByPoint(new Vector3(...this.episode.hands[0])).expandByPoint(base).expandByScalar(0.25);
    this.stage.frame(box, { azimuth: -0.9 });
  }

  frameHand() {
    const box = this.model.handleBox();
    this.stage.frame(box.expandByScalar(0.12), { keep: true });
  }

  key(event) {
    const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (!steps) return;
    event.preventDefault();
    this.pause();
    this.show(Math.round(this.at) + steps);
  }

  pause() {
    this.playing = false;
    this.play.textContent = 'Play';
  }

  async toggle() {
    if (this.playing) return this.pause();
    this.playing = true;
    this.play.textContent = 'Pause';
    const { times } = this.episode;
    const begin = this.at >= this.frameCount - 1 ? 0 : this.at;
    const from = this.mixed(times, Math.floor(begin), begin % 1);
    const start = performance.now();
    for (let frame = Math.floor(begin); this.playing && frame < this.frameCount - 1; ) {
      const now = from + (performance.now() - start) / 1000;
      while (frame < this.frameCount - 1 && times[frame + 1] <= now) ++frame;
      const span = frame < this.frameCount - 1 ? times[frame + 1] - times[frame] : 1;
      this.show(frame < this.frameCount - 1 ? frame + Math.max(0, now - times[frame]) / span : frame);
      await new Promise(requestAnimationFrame);
    }
    this.pause();
  }
}
