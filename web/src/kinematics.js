// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Poses of a door's links, in double precision. A matrix is 16 numbers, column by column.

export const identity = () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

export const multiply = (a, b) => {
  const product = new Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * column + k];
      product[4 * column + row] = sum;
    }
  }
  return product;
};

/** Of {position_m, quaternion_xyzw}. */
export const matrixOf = ({ position_m: p, quaternion_xyzw: [x, y, z, w] }) => [
  1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0,
  2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
  2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0,
  p[0], p[1], p[2], 1,
];

/** The turn about a unit axis through the origin (Rodrigues). */
export const rotationAbout = ([x, y, z], angle) => {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  const t = 1 - c;
  return [
    t * x * x + c, t * x * y + s * z, t * x * z - s * y, 0,
    t * x * y - s * z, t * y * y + c, t * y * z + s * x, 0,
    t * x * z + s * y, t * y * z - s * x, t * z * z + c, 0,
    0, 0, 0, 1,
  ];
};

export const translation = ([x, y, z]) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1];

/** The inverse of a rigid motion. */
export const inverse = (m) => {
  const turned = [m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, 0, 0, 0, 1];
  for (let row = 0; row < 3; ++row)
    turned[12 + row] = -(turned[row] * m[12] + turned[4 + row] * m[13] + turned[8 + row] * m[14]);
  return turned;
};

export const apply = (m, [x, y, z]) => [
  m[0] * x + m[4] * y + m[8] * z + m[12],
  m[1] * x + m[5] * y + m[9] * z + m[13],
  m[2] * x + m[6] * y + m[10] * z + m[14],
];

/** Poses of all links in the frame of the first; joint i carries link i + 1. */
export const linkPoses = (record, angles) => {
  const poses = [identity()];
  record.joints.forEach((joint, i) => {
    const still = multiply(poses[i], matrixOf(joint.parent_from_child_at_zero));
    poses.push(multiply(still, rotationAbout(joint.axis, angles[i] ?? 0)));
  });
  return poses;
};
