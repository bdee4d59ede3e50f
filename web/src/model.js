// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A door or a part as three.js draws it: a group a link, posed by the record's joints.

import { AxesHelper, Box3, BoxGeometry, CanvasTexture, CylinderGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Quaternion, SRGBColorSpace, Sprite, SpriteMaterial, Texture, Vector3 } from 'three';

import { geometryOf } from './geometry.js';
import { matrixOf } from './kinematics.js';

const HULL_COLORS = [0xdb5e57, 0x5cad69, 0x5485cc, 0xe0bd4d, 0x9e6eba, 0x57b5ba]; // those of previews
const MARK = 0xe0301e;
const BOLT = 0xd9a21b;

const colorOf = (material, [r, g, b, a]) => {
  material.color.setRGB(r, g, b, SRGBColorSpace);
  material.transparent = a < 1;
  material.opacity = a;
  return material;
};

const placed = (object, matrix) => {
  object.matrixAutoUpdate = false;
  object.matrix.copy(matrix);
  object.matrixWorldNeedsUpdate = true;
  return object;
};

const matrix4 = (numbers) => new Matrix4().fromArray(numbers);

const cssOf = (color) => `#${color.toString(16).padStart(6, '0')}`;

/** Words that face the onlooker, 12 cm high where they are not scaled; on a plate where that has a colour. */
export const label = (text, color = 0x59626c, plate = null) => {
  const font = '600 40px system-ui, sans-serif';
  const canvas = document.createElement('canvas');
  canvas.getContext('2d').font = font;
  const width = Math.max(plate === null ? 128 : 64, Math.ceil(canvas.getContext('2d').measureText(text).width) + (plate === null ? 16 : 30));
  Object.assign(canvas, { width, height: 64 });
  const pen = canvas.getContext('2d');
  pen.font = font;
  pen.textAlign = 'center';
  if (plate !== null) {
    pen.fillStyle = cssOf(plate);
    pen.roundRect(1, 1, width - 2, 62, 31);
    pen.fill();
  }
  pen.fillStyle = cssOf(color);
  pen.fillText(text, width / 2, 46);
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false }));
  sprite.scale.set((0.12 * width) / 64, 0.12, 1);
  return sprite;
};

/** Reads the meshes of a page once each. */
export class Shapes {
  constructor(content) {
    this.content = content;
    this.made = new Map();
  }

  dispose() {
    for (const geometry of this.made.values()) geometry.dispose();
  }

  geometry(place) {
    if (!this.made.has(place)) this.made.set(place, geometryOf(this.content.mesh(place)));
    return this.made.get(place);
  }
}

export class Model {
  constructor(record, shapes, changed) {
    this.record = record;
    this.shapes = shapes;
    this.changed = changed;
    this.root = new Group();
    this.links = record.links.map(() => placed(new Group(), new Matrix4()));
    this.root.add(...this.links);
    this.pieces = []; // {name, link, visual: [Mesh], hulls: [Mesh]}
    record.links.forEach((link, i) => link.geometry.forEach((piece) => this.addPiece(piece, i)));
    this.frames = this.addFrames();
    this.grasp = this.addGrasp();
    this.scale = this.addScale();
    this.addBolt();
    this.show({ shapes: 'visual', frames: false, grasp: false, scale: true });
  }

  addPiece(piece, link) {
    const visual = (piece.visual ?? [{ mesh: piece.mesh, color: piece.color }]).map((surface) => this.visualMesh(surface, piece));
    const hulls = (piece.hulls ?? []).map((place) => this.hullMesh(place));
    const group = new Group();
    if (piece.place) placed(group, matrix4(matrixOf(piece.place)));
    const shown = { visual: new Group(), hulls: new Group() };
    for (const mesh of visual) shown.visual.add(mesh);
    for (const mesh of hulls) shown.hulls.add(mesh);
    group.add(shown.visual, shown.hulls);
    this.links[link].add(group);
    const entry = { name: piece.name, link, group, ...shown };
    for (const mesh of [...visual, ...hulls]) mesh.userData.piece = entry;
    this.pieces.push(entry);
  }

