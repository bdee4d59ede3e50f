// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/outcome_text.h"

namespace doorforge::internal {

OutcomeText TextOf(EpisodeOutcome outcome) {
  switch (outcome) {
    case EpisodeOutcome::kOpened:
      return {"Opened", "The door passed 45° with the gripper still on the handle."};
    case EpisodeOutcome::kNotReached:
      return {"Not reached", "The gripper did not get to the grasp pose."};
    case EpisodeOutcome::kGraspMissed:
      return {"Grasp missed", "The fingers closed on nothing, or only one of them touched."};
    case EpisodeOutcome::kHandleSlipped:
      return {"Handle slipped", "The grasp was lost while the handle was being turned."};
    case EpisodeOutcome::kHandleStuck:
      return {"Handle stuck", "The grasp held, but the handle did not reach its unlock angle."};
    case EpisodeOutcome::kGripLost:
      return {"Grip lost", "The door was unlocked, but the grasp was lost before 45°."};
    case EpisodeOutcome::kDoorStuck:
      return {"Door stayed below 45°", "The grasp held, but the actions ran out before 45°."};
    case EpisodeOutcome::kJointLimit:
      return {"Joint limit", "A joint of the arm was at its limit, so the hand could not follow."};
    case EpisodeOutcome::kCollision:
      return {"Collision", "The arm or the hand met the door and could not go on."};
    case EpisodeOutcome::kDiverged:
      return {"Physics diverged", "The simulated state stopped being plausible."};
  }
  return {"Unknown", ""};
}

OutcomeText TextOf(std::string_view cause) {
  if (cause == kNoGraspInView)
    return {"No grasp in view", "The camera showed the grasper no point of the handle."};
  if (cause == kNoAction)
    return {"Policy failed",
            "A policy had no action to give: it went away, hung or said nonsense."};
  if (cause == kDoorGone)
    return {"Door gone", "The door's folder was there in the beginning, and could not be read."};
  const auto outcome = EpisodeOutcomeNamed(cause);
  return outcome ? TextOf(*outcome) : OutcomeText{"Unknown", ""};
}

std::string TitleOf(Category category) {
  switch (category) {
    case Category::kInterior:
      return "Interior";
    case Category::kWindow:
      return "Window";
    case Category::kCar:
      return "Car";
    case Category::kSafe:
      return "Safe";
    case Category::kStorageFurniture:
      return "Storage furniture";
    case Category::kRefrigerator:
      return "Refrigerator";
  }
  return "Unknown";
}

std::string TitleOf(const EpisodeGroup& group) {
  if (!group.category) return "All";
  if (!group.latched) return TitleOf(*group.category);
  return TitleOf(*group.category) + (*group.latched ? ", with a latch" : ", without");
}

}  // namespace doorforge::internal
