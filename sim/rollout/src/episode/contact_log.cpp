// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode/contact_log.h"

#include "text_format.h"

namespace doorforge::internal {

void ContactLog::NoteSelfContact(const DoorContacts& contacts) {
  if (contacts.self_points > 0)
    touched_itself_ = contacts.self_touches + Format(" with %.0f N", contacts.self_force_n);
}

void ContactLog::Note(const EpisodeWorld& world) {
  const DoorContacts& contacts = world.contacts();
  NoteSelfContact(contacts);
  if (!contacts.AnyPad() && last_pad_step_ == world.step() - 1)
    held_up_at_loss_ = HeldUpBy(world.HindranceNow(), world.limits());
  if (contacts.AnyPad()) last_pad_step_ = world.step();
  if (contacts.AnyPad() || contacts.arm_points > 0) last_touch_step_ = world.step();
  const bool beyond = world.state().hinge_rad > world.limits().open_angle_rad;
  if (beyond && !opened_ && !coasted_) NoteOpening(world, contacts);
}

// A pad that let go within the last action has still opened the door.
void ContactLog::NoteOpening(const EpisodeWorld& world, const DoorContacts& contacts) {
  const bool pads = last_pad_step_ >= 0 &&
                    StepsWithoutPads(world.step()) <= world.scene().physics.steps_per_action;
  opened_ = pads || world.limits().grip_needed == 0;
  coasted_ = !opened_;
  touched_at_opening_ =
      Format("%s at %.0f deg, finger to handle %.1f mm",
             contacts.BothPads() ? "both pads"
             : pads              ? "one pad or just before"
                                 : "no pad",
             world.limits().open_angle_rad / kDegree, 1000 * contacts.pad_distance_m);
  if (contacts.arm_points > 0)
    touched_at_opening_ +=
        ", arm touches " + contacts.arm_touches + Format(" with %.0f N", contacts.arm_force_n);
}

}  // namespace doorforge::internal
