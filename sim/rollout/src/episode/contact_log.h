// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "doorforge/rollout/outcome_judge.h"

#include "episode/episode_world.h"

namespace doorforge::internal {

/// What touched what in the course of an episode, as far as its outcome asks. A value.
class ContactLog {
 public:
  void NoteSelfContact(const DoorContacts& contacts);
  /// Everything, after each step under a policy's action.
  void Note(const EpisodeWorld& world);

  void BeginHold(long step) { last_pad_step_ = step; }       ///< The fingers hold the handle.
  void BeginOpening(long step) { last_touch_step_ = step; }  ///< A hand that is off has its time.

  long StepsWithoutPads(long step) const { return step - last_pad_step_; }
  long StepsWithoutTouch(long step) const { return step - last_touch_step_; }
  bool opened() const { return opened_; }    ///< Passed the angle with a pad on the handle.
  bool coasted() const { return coasted_; }  ///< Passed it without.
  /// What held the hand up when the pads left the handle last.
  const std::optional<Verdict>& held_up_at_loss() const { return held_up_at_loss_; }
  const std::string& touched_at_opening() const { return touched_at_opening_; }
  const std::string& touched_itself() const { return touched_itself_; }  ///< "link2-hand ..."

 private:
  void NoteOpening(const EpisodeWorld& world, const DoorContacts& contacts);

  long last_pad_step_ = -1;
  long last_touch_step_ = -1;
  bool opened_ = false;
  bool coasted_ = false;
  std::optional<Verdict> held_up_at_loss_;
  std::string touched_at_opening_;
  std::string touched_itself_;
};

}  // namespace doorforge::internal
