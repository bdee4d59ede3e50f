// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The latch as a hand on the sliders meets it. The effort's law is that of docs/format-door.md; a bolt
// is where it is: drawn back by the handle, pushed back by the strike as the door closes.

import { apply, inverse, matrixOf, multiply, rotationAbout } from './kinematics.js';

const AJAR = 0.01; // [rad] from here on an effort latch does not catch

const clamp = (value, least, most) => Math.min(Math.max(value, least), most);

/** How far the handle has moved the bolt: 0 thrown, negative drawn back [m]. */
export const drawnBy = (bolt, handle) => 0 - Math.min(bolt.throw_m, Math.max(0, handle) * bolt.travel_m_per_rad);

const strikeFromBolt = (record, hinge) => {
  const joint = record.joints[0];
  const baseFromLeaf = multiply(matrixOf(joint.parent_from_child_at_zero), rotationAbout(joint.axis, hinge));
  return multiply(inverse(matrixOf(record.bolt.base_from_strike)), multiply(baseFromLeaf, matrixOf(record.bolt.leaf_from_bolt)));
};

/** Where the tip of the bolt is in the strike's frame: x the way in which the door opens. */
const tipAt = (record, hinge, position) => {
  const [x, y, z] = record.bolt.tip_m;
  return apply(strikeFromBolt(record, hinge), [x, y + position, z]);
};

const isCaught = (record, hinge, position) => {
  const [x, y] = tipAt(record, hinge, position);
  return y > 0 && x < record.bolt.strike_thickness_m / 2;
};

/** The bolt where the strike leaves it as the door closes: its tip stays out of it. */
const pushedTo = (record, hinge, position) => {
  const [x, y] = tipAt(record, hinge, position);
  const { strike_thickness_m: thick, throw_m: most } = record.bolt;
  if (y <= 0 || x <= 0 || x > thick + 2 * record.bolt.tip_m[0]) return position;
  return Math.max(-most, position - y);
};

/** The hinge's least play behind a bolt that is caught [rad]. */
const playOf = (record) => {
  const origin = record.joints[0].parent_from_child_at_zero.position_m;
  const strike = record.bolt.base_from_strike.position_m;
  return (0.9 * record.bolt.play_m) / Math.max(0.01, Math.abs(strike[1] - origin[1]));
};

export class LiveLatch {
  constructor(record) {
    this.record = record;
    this.hinge = this.limits(0)[0] > 0 ? this.limits(0)[0] : 0;
    this.handle = 0;
    this.locked = false;
    this.settle();
  }

  limits(joint) {
    const found = this.record.joints[joint];
    return found ? [found.lower_rad, found.upper_rad] : [0, 0];
  }

  get type() {
    return this.record.latch.type;
  }

  /** Whether the latch keeps the leaf from opening now. */
  isLocked() {
    if (this.type === 'bolt') return this.record.bolt !== null && isCaught(this.record, this.hinge, this.bolt);
    return this.type === 'effort' && this.locked;
  }

  /** A hand turns the handle; the latch answers. */
  turnHandle(angle) {
    this.handle = clamp(angle, ...this.limits(1));
    this.settle();
  }

  /** A hand moves the leaf, as far as the latch lets it. Returns the angle that it comes to. */
  moveHinge(angle) {
    const wanted = clamp(angle, ...this.limits(0));
    if (wanted > this.hinge && this.isLocked()) {
      const most = this.type === 'bolt' && this.record.bolt ? playOf(this.record) : 0;
      this.hinge = clamp(wanted, this.hinge, Math.max(this.hinge, most));
    } else {
      this.hinge = wanted;
    }
    this.settle();
    return this.hinge;
  }

  settle() {
    const { latch, bolt } = this.record;
    const drawn = bolt ? drawnBy(bolt, this.handle) : 0;
    if (this.type === 'effort') {
      const free = latch.unlocks_ajar
        ? Math.abs(this.hinge) > AJAR
        : !latch.relatch && !this.locked && this.hinge > AJAR;
      this.locked = this.handle <= latch.unlock_angle_rad && !free;
      if (this.locked) this.hinge = clamp(0, ...this.limits(0)); // its effort shuts the leaf
    }
    this.bolt = bolt ? Math.min(drawn, pushedTo(this.record, this.hinge, drawn)) : 0;
  }
}
