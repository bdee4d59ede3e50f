// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// An object of any links and joints as three.js draws it, with its findings marked.

import { AxesHelper, Box3, BufferAttribute, BufferGeometry, CylinderGeometry, DoubleSide, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Quaternion, SRGBColorSpace, Vector3 } from 'three';

import { matrixOf, rotationAbout, multiply, inverse, translation } from './kinematics.js';
import { label } from './model.js';

const MARK = 0xe0301e;
const COLORS = [0xb9c2ca, 0xd3b98f, 0x9fb8d1, 0xb3c9a4, 0xd1a9a0, 0xb7a9cf]; // a link, round and round
const PIN_COLORS = { error: 0xa3260f, warning: 0x7a4d00, info: 0x1f66ad };

const matrix4 = (numbers) => new Matrix4().fromArray(numbers);
const still = (object, numbers) => {
  object.matrixAutoUpdate = false;
  object.matrix.fromArray(numbers);
  object.matrixWorldNeedsUpdate = true;
  return object;
};

/** A joint that a slider moves. */
export const canMove = ({ type, lower, upper, parent }) => parent !== null && ['revolute', 'continuous', 'prismatic'].includes(type) && upper > lower;

/** Poses of all links in the world, by joint values; what hangs on no joint stays where it is. */
export const objectPoses = (object, values) => {
  const above = new Map();
  object.joints.forEach((joint, i) => { if (joint.parent !== null && !above.has(joint.child)) above.set(joint.child, i); });
  const poses = object.links.map(() => null);
  const poseOf = (link, depth = 0) => {
    if (poses[link]) return poses[link];
    const number = above.get(link);
    if (number === undefined || depth > object.links.length) return (poses[link] = matrixOf(object.links[link].world_from_link));
    const joint = object.joints[number];
    const value = values[number] ?? 0;
    const moved = joint.type === 'prismatic' ? translation(joint.axis.map((a) => a * value)) : rotationAbout(joint.axis, value);
    const turns = ['revolute', 'continuous', 'prismatic'].includes(joint.type);
    const place = multiply(poseOf(joint.parent, depth + 1), matrixOf(joint.parent_from_joint));
    return (poses[link] = multiply(turns ? multiply(place, moved) : place, inverse(matrixOf(joint.child_from_joint))));
  };
  object.links.forEach((_, i) => poseOf(i));
  return poses;
};

export class ObjectModel {
  constructor(item, shapes, changed) {
    this.item = item;
    this.object = item.object;
    this.shapes = shapes;
    this.changed = changed;
    this.root = new Group();
    this.links = this.object.links.map(() => still(new Group(), new Matrix4().elements));
    for (const link of this.links) this.root.add(link);
    this.drawn = this.object.shapes.map((shape) => this.addShape(shape));
    this.pose([]);
    const size = this.box().getSize(new Vector3()).length();
    this.size = size;
    this.rods = this.object.joints.map((joint) => this.addRod(joint));
    this.axes = this.links.map((link) => this.addAxes(link));
    this.marks = item.findings.map((finding, i) => this.addMark(finding, i));
  }