  visualMesh({ mesh, color, texture }, piece) {
    const material = colorOf(new MeshLambertMaterial({ side: piece.visual ? DoubleSide : 0 }), color);
    if (texture) this.addTexture(material, texture);
    return new Mesh(this.shapes.geometry(mesh), material);
  }

  async addTexture(material, texture) {
    const picture = new Blob([this.shapes.content.bytes(texture)], { type: texture.type });
    const map = new Texture(await createImageBitmap(picture, { imageOrientation: 'flipY' }));
    map.flipY = false;
    map.colorSpace = SRGBColorSpace;
    map.wrapS = map.wrapT = 1000; // repeat
    map.needsUpdate = true;
    material.map = map;
    material.needsUpdate = true;
    this.changed();
  }

  hullMesh(place) {
    this.hullCount = (this.hullCount ?? 0) + 1;
    const material = new MeshLambertMaterial({ color: HULL_COLORS[this.hullCount % HULL_COLORS.length], polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 });
    const mesh = new Mesh(this.shapes.geometry(place), material);
    mesh.add(new LineSegments(new EdgesGeometry(mesh.geometry, 20), new LineBasicMaterial({ color: 0x222222, transparent: true, opacity: 0.35 })));
    return mesh;
  }

  // Axes of every link, and a rod along each joint's axis.
  addFrames() {
    const frames = this.links.map((link, i) => {
      const axes = new AxesHelper(i === 2 ? 0.12 : 0.25);
      axes.material.depthTest = false;
      axes.renderOrder = 2;
      link.add(axes);
      return axes;
    });
    this.rods = this.record.joints.map((joint, i) => {
      const size = this.boxOfLink(i + 1).getSize(new Vector3());
      const thick = i === 0 && size.length() > 0.5 ? 0.004 : 0.0015;
      const along = Math.abs(size.x * joint.axis[0]) + Math.abs(size.y * joint.axis[1]) + Math.abs(size.z * joint.axis[2]);
      const rod = new Mesh(new CylinderGeometry(thick, thick, along + 0.12, 12), new MeshBasicMaterial({ color: i === 0 ? 0x1f66ad : 0xa34a00, depthTest: false, transparent: true, opacity: 0.8 }));
      rod.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...joint.axis)));
      const middle = this.boxOfLink(i + 1).getCenter(new Vector3());
      rod.position.copy(new Vector3(...joint.axis)).multiplyScalar(middle.dot(new Vector3(...joint.axis)));
      this.links[i + 1].add(rod);
      return rod;
    });
    return [...frames, ...this.rods];
  }

  addGrasp() {
    const { grasp, gripper } = this.record;
    if (!grasp) return [];
    const group = placed(new Group(), matrix4(matrixOf(grasp.link_from_grasp)));
    const axes = new AxesHelper(0.06);
    axes.material.depthTest = false;
    axes.renderOrder = 2;
    const [x, y, z] = grasp.half_extent_m.map((half) => Math.max(2 * half, 1e-4));
    const box = new LineSegments(new EdgesGeometry(new BoxGeometry(x, y, z)), new LineBasicMaterial({ color: 0xe0301e }));
    group.add(axes, box);
    for (const piece of gripper?.pieces ?? []) group.add(new Mesh(this.shapes.geometry(piece.mesh), colorOf(new MeshLambertMaterial(), piece.color)));
    this.links[grasp.link].add(group);
    return [group];
  }

  // A rod of one metre with marks each 10 cm: beside a door on the floor; a decimetre for a handle.
  addScale() {
    const box = this.box();
    const big = box.getSize(new Vector3()).length() > 0.5;
    const length = big ? 1 : 0.1;
    const group = new Group();
    for (let i = 0; i < 10; ++i) {
      const step = new Mesh(new BoxGeometry(0.018 * (big ? 1 : 0.2), length / 10, 0.018 * (big ? 1 : 0.2)), new MeshBasicMaterial({ color: i % 2 ? 0xc9d0d6 : 0x30363c }));
      step.position.set(0, (i + 0.5) * (length / 10), 0);
      group.add(step);
    }
    const text = label(big ? '1 m' : '0.1 m');
    text.scale.multiplyScalar(big ? 1 : 0.2);
    text.position.set(0, length + (big ? 0.16 : 0.025), big ? 0.05 : 0.005);
    group.add(text);
    group.position.set(box.max.x + (big ? 0.35 : 0.02), box.min.y, big ? 0.009 : box.min.z - 0.01);
    this.root.add(group);
    return [group];
  }

  addBolt() {
    const { bolt } = this.record;
    if (!bolt) return;
    const material = new MeshLambertMaterial({ color: BOLT });
    this.bolt = placed(new Mesh(this.shapes.geometry(bolt.bolt_hull), material), matrix4(matrixOf(bolt.leaf_from_bolt)));
    this.links[1].add(this.bolt);
    const strike = placed(new Mesh(this.shapes.geometry(bolt.strike_hull), new MeshLambertMaterial({ color: 0x8d6b1d, transparent: true, opacity: 0.75 })), matrix4(matrixOf(bolt.base_from_strike)));
    this.links[0].add(strike);
  }

  /** Puts the links where the poses say, and the bolt at its position. */
  pose(poses, boltPosition) {
    poses.forEach((numbers, i) => placed(this.links[i], matrix4(numbers)));
    if (this.bolt) placed(this.bolt, matrix4(matrixOf(this.record.bolt.leaf_from_bolt)).multiply(new Matrix4().makeTranslation(0, boltPosition, 0)));
    this.changed();
  }

  show({ shapes, frames, grasp, scale }) {
    for (const piece of this.pieces) {
      piece.visual.visible = shapes !== 'collision';
      piece.hulls.visible = shapes !== 'visual';
      for (const mesh of piece.hulls.children) {
        mesh.material.transparent = shapes === 'both';
        mesh.material.opacity = shapes === 'both' ? 0.45 : 1;
        mesh.material.depthWrite = shapes !== 'both';
      }
    }
    for (const object of this.frames) object.visible = frames;
    for (const object of this.grasp) object.visible = grasp;
    for (const object of this.scale) object.visible = scale;
    this.changed();
  }

  /** Marks what the names mean, pieces, links or joints, and nothing else. Returns the box about it. */
  mark(names) {
    const box = new Box3();
    for (const piece of this.pieces) {
      const isMarked = names.includes(piece.name) || names.includes(this.record.links[piece.link].name);
      for (const mesh of [...piece.visual.children, ...piece.hulls.children]) mesh.material.emissive?.setHex(isMarked ? MARK : 0, SRGBColorSpace);
      for (const mesh of [...piece.visual.children, ...piece.hulls.children]) if (mesh.material.emissive) mesh.material.emissiveIntensity = isMarked ? 0.55 : 0;
      if (isMarked) box.union(this.boxOf(piece));
    }
    this.rods.forEach((rod, i) => {
      const isMarked = names.includes(this.record.joints[i].name);
      rod.visible = isMarked || this.frames[0].visible;
      if (isMarked && box.isEmpty()) box.expandByObject(rod);
    });
    this.changed();
    return box;
  }

  meshes() {
    return this.pieces.flatMap(({ visual, hulls }) => [...visual.children, ...hulls.children]);
  }

  boxOf(piece) {
    this.root.updateMatrixWorld(true);
    const box = new Box3();
    for (const mesh of piece.visual.children) box.expandByObject(mesh);
    return box;
  }

  // In the link's own frame.
  boxOfLink(link) {
    const inverse = new Matrix4().copy(this.links[link].matrix).invert();
    const box = new Box3();
    for (const piece of this.pieces) if (piece.link === link) box.union(this.boxOf(piece));
    return box.isEmpty() ? box.set(new Vector3(), new Vector3()) : box.applyMatrix4(inverse);
  }

  box() {
    const box = new Box3();
    for (const piece of this.pieces) box.union(this.boxOf(piece));
    return box.isEmpty() ? box.set(new Vector3(-0.5, -0.5, 0), new Vector3(0.5, 0.5, 1)) : box;
  }

  /** The box about the handle: the moving handle of a door, all of a part. */
  handleBox() {
    const handle = this.pieces.filter(({ name }) => name === 'grip' || name === 'rose');
    const box = new Box3();
    for (const piece of handle) box.union(this.boxOf(piece));
    return box.isEmpty() ? this.box() : box.expandByScalar(0.03);
  }
}
