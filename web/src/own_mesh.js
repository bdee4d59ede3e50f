// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A mesh that was dropped, in its file's own axes: which face lies on the door, what points up, its unit.

import { ArrowHelper, Box3, BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, SphereGeometry, Vector3 } from 'three';

import { geometryOf } from './geometry.js';
import { label } from './model.js';
import { Stage } from './stage.js';
import { h, number } from './dom.js';

const AXES = ['x', 'y', 'z', '-x', '-y', '-z'];
const COLORS = { x: 0xc23b22, y: 0x2c8a3d, z: 0x2a62c4 };
const SHOWN = 0.4; // [m] longest side on the screen, whatever the file's numbers are
const SQUARE = Math.cos((0.5 * Math.PI) / 180); // what is nearer to an axis of the file is meant to lie along it
const ALONG = 0.9; // cosine above which nothing is up that points out of the door
const BESIDE = 0.05; // of the longest side, beyond which a point is not meant to be on the mesh
const FLAT = 0.999; // cosine between faces of one plane

// The unit vector of "-y", or of "0.6,0.8,0"; null where a text is neither.
const vectorOf = (text) => {
  if (AXES.includes(text)) return new Vector3().setComponent('xyz'.indexOf(text.at(-1)), text[0] === '-' ? -1 : 1);
  const numbers = text.split(',').map((word) => (word.trim() === '' ? NaN : Number(word)));
  if (numbers.length !== 3 || !numbers.every(Number.isFinite) || !numbers.some(Boolean)) return null;
  return new Vector3(...numbers).normalize();
};
const cosine = (a, b) => vectorOf(a).dot(vectorOf(b));

/** What a setting calls a direction: the axis that it lies along, or its numbers where it is skew to all. */
export const nameOf = (direction) => {
  const best = AXES.reduce((a, b) => (vectorOf(b).dot(direction) > vectorOf(a).dot(direction) ? b : a));
  if (vectorOf(best).dot(direction) >= SQUARE) return best;
  return direction.toArray().map((value) => Number(value.toFixed(6)) + 0).join(',');
};

/** The triangles that lie in one plane with a triangle of a mesh: their corners, their normal, the middle of their area. */
export const planeWith = (meshes, triangle) => {
  const corner = (mesh, k) => new Vector3().fromArray(mesh.positions, 3 * mesh.indices[k]);
  const normalOf = (a, b, c) => b.clone().sub(a).cross(c.clone().sub(a));
  const first = [0, 1, 2].map((k) => corner(triangle.mesh, 3 * triangle.face + k));
  const normal = normalOf(...first).normalize();
  const near = 1e-3 * triangle.size;
  const corners = [];
  const middle = new Vector3();
  const sum = new Vector3(); // corners come in steps of a box, which the whole face evens out
  let area = 0;
  for (const mesh of meshes) {
    for (let k = 0; k < mesh.indices.length; k += 3) {
      const [a, b, c] = [0, 1, 2].map((i) => corner(mesh, k + i));
      const across = normalOf(a, b, c);
      const size = across.length();
      if (size === 0 || across.dot(normal) < FLAT * size || Math.abs(a.clone().sub(first[0]).dot(normal)) > near) continue;
      corners.push(...a.toArray(), ...b.toArray(), ...c.toArray());
      middle.addScaledVector(a.add(b).add(c), size / 3);
      sum.add(across);
      area += size;
    }
  }
  return { corners, normal: sum.normalize(), middle: middle.divideScalar(area || 1) };
};

const field = (id, title, control) => h('div', {}, h('label', { for: id }, title), control);

