// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The canvas: camera, light, keys. It draws when something has changed, and never by itself.

import { AmbientLight, Box3, Color, DirectionalLight, GridHelper, HemisphereLight, PerspectiveCamera, Raycaster, Scene, Spherical, Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

import { h } from './dom.js';

const FIELD = 40; // [deg] of view, as previews have
const AZIMUTH = (-34 * Math.PI) / 180; // from x (towards who opens the door) towards y
const ELEVATION = 0.35; // [rad]
const TURN = 0.12; // [rad] a key
const ZOOM = 0.85; // a key

// A browser without WebGL, as over some remote desktops, shows all but the picture, and says so.
const NO_RENDERER = { setPixelRatio() {}, setSize() {}, render() {}, dispose() {}, forceContextLoss() {} };

const rendererOf = (canvas) => {
  try {
    return new WebGLRenderer({ canvas, antialias: true });
  } catch {
    canvas.parentElement.append(h('p', { class: 'fault no-webgl', role: 'alert' }, 'Nothing is drawn in 3D: this browser has no WebGL. Turn on its hardware acceleration, or open the page in another browser; what is written beside is complete.'));
    return NO_RENDERER;
  }
};

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = rendererOf(canvas);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELD, 1, 0.01, 60);
    this.camera.up.set(0, 0, 1);
    this.light();
    this.floor = new GridHelper(6, 12, 0x8a949e, 0x8a949e);
    this.floor.rotation.x = Math.PI / 2;
    this.floor.material.transparent = true;
    this.floor.material.opacity = 0.28;
    this.scene.add(this.floor);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomSpeed = 1.4;
    this.controls.addEventListener('change', () => this.changed());
    this.frames = 0;
    this.pending = false;
    this.home = null;
    canvas.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.dark = window.matchMedia('(prefers-color-scheme: dark)');
    this.dark.addEventListener('change', () => this.paper());
    this.resize();
    this.paper();
  }

  light() {
    this.scene.add(new AmbientLight(0xffffff, 0.7), new HemisphereLight(0xffffff, 0xb8b0a4, 1.6));
    this.sun = new DirectionalLight(0xffffff, 1.9);
    this.scene.add(this.sun, this.sun.target);
  }

  paper() {
    this.scene.background = new Color(this.dark.matches ? 0x1d2227 : 0xf1f2f2);
    this.changed();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.changed();
  }

  changed() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.draw();
    });
  }

  draw() {
    const offset = new Vector3().subVectors(this.camera.position, this.controls.target).normalize();
    // the sun stands behind the onlooker's left shoulder
    const left = new Vector3(0, 0, 1).cross(offset).normalize().negate();
    this.sun.position.copy(this.controls.target).addScaledVector(offset, 3).addScaledVector(left, 2).add(new Vector3(0, 0, 3));
    this.sun.target.position.copy(this.controls.target);
    this.renderer.render(this.scene, this.camera);
    ++this.frames;
  }

  /** Looks at a box from the usual place, or from where the camera is. */
  frame(box, { keep = false, azimuth = AZIMUTH, elevation = ELEVATION } = {}) {
    const center = box.getCenter(new Vector3());
    let way = new Vector3(Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation));
    if (keep) way = new Vector3().subVectors(this.camera.position, this.controls.target).normalize();
    this.camera.position.copy(center).addScaledVector(way, this.distanceTo(box, center, way));
    this.controls.target.copy(center);
    this.camera.near = Math.max(0.002, this.camera.position.distanceTo(center) / 500);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.changed();
  }

  // The smallest distance from which all corners are in view, and a little more.
  distanceTo(box, center, way) {
    const right = new Vector3(0, 0, 1).cross(way).normalize();
    const up = way.clone().cross(right);
    const tangent = Math.tan((FIELD * Math.PI) / 360);
    let most = 0.02;
    for (let i = 0; i < 8; ++i) {
      const corner = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).sub(center);
      const across = Math.max(Math.abs(corner.dot(up)) / tangent, Math.abs(corner.dot(right)) / (tangent * this.camera.aspect));
      most = Math.max(most, across + corner.dot(way));
    }
    return 1.08 * most;
  }

  /** What is nearest under a point of the canvas [px], among the objects. */
  pick(x, y, objects) {
    const { width, height } = this.canvas.getBoundingClientRect();
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
    return caster.intersectObjects(objects, false).find(({ object }) => object.visible && object.parent.visible) ?? null;
  }

  key(event) {
    const turns = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, -TURN], ArrowDown: [0, TURN] };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in turns) {
      const [across, down] = turns[event.key];
      if (event.shiftKey) this.shift(across, down);
      else this.orbit(across, down, 1);
    } else if (event.key === '+' || event.key === '=') this.orbit(0, 0, ZOOM);
    else if (event.key === '-') this.orbit(0, 0, 1 / ZOOM);
    else if (event.key === 'Home') this.home?.();
    else return;
    event.preventDefault();
  }

  orbit(across, down, zoom) {
    const offset = new Vector3().subVectors(this.camera.position, this.controls.target);
    const [x, y, z] = offset.toArray();
    const sphere = new Spherical().setFromVector3(new Vector3(y, z, x)); // three's spheres stand on y
    sphere.theta += across;
    sphere.phi = Math.min(Math.max(sphere.phi + down, 0.02), Math.PI - 0.02);
    sphere.radius *= zoom;
    const turned = new Vector3().setFromSpherical(sphere);
    this.camera.position.copy(this.controls.target).add(new Vector3(turned.z, turned.x, turned.y));
    this.controls.update();
    this.changed();
  }

  shift(across, down) {
    const far = this.camera.position.distanceTo(this.controls.target);
    const way = new Vector3().setFromMatrixColumn(this.camera.matrix, 0).multiplyScalar(across * far);
    way.addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrix, 1), -down * far);
    this.camera.position.add(way);
    this.controls.target.add(way);
    this.controls.update();
    this.changed();
  }
}

export const emptyBox = () => new Box3();
