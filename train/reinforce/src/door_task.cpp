// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/door_task.h"

#include <optional>
#include <utility>

#include "doorforge/policy/hand_network.h"
#include "doorforge/rollout/camera_observer.h"

#include "drawn_doors.h"

namespace doorforge {
namespace {

/// What all steppers of a task share.
struct SharedDoors {
  SharedDoors(const std::vector<FoundDoor>& found, const HandTrainingConfig& from,
              std::shared_ptr<const FrozenSight> sees)
      : config(from), sight(std::move(sees)), doors(found, from.scene, from.ppo.seed, "ppo/door") {}

  int Observations() const { return sight ? sight->size() : kHandFeatures; }

  HandTrainingConfig config;
  std::shared_ptr<const FrozenSight> sight;
  internal::DrawnDoors doors;
};

class DoorStepper : public PpoStepper {
 public:
  explicit DoorStepper(std::shared_ptr<SharedDoors> shared) : shared_(std::move(shared)) {}

  std::vector<float> Reset(std::uint64_t episode) override {
    const HandTrainingConfig& config = shared_->config;
    stepper_.reset();  // it refers to the door and the camera
    drawn_ = shared_->doors.At(episode);
    if (const FrozenSight* sight = shared_->sight.get()) {
      camera_.emplace(drawn_.scene, *drawn_.door, shared_->doors.robot(), config.cloud);
      camera_->SampleAs({sight->look().points, sight->look().crop_radius_m});
    }
    stepper_.emplace(*drawn_.door, shared_->doors.robot(), config.task, HandEpisodeEnd::kBudget);
    stepper_->Reset(drawn_.scene, camera_ ? &*camera_ : nullptr);
    return Observe();
  }

  PpoStep Step(std::span<const float> action) override {
    const HandTrainingConfig& config = shared_->config;
    const HandInstant& after =
        stepper_->Step(HandCommandOf(action, stepper_->now().state, config.task));
    // where the physics broke down, nobody earns what the numbers say
    if (after.diverged)
      return {.observation = std::vector<float>(static_cast<std::size_t>(shared_->Observations())),
              .terminated = true};
    return {.observation = Observe(),
            .reward = HandReward(after, action, config.reward),
            .truncated = after.over,
            .success = after.opened};
  }

 private:
  std::vector<float> Observe() {
    const HandState& state = stepper_->now().state;
    if (shared_->sight) return shared_->sight->NumbersOf(state, stepper_->Look());
    const HandFeatures features = HandFeaturesOf(state);
    return {features.begin(), features.end()};
  }

  std::shared_ptr<SharedDoors> shared_;
  internal::DrawnDoor drawn_;
  std::optional<CameraObserver> camera_;
  std::optional<HandStepper> stepper_;
};

}  // namespace

PpoTask DoorTask(const std::vector<FoundDoor>& doors, const HandTrainingConfig& config,
                 std::shared_ptr<const FrozenSight> sight) {
  CheckPpoConfig(config.ppo, "config.ppo");
  CheckHandTask(config.task, "config.task");
  const auto shared = std::make_shared<SharedDoors>(doors, config, std::move(sight));
  const IdentifiedDoor first = shared->doors.First();
  const HandStepper refuses(*first, shared->doors.robot(), config.task);  // who does not fly
  return {shared->Observations(), kHandActions,
          [shared] { return std::make_unique<DoorStepper>(shared); }};
}

}  // namespace doorforge