  addShape(shape) {
    const material = new MeshLambertMaterial({ side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    material.color.setHex(COLORS[shape.link % COLORS.length], SRGBColorSpace);
    const mesh = still(new Mesh(this.shapes.geometry(shape.mesh), material), matrixOf(shape.place));
    mesh.userData.shape = shape;
    this.links[shape.link].add(mesh);
    return mesh;
  }

  addAxes(link) {
    const axes = new AxesHelper(0.12 * this.size);
    axes.material.depthTest = false;
    axes.renderOrder = 2;
    axes.visible = false;
    link.add(axes);
    return axes;
  }

  addRod(joint) {
    const long = 0.35 * this.size;
    const rod = new Mesh(new CylinderGeometry(0.004 * this.size, 0.004 * this.size, long, 12), new MeshBasicMaterial({ color: MARK, depthTest: false, transparent: true, opacity: 0.85 }));
    const axis = new Vector3(...joint.axis);
    const group = still(new Group(), matrixOf(joint.child_from_joint));
    if (axis.length() > 0.5) rod.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), axis));
    rod.renderOrder = 3;
    rod.visible = false;
    group.add(rod);
    this.links[joint.child].add(group);
    return rod;
  }

  // What a finding is about, with a numbered pin that says where.
  addMark(finding, i) {
    const mark = finding.mark ?? {};
    const home = this.homeOf(mark);
    if (!home) return null;
    const pin = label(String(i + 1), 0xffffff, PIN_COLORS[finding.severity]);
    pin.scale.multiplyScalar(this.size / 2.6);
    pin.position.copy(home.at);
    pin.renderOrder = 10;
    pin.userData.finding = i;
    home.group.add(pin);
    return { pin, edges: this.addEdges(mark) };
  }

  /** The group in whose frame the mark lies, and where; null for the file as a whole. */
  homeOf({ link = null, joint = null, shape = null, point_m: point = null, edges = null }) {
    if (edges) {
      const [x0, y0, z0, x1, y1, z1] = this.edgeFloats(edges);
      return { group: this.drawn[shape], at: new Vector3((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) };
    }
    if (joint !== null) {
      const { child, child_from_joint: frame } = this.object.joints[joint];
      return { group: this.links[child], at: new Vector3().setFromMatrixPosition(matrix4(matrixOf(frame))) };
    }
    if (link === null) return null;
    if (point) return { group: this.links[link], at: new Vector3(...point) };
    const box = shape !== null ? this.boxOf(this.drawn[shape]) : this.linkBox(link);
    if (box.isEmpty()) return { group: this.links[link], at: new Vector3() };
    return { group: this.links[link], at: box.getCenter(new Vector3()).applyMatrix4(this.links[link].matrixWorld.clone().invert()) };
  }

  edgeFloats({ at, count }) {
    return this.shapes.content.floats(at, 6 * count);
  }

  addEdges({ edges = null, shape = null }) {
    if (!edges) return null;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(this.edgeFloats(edges).slice(), 3));
    const lines = new LineSegments(geometry, new LineBasicMaterial({ color: MARK, depthTest: false, transparent: true }));
    lines.renderOrder = 4;
    this.drawn[shape].add(lines);
    return lines;
  }

  pose(values) {
    objectPoses(this.object, values).forEach((numbers, i) => still(this.links[i], numbers));
    this.root.updateMatrixWorld(true);
    this.changed();
  }

  show({ shapes, frames, pins }) {
    for (const mesh of this.drawn) {
      const { visual, collision } = mesh.userData.shape;
      mesh.visible = (shapes !== 'collision' && visual) || (shapes !== 'visual' && collision);
      mesh.material.transparent = shapes === 'both' && !visual;
      mesh.material.opacity = mesh.material.transparent ? 0.45 : 1;
    }
    for (const axes of this.axes) axes.visible = frames;
    for (const mark of this.marks) if (mark) mark.pin.visible = pins;
    this.changed();
  }

  /** Marks what a finding is about and nothing else; a finding without a place marks nothing. Returns the box about it. */
  mark(number) {
    const chosen = this.item.findings[number]?.mark ?? {};
    const has = (value) => value !== null && value !== undefined;
    const byShape = has(chosen.shape);
    const byLink = !byShape && !has(chosen.joint) && has(chosen.link);
    const box = new Box3();
    this.drawn.forEach((mesh, i) => {
      const isMarked = byShape ? i === chosen.shape : byLink && mesh.userData.shape.link === chosen.link;
      const whole = isMarked && !chosen.edges; // edges are seen on what keeps its colour
      mesh.material.emissive.setHex(whole ? MARK : 0, SRGBColorSpace);
      mesh.material.emissiveIntensity = whole ? 0.55 : 0;
      if (isMarked) {
        mesh.visible = true;
        box.union(this.boxOf(mesh));
      }
    });
    this.rods.forEach((rod, i) => {
      rod.visible = i === chosen.joint;
      if (rod.visible) box.union(new Box3().setFromObject(rod)).union(this.linkBox(this.object.joints[i].child));
    });
    this.marks.forEach((mark, i) => {
      if (!mark?.edges) return;
      mark.edges.visible = number === i || number === null;
      mark.edges.material.opacity = number === i ? 1 : 0.3;
    });
    this.changed();
    return box;
  }

  meshes() {
    return this.drawn;
  }

  pins() {
    return this.marks.flatMap((mark) => (mark ? [mark.pin] : []));
  }

  boxOf(mesh) {
    mesh.geometry.computeBoundingBox();
    return mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrixWorld);
  }

  linkBox(link) {
    const box = new Box3();
    for (const mesh of this.drawn) if (mesh.userData.shape.link === link) box.union(this.boxOf(mesh));
    return box;
  }

  box() {
    this.root.updateMatrixWorld(true);
    const box = new Box3();
    for (const mesh of this.drawn) box.union(this.boxOf(mesh));
    return box.isEmpty() ? box.set(new Vector3(-0.5, -0.5, 0), new Vector3(0.5, 0.5, 1)) : box;
  }
}