export class OwnMesh {
  /** `content` is what the server gave of the file, `others` what it gave of meshes dropped with it; `mesh` holds the settings of LooseMeshConfig that differ. */
  constructor(content, others, { applied, closed, instead }) {
    this.content = content;
    this.name = content.document.name;
    this.unit = content.document.unit_m;
    Object.assign(this, { others, applied, closed, instead });
    this.role = 'handle';
    this.beside = ''; // which of the others stays fixed around it
    this.mesh = { mechanism: 'none', front: content.document.front || '', up: content.document.up || '' };
    this.meshes = content.document.shown.map((place) => content.mesh(place));
    this.canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-label': 'The mesh in 3D. Arrow keys turn it, plus and minus zoom, Home shows all. A click chooses the face that lies on the door, or what the field says that a click tells; so do the fields Out of the door and Up.' });
    this.said = h('p', { role: 'status', class: 'asked' });
    this.element = h('dialog', { class: 'own', 'aria-labelledby': 'own-title', onclose: () => this.end() }, h('div', { class: 'record' },
      h('section', { class: 'stage', 'aria-label': 'the mesh in 3D' }, h('div', { class: 'canvas' }, this.canvas)),
      h('div', { class: 'panel', tabindex: 0, role: 'region', 'aria-label': 'how it is meant' }, this.form())));
  }

  form() {
    const pick = (key, title, values, changed) => field(`own-${key}`, title, (this[`field_${key}`] = h('select', { id: `own-${key}`, onchange: ({ target }) => changed(target.value) }, values.map(([value, text]) => h('option', { value }, text)))));
    const numberField = (key, title, changed) => field(`own-${key}`, title, (this[`field_${key}`] = h('input', { type: 'number', id: `own-${key}`, step: 'any', oninput: ({ target }) => changed(target.value) })));
    const axes = (standard) => [['', standard], ...AXES.map((axis) => [axis, axis]), ['skew', 'another direction']];
    const directionField = (key, title, changed) => (this[`row_${key}`] = field(`own-${key}`, title, (this[`field_${key}`] = h('input', { type: 'text', id: `own-${key}`, placeholder: '0.6,0.8,0', oninput: ({ target }) => vectorOf(target.value) && changed(target.value) }))));
    const { document } = this.content;
    this.mountFields = h('div', { class: 'settings three' }, ['x', 'y', 'z'].map((axis) => numberField(`mount_${axis}`, `Mount ${axis}`, () => this.readMount())));
    this.ofHandle = pick('mechanism', 'How it moves', [['none', 'fixed pull'], ['lever', 'lever'], ['round', 'round'], ['key', 'key'], ['valve', 'valve'], ['flap', 'flap']], (value) => this.set('mechanism', value));
    this.ofBody = pick('hinge', 'Hinge, from the front', [['left', 'left'], ['right', 'right']], (value) => this.set('hinge', value));
    this.told = h('p', {});
    this.mountTold = h('p', { class: 'soft' });
    const size = new Box3();
    for (const mesh of this.meshes) for (let i = 0; i < mesh.positions.length; i += 3) size.expandByPoint(new Vector3().fromArray(mesh.positions, i));
    this.box = size;
    const sides = size.getSize(new Vector3()).toArray().map((side) => number(side / this.unit, 4)).join(' x ');
    return h('form', { class: 'own-form', onsubmit: (event) => event.preventDefault() },
      h('h1', { id: 'own-title' }, this.name), h('p', { class: 'soft' }, `${sides} along the file's x, y, z. ${document.states_unit ? 'The file says its unit.' : 'The file says no unit.'}`),
      ...this.ofSeveral(pick),
      h('div', { class: 'settings' }, pick('role', 'It is a', [['handle', 'handle'], ['body', 'leaf']], (role) => this.setRole(role)), this.ofHandle, this.ofBody),
      pick('click', 'A click tells', [['front', 'the face on the door'], ['up', 'a face that points up']], () => this.tellClick()),
      this.told,
      h('div', { class: 'settings' }, pick('front', 'Out of the door', axes(document.front ? `as the file says: ${document.front}` : 'x if not chosen'), (front) => this.setFront(front === 'skew' ? '1,0,0' : front)),
        pick('up', 'Up', axes(document.up ? `as the file says: ${document.up}` : 'z if not chosen'), (up) => this.setUp(up === 'skew' ? '0,0,1' : up)),
        directionField('front_xyz', 'Out, as x,y,z', (front) => this.setFront(front)), directionField('up_xyz', 'Up, as x,y,z', (up) => this.setUp(up))),
      h('div', { class: 'settings' }, pick('unit', 'Unit of its numbers', [['', 'told by the size'], ['m', 'm'], ['cm', 'cm'], ['mm', 'mm'], ['in', 'inch'], ['ft', 'foot']], (unit) => this.set('unit', unit)),
        numberField('size', 'or its longest side [m]', (text) => this.set('size_m', Number(text) || 0))),
      this.mountTold, this.mountFields,
      field('own-license', 'Licence (SPDX)', h('input', { id: 'own-license', type: 'text', placeholder: 'NOASSERTION', oninput: ({ target }) => this.set('license', target.value) })),
      this.said,
      h('div', { class: 'actions' }, h('button', { type: 'button', id: 'own-apply', class: 'main', onclick: () => this.apply() }, 'Put it on the door'),
        h('button', { type: 'button', onclick: () => this.element.close() }, 'Cancel')));
  }

