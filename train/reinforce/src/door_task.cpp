// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/door_task.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/rollout/base_placement.h"

namespace doorforge {
namespace {

/// What all steppers of a task share; immutable but for the cache, which may be used by several
/// threads.
struct SharedDoors {
  SharedDoors(const std::vector<FoundDoor>& doors, const HandTrainingConfig& from)
      : config(from), robot(LoadRobot({}, from.scene.physics.base)), cache(doors) {
    std::map<Category, std::vector<std::size_t>> sorted;
    for (std::size_t i = 0; i < doors.size(); ++i) sorted[doors[i].identity.category].push_back(i);
    for (auto& [category, of_it] : sorted) by_category.push_back(std::move(of_it));
  }

  std::size_t Draw(std::uint64_t episode) const {
    Rng rng(config.ppo.seed, "ppo/door/" + std::to_string(episode));
    const auto& category = by_category[rng.Index(static_cast<std::uint32_t>(by_category.size()))];
    return category[rng.Index(static_cast<std::uint32_t>(category.size()))];
  }

  HandTrainingConfig config;
  RobotModel robot;
  DoorCache cache;
  std::vector<std::vector<std::size_t>> by_category;
};

std::vector<float> FeaturesOf(const HandInstant& instant) {
  const HandFeatures features = HandFeaturesOf(instant.state);
  return {features.begin(), features.end()};
}

class DoorStepper : public PpoStepper {
 public:
  explicit DoorStepper(std::shared_ptr<SharedDoors> shared) : shared_(std::move(shared)) {}

  std::vector<float> Reset(std::uint64_t episode) override {
    const HandTrainingConfig& config = shared_->config;
    stepper_.reset();  // it refers to the door
    door_ = shared_->cache.Take(shared_->Draw(episode));
    const Scene scene = PlaceRobotBase(
        shared_->robot, SampleScene(door_, config.ppo.seed, episode, config.scene), *door_);
    stepper_.emplace(*door_, shared_->robot, config.task, HandEpisodeEnd::kBudget);
    return FeaturesOf(stepper_->Reset(scene));
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
  IdentifiedDoor door_;
  std::optional<HandStepper> stepper_;
};

}  // namespace

PpoTask DoorTask(const std::vector<FoundDoor>& doors, const HandTrainingConfig& config) {
  Require(!doors.empty(), ErrorCode::kInvalidArgument, "ppo: there are no doors to learn on");
  Require(config.scene.robot.empty(), ErrorCode::kInvalidConfig,
          "config.scene.robot: ppo knows the built-in robot's hand, found \"" + config.scene.robot +
              '"');
  CheckPpoConfig(config.ppo, "config.ppo");
  CheckHandTask(config.task, "config.task");
  auto shared = std::make_shared<SharedDoors>(doors, config);
  const IdentifiedDoor first = shared->cache.Take(0);
  const HandStepper refuses(*first, shared->robot, config.task);  // a robot that does not fly
  return {kHandFeatures, kHandActions, [shared] { return std::make_unique<DoorStepper>(shared); }};
}

}  // namespace doorforge
