// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/door_task.h"

#include <optional>
#include <utility>

#include "doorforge/policy/hand_network.h"

#include "drawn_doors.h"

namespace doorforge {
namespace {

/// What all steppers of a task share.
struct SharedDoors {
  SharedDoors(const std::vector<FoundDoor>& found, const HandTrainingConfig& from)
      : config(from), doors(found, from.scene, from.ppo.seed, "ppo/door") {}

  HandTrainingConfig config;
  internal::DrawnDoors doors;
};

std::vector<float> FeaturesOf(const HandInstant& instant) {
  const HandFeatures features = HandFeaturesOf(instant.state);
  return {features.begin(), features.end()};
}

class DoorStepper : public PpoStepper {
 public:
  explicit DoorStepper(std::shared_ptr<SharedDoors> shared) : shared_(std::move(shared)) {}

  std::vector<float> Reset(std::uint64_t episode) override {
    stepper_.reset();  // it refers to the door
    drawn_ = shared_->doors.At(episode);
    stepper_.emplace(*drawn_.door, shared_->doors.robot(), shared_->config.task,
                     HandEpisodeEnd::kBudget);
    return FeaturesOf(stepper_->Reset(drawn_.scene));
  }

  PpoStep Step(std::span<const float> action) override {
    const HandTrainingConfig& config = shared_->config;
    const HandInstant& after =
        stepper_->Step(HandCommandOf(action, stepper_->now().state, config.task));
    // where the physics broke down, nobody earns what the numbers say
    if (after.diverged)
      return {.observation = std::vector<float>(kHandFeatures), .terminated = true};
    return {.observation = FeaturesOf(after),
            .reward = HandReward(after, action, config.reward),
            .truncated = after.over,
            .success = after.opened};
  }

 private:
  std::shared_ptr<SharedDoors> shared_;
  internal::DrawnDoor drawn_;
  std::optional<HandStepper> stepper_;
};

}  // namespace

PpoTask DoorTask(const std::vector<FoundDoor>& doors, const HandTrainingConfig& config) {
  CheckPpoConfig(config.ppo, "config.ppo");
  CheckHandTask(config.task, "config.task");
  const auto shared = std::make_shared<SharedDoors>(doors, config);
  const IdentifiedDoor first = shared->doors.First();
  const HandStepper refuses(*first, shared->doors.robot(), config.task);  // who does not fly
  return {kHandFeatures, kHandActions, [shared] { return std::make_unique<DoorStepper>(shared); }};
}

}  // namespace doorforge