  // Which of several meshes comes first, and which of the others belongs to it.
  ofSeveral(pick) {
    if (this.others.length === 0) return [];
    const names = this.others.map(({ document }) => document.name);
    const named = (name) => [name, name];
    this.next = h('p', { class: 'soft' });
    return [h('div', { class: 'settings' }, pick('which', 'This is about', [this.name, ...names].map(named), (name) => this.instead(name)),
      pick('beside', 'Beside it', [['', 'nothing'], ...names.map(named)], (name) => this.setBeside(name))), this.next];
  }

  /** The mesh that stays fixed around this one is drawn with it, so that one sees whether they fit. */
  setBeside(name) {
    this.beside = name;
    for (const mesh of this.fixed ?? []) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
    }
    const content = this.others.find(({ document }) => document.name === name);
    const meshes = content ? content.document.shown.map((place) => content.mesh(place)) : [];
    this.fixed = meshes.map((mesh) => new Mesh(geometryOf(mesh), new MeshLambertMaterial({ color: 0x5f7f9f, transparent: true, opacity: 0.45, depthWrite: false, side: DoubleSide })));
    for (const mesh of this.fixed) mesh.scale.setScalar(this.unit / content.document.unit_m); // its numbers are in this one's unit
    if (this.fixed.length > 0) this.group.add(...this.fixed);
    this.tellNext();
    this.stage.changed();
  }

  tellNext() {
    if (!this.next) return;
    const left = this.others.map(({ document }) => document.name).filter((name) => name !== this.beside);
    const around = this.role === 'handle' ? 'a rose around this handle' : 'the frame around this leaf';
    const fixed = this.beside ? `${this.beside} is fixed around it, in the same axes and unit.` : `If another mesh is ${around}, choose it.`;
    this.next.textContent = `${fixed}${left.length > 0 ? ` After this one: ${left.join(', ')}.` : ''}`;
  }

  /** It is in the page while it is open, since each has fields of the same ids. */
  show(page) {
    page.append(this.element);
    this.element.showModal();
    if (this.stage) return this.refresh();
    this.stage = new Stage(this.canvas);
    this.stage.floor.visible = false;
    this.group = new Group();
    const longest = Math.max(...this.box.getSize(new Vector3()).toArray()) || 1;
    this.size = longest;
    this.group.scale.setScalar(SHOWN / longest);
    this.group.position.copy(this.box.getCenter(new Vector3())).multiplyScalar(-SHOWN / longest);
    this.drawn = this.meshes.map((mesh) => new Mesh(geometryOf(mesh), new MeshLambertMaterial({ color: 0xb9c2ca, side: DoubleSide })));
    this.group.add(...this.drawn);
    this.stage.scene.add(this.group);
    this.addAxes(longest);
    this.stage.home = () => this.frame();
    this.canvas.addEventListener('pointerdown', ({ offsetX, offsetY }) => (this.down = [offsetX, offsetY]));
    this.canvas.addEventListener('click', (event) => this.click(event));
    this.setRole(this.role);
    this.frame();
    this.refresh();
  }

  // The file's axes, at the least corner of its box.
  addAxes(longest) {
    for (const axis of ['x', 'y', 'z']) {
      const from = this.box.min.clone().addScaledVector(new Vector3(1, 1, 1), -0.06 * longest);
      this.addArrow(this.group, { way: vectorOf(axis), from, length: 0.45 * longest }, COLORS[axis], axis);
    }
  }

  addArrow(group, { way, from, length }, color, text) {
    const arrow = new ArrowHelper(way, from, length, color, 0.12 * length, 0.06 * length);
    for (const part of [arrow.line, arrow.cone]) Object.assign(part.material, { depthTest: false, transparent: true }); // seen through the mesh
    const name = label(text, color);
    const size = 0.6 * this.size * Math.max(1, 520 / (this.canvas.clientHeight || 520)); // on a small screen it is read, too
    name.scale.multiplyScalar(size);
    name.position.copy(from).addScaledVector(way, length + 0.1 * size);
    group.add(arrow, name);
  }

  frame() {
    this.stage.frame(new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1)).applyMatrix4(this.group.matrix.clone().makeScale(0.62 * SHOWN, 0.62 * SHOWN, 0.62 * SHOWN)));
  }

  get front() {
    return this.mesh.front || this.content.document.front || 'x';
  }

  get up() {
    return this.mesh.up || this.content.document.up || 'z';
  }

  set(key, value) {
    this.mesh[key] = value;
  }

  setRole(role) {
    this.role = role;
    this.ofHandle.hidden = role !== 'handle';
    this.ofBody.hidden = role !== 'body';
    this.field_role.value = role;
    if (this.field_beside) this.field_beside.previousElementSibling.textContent = role === 'handle' ? 'Its rose' : 'Its frame';
    this.field_click.options[0].textContent = role === 'handle' ? 'the face on the door' : 'the front';
    this.mountTold.textContent = `Where ${role === 'handle' ? 'it meets the door' : 'the handle goes'}, in the file's numbers; empty: found from the shape.`;
    this.tellNext();
    this.tellClick();
    this.clearFace();
  }

  tellClick() {
    const side = this.role === 'handle' ? 'Click the face that lies on the door.' : 'Click the front: the face one stands before to open it.';
    this.told.textContent = this.field_click.value === 'up' ? 'Click a face that looks up when the door stands.' : side;
  }

  setFront(front) {
    this.mesh.front = front;
    if (Math.abs(cosine(this.up, this.front)) > ALONG) this.mesh.up = ['z', 'y'].find((axis) => Math.abs(cosine(axis, this.front)) < ALONG);
    this.clearFace();
  }

  setUp(up) {
    this.mesh.up = up;
    if (Math.abs(cosine(this.up, this.front)) > ALONG) this.mesh.front = ['x', 'y'].find((axis) => Math.abs(cosine(axis, this.up)) < ALONG);
    this.refresh();
  }

  readMount() {
    const texts = ['x', 'y', 'z'].map((axis) => this[`field_mount_${axis}`].value);
    this.mesh.mount = texts.every((text) => text === '') ? [] : texts.map(Number);
    const beside = this.mesh.mount.length > 0 && this.box.distanceToPoint(this.mountPoint) > BESIDE * this.size;
    this.say(beside ? `This point lies beside the mesh${this.role === 'handle' ? ': the handle would turn about an axis outside of it' : ''}.` : '', beside);
    this.refresh();
  }

  get mountPoint() {
    return new Vector3(...this.mesh.mount).multiplyScalar(this.unit);
  }

  clearFace() {
    this.mesh.mount = [];
    this.face?.removeFromParent();
    this.face = null;
    this.refresh();
  }

  click({ offsetX, offsetY }) {
    if (this.down && Math.hypot(offsetX - this.down[0], offsetY - this.down[1]) > 4) return; // it was a turn
    const hit = this.stage.pick(offsetX, offsetY, this.drawn);
    if (hit) this.chooseFace(this.drawn.indexOf(hit.object), hit.faceIndex);
  }

  /** The face lies on the door: out of the door is away from it, and the handle's axis goes through its middle. */
  chooseFace(place, face) {
    const plane = planeWith(this.meshes, { mesh: this.meshes[place], face, size: this.size });
    if (this.field_click.value === 'up') {
      this.setUp(nameOf(plane.normal));
      return this.say(`${this.up} points up.`);
    }
    this.setFront(nameOf(this.role === 'handle' ? plane.normal.clone().negate() : plane.normal));
    this.showFace(plane);
    if (this.role === 'handle') this.mesh.mount = plane.middle.toArray().map((value) => this.inFile(value));
    this.say(this.role === 'handle' ? `This face lies on the door: ${this.front} points out of it.` : `${this.front} points out of the door.`);
    this.refresh();
  }

  // A coordinate in the file's numbers, as short as it is exact.
  inFile(value) {
    if (Math.abs(value) < 1e-5 * this.size) return 0;
    return Number((value / this.unit).toPrecision(AXES.includes(this.front) ? 5 : 7)) + 0;
  }

  showFace({ corners, normal }) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(corners), 3));
    this.face = new Mesh(geometry, new MeshBasicMaterial({ color: 0xe08a1e, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4 }));
    this.face.position.copy(normal).multiplyScalar(1e-3 * this.size);
    this.group.add(this.face);
  }

  say(text, refused = false) {
    this.said.textContent = text;
    this.said.classList.toggle('refused', refused);
  }

  refresh() {
    for (const key of ['front', 'up']) {
      const skew = this.mesh[key].includes(',');
      this[`field_${key}`].value = skew ? 'skew' : this.mesh[key];
      this[`row_${key}_xyz`].hidden = !skew;
      if (skew && document.activeElement !== this[`field_${key}_xyz`]) this[`field_${key}_xyz`].value = this.mesh[key];
    }
    ['x', 'y', 'z'].forEach((axis, i) => {
      const field = this[`field_mount_${axis}`];
      if (document.activeElement !== field) field.value = this.mesh.mount?.[i] ?? '';
    });
    if (!this.stage) return;
    this.meant?.removeFromParent();
    this.meant = new Group();
    const center = this.box.getCenter(new Vector3());
    const front = vectorOf(this.front);
    const up = vectorOf(this.up);
    up.addScaledVector(front, -up.dot(front)).normalize(); // what counts of it
    for (const [way, text] of [[front, 'out of the door'], [up, 'up']]) {
      this.addArrow(this.meant, { way, from: center.clone().addScaledVector(way, this.reach(way, center)), length: 0.28 * this.size }, 0x5a3fa0, text);
    }
    if (this.mesh.mount?.length > 0) {
      const point = new Mesh(new SphereGeometry(0.018 * this.size), new MeshBasicMaterial({ color: 0x5a3fa0, depthTest: false, transparent: true }));
      point.position.copy(this.mountPoint);
      this.meant.add(point);
    }
    this.group.add(this.meant);
    this.stage.changed();
  }

  // How far the mesh goes from a point in a direction.
  reach({ x, y, z }, from) {
    let farthest = 0;
    for (const { positions: p } of this.meshes)
      for (let i = 0; i < p.length; i += 3) farthest = Math.max(farthest, x * (p[i] - from.x) + y * (p[i + 1] - from.y) + z * (p[i + 2] - from.z));
    return farthest;
  }

  /** The settings that are not as they are where nothing is said. */
  get settings() {
    const plain = { mechanism: 'none', unit: '', size_m: 0, up: this.content.document.up || '', front: this.content.document.front || '', hinge: 'left', license: '' };
    const said = Object.entries(this.mesh).filter(([key, value]) => (Array.isArray(value) ? value.length > 0 : value !== plain[key]));
    if (this.beside) said.push([this.role === 'handle' ? 'rose' : 'frame', this.beside]);
    return Object.fromEntries(said.filter(([key]) => !(key === 'hinge' && this.role === 'handle') && !(key === 'mechanism' && this.role === 'body')));
  }

  apply() {
    this.asked = this.settings; // what is changed and not applied counts for nothing
    this.element.close();
    this.element.remove(); // another may be shown at once
    this.applied(this);
  }

  end() {
    this.element.remove();
    this.closed(this);
  }

  dispose() {
    this.stage?.renderer.dispose();
    this.stage?.renderer.forceContextLoss();
    this.element.remove();
  }
}
