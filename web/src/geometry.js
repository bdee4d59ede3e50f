// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

import { BufferAttribute, BufferGeometry } from 'three';

const CREASE = Math.cos((40 * Math.PI) / 180); // edges flatter than this are shaded smooth, as previews do

// Welds corners at one position: number of the position of each vertex.
const positionNumbers = (positions) => {
  const known = new Map();
  const numbers = new Uint32Array(positions.length / 3);
  for (let i = 0; i < numbers.length; ++i) {
    const key = `${positions[3 * i]},${positions[3 * i + 1]},${positions[3 * i + 2]}`;
    let number = known.get(key);
    if (number === undefined) known.set(key, (number = known.size));
    numbers[i] = number;
  }
  return numbers;
};

const faceNormals = ({ positions: p, indices }) => {
  const normals = new Float32Array(indices.length);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [3 * indices[i], 3 * indices[i + 1], 3 * indices[i + 2]];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    normals[i] = uy * vz - uz * vy;
    normals[i + 1] = uz * vx - ux * vz;
    normals[i + 2] = ux * vy - uy * vx;
  }
  return normals;
};

// Which faces meet at each position, as one list and where each position's part of it begins.
const facesAt = (indices, numbers) => {
  let count = 0;
  for (const number of numbers) count = Math.max(count, number + 1);
  const starts = new Uint32Array(count + 1);
  for (const index of indices) ++starts[numbers[index] + 1];
  for (let i = 0; i < count; ++i) starts[i + 1] += starts[i];
  const faces = new Uint32Array(indices.length);
  const filled = starts.slice(0, count);
  for (let i = 0; i < indices.length; ++i) faces[filled[numbers[indices[i]]]++] = Math.floor(i / 3) * 3;
  return { starts, faces };
};

const creasedNormals = (mesh) => {
  const numbers = positionNumbers(mesh.positions);
  const face = faceNormals(mesh);
  const { starts, faces } = facesAt(mesh.indices, numbers);
  const length = new Float32Array(face.length / 3);
  for (let i = 0; i < length.length; ++i) length[i] = Math.hypot(face[3 * i], face[3 * i + 1], face[3 * i + 2]) || 1e-30;
  const normals = new Float32Array(mesh.indices.length * 3);
  for (let corner = 0; corner < mesh.indices.length; ++corner) {
    const own = Math.floor(corner / 3) * 3;
    const position = numbers[mesh.indices[corner]];
    let [x, y, z] = [0, 0, 0];
    for (let k = starts[position]; k < starts[position + 1]; ++k) {
      const f = faces[k];
      const cosine = (face[f] * face[own] + face[f + 1] * face[own + 1] + face[f + 2] * face[own + 2]) / (length[f / 3] * length[own / 3]);
      if (cosine < CREASE) continue;
      x += face[f];
      y += face[f + 1];
      z += face[f + 2];
    }
    const norm = Math.hypot(x, y, z) || 1;
    normals.set([x / norm, y / norm, z / norm], 3 * corner);
  }
  return normals;
};

/** A mesh of a page as three.js draws it: three corners a triangle, smooth across flat edges. */
export const geometryOf = (mesh) => {
  const corners = new Float32Array(mesh.indices.length * 3);
  for (let i = 0; i < mesh.indices.length; ++i) {
    const at = 3 * mesh.indices[i];
    corners.set(mesh.positions.subarray(at, at + 3), 3 * i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(corners, 3));
  geometry.setAttribute('normal', new BufferAttribute(creasedNormals(mesh), 3));
  if (mesh.uv) geometry.setAttribute('uv', new BufferAttribute(mesh.uv, 2));
  return geometry;
};
