// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/distil_task.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "doorforge/policy/hand_sight.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/hand_stepper.h"

#include "drawn_doors.h"

namespace doorforge {
namespace {

/// What all steppers of a task share.
struct SharedLesson {
  SharedLesson(const std::vector<FoundDoor>& found, const HandPolicyRecord& knows,
               const DistilConfig& from)
      : config(from), teacher(knows), doors(found, from.scene, from.dagger.seed, "dagger/door") {}

  DistilConfig config;
  HandNetworkPolicy teacher;
  internal::DrawnDoors doors;
};

class LessonStepper : public DaggerStepper {
 public:
  explicit LessonStepper(std::shared_ptr<SharedLesson> shared) : shared_(std::move(shared)) {}

  void Reset(std::uint64_t episode) override {
    const DistilConfig& config = shared_->config;
    const RobotModel& robot = shared_->doors.robot();
    stepper_.reset();  // it refers to the door and the camera
    drawn_ = shared_->doors.At(episode);
    camera_.emplace(drawn_.scene, *drawn_.door, robot, config.cloud);
    camera_->SampleAs({config.look.points, config.look.crop_radius_m});
    stepper_.emplace(*drawn_.door, robot, shared_->teacher.task());
    stepper_->Reset(drawn_.scene, &*camera_);
  }

  HandSight See() override { return HandSightOf(stepper_->now().state, stepper_->Look()); }

  std::vector<float> Teach() override {
    std::vector<float> action = shared_->teacher.ActionOf(stepper_->now().state);
    for (float& a : action) a = std::clamp(a, -1.0F, 1.0F);
    return action;
  }

  DaggerStep Step(std::span<const float> action) override {
    const HandCommand command =
        HandCommandOf(action, stepper_->now().state, shared_->teacher.task());
    const HandInstant& after = stepper_->Step(command);
    return {.over = after.over, .success = after.opened && !after.diverged};
  }

 private:
  std::shared_ptr<SharedLesson> shared_;
  internal::DrawnDoor drawn_;
  std::optional<CameraObserver> camera_;
  std::optional<HandStepper> stepper_;
};

}  // namespace

DaggerTask DistilTask(const std::vector<FoundDoor>& doors, const HandPolicyRecord& teacher,
                      const DistilConfig& config) {
  CheckDaggerConfig(config.dagger, "config.dagger");
  CheckHandLook(config.look, "config.look");
  const auto shared = std::make_shared<SharedLesson>(doors, teacher, config);
  const IdentifiedDoor first = shared->doors.First();
  const HandStepper refuses(*first, shared->doors.robot(), teacher.task);  // who does not fly
  return {config.look.points, [shared] { return std::make_unique<LessonStepper>(shared); }};
}

}  // namespace doorforge
