// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/hand_stepper.h"

#include <optional>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/inverse_kinematics.h"
#include "doorforge/rollout/outcome_judge.h"

#include "episode/contact_log.h"
#include "episode/episode_world.h"
#include "text_format.h"

namespace doorforge {

using internal::Format;
using internal::kDegree;

namespace {

RigidTransform TurnedBy(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  return angle > 0 ? RotationAbout(turn_rad / angle, angle) : RigidTransform::Identity();
}

// Where the tool centre begins, as drawn for the scene.
RigidTransform BeginOfTool(const Scene& scene, const DoorAsset& door, const HandTaskConfig& task) {
  Rng rng(scene.seed, "hand_start/" + scene.door_id + "/" + std::to_string(scene.episode));
  const auto draw = [&rng](double most) {
    const double x = rng.Uniform(-most, most);
    const double y = rng.Uniform(-most, most);
    return Eigen::Vector3d(x, y, rng.Uniform(-most, most));
  };
  const Eigen::Vector3d moved = draw(task.start_spread_m);
  const Eigen::Vector3d turned = draw(task.start_turn_rad);
  const RigidTransform grasp(scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
                             door.handle_from_grasp);
  return grasp * Translation(moved - task.start_distance_m * Eigen::Vector3d::UnitZ()) *
         TurnedBy(turned);
}

JointVector BeginOfJoints(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                          const HandTaskConfig& task) {
  const JointVector rest = robot.InitialPosition();
  const auto solution = SolveInverseKinematics(robot, scene.world_from_robot_base,
                                               {BeginOfTool(scene, door, task), rest}, rest);
  Require(solution.Reached(), ErrorCode::kInvalidArgument,
          "scene: door \"" + scene.door_id + "\": the hand does not get to where it is to begin, " +
              Format("it stays %.0f mm away", 1000 * solution.position_error_m));
  return solution.position;
}

// What is never finite has no place to go to.
void CheckCommand(const HandCommand& command) {
  Require(command.move_m.allFinite() && command.turn_rad.allFinite(), ErrorCode::kInvalidArgument,
          "command: its move and turn must be finite numbers");
}

}  // namespace

/// One episode.
class HandStepper::Running {
 public:
  Running(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
          const HandTaskConfig& task, HandEpisodeEnd end, Observer* observer)
      : task_(task),
        end_(end),
        door_(ApplyVariation(door, scene.variation)),
        world_(scene, door_, robot, observer, BeginOfJoints(scene, door_, robot, task)) {
    world_.Watch(EpisodePhase::kStart);
    Settle();
  }

  void Act(const HandCommand& command) {
    world_.controller().close_fingers = command.close_fingers;
    world_.controller().MoveHandTo(Target(command),
                                   task_.steps_per_action * world_.scene().physics.time_step_s);
    for (int i = 0; i < task_.steps_per_action && !world_.diverged(); ++i) {
      world_.StepHand();
      log_.Note(world_);
      if (!held_ && world_.contacts().BothPads()) NoteHold();
    }
    ++actions_;
    Settle();
    world_.Watch(now_.over ? EpisodePhase::kEnd : EpisodePhase::kOpen);
  }

  LabelledCloud Look() const {
    Observer* observer = world_.observer();
    return observer == nullptr ? LabelledCloud{}
                               : observer->Observe(world_.Snapshot(EpisodePhase::kOpen));
  }

  const HandInstant& now() const { return now_; }
  Episode Summary() const;

 private:
  RigidTransform Target(const HandCommand& command) const;
  HandState StateNow() const;
  void NoteHold();
  void Settle();
  bool IsOver() const;
  bool HasTouched() const { return log_.StepsWithoutPads(world_.step()) <= world_.step(); }
  Verdict FailureNow() const;
  Verdict OpeningFailure() const;

  HandTaskConfig task_;
  HandEpisodeEnd end_;
  DoorAsset door_;
  internal::EpisodeWorld world_;
  internal::ContactLog log_;
  bool held_ = false;  // both pads touched the handle once
  int actions_ = 0;
  HandInstant now_;
};

// The tool centre is moved and turned about itself.
RigidTransform HandStepper::Running::Target(const HandCommand& command) const {
  RigidTransform tool = world_.world().PoseOfRobot().world_from_tcp;
  tool.translation() += command.move_m;
  tool.linear() = TurnedBy(command.turn_rad).linear() * tool.linear();
  return tool * world_.robot().hand_from_tcp().inverse();
}

void HandStepper::Running::NoteHold() {
  held_ = true;
  world_.NoteGrasp();
}

HandState HandStepper::Running::StateNow() const {
  const WorldState& world = world_.state();
  const RobotModel& robot = world_.robot();
  const RobotPose pose = world_.world().PoseOfRobot();
  const PrivilegedState privileged = world_.Privileged();
  const Latch& latch = world_.scene().latch;
  HandState state;
  state.world_from_tcp = pose.world_from_tcp;
  const Eigen::Matrix<double, 6, 1> twist =
      robot.TcpJacobian(pose) * world.robot_velocity.head(robot.arm_count());
  state.tcp_m_s = twist.head<3>();
  state.tcp_rad_s = twist.tail<3>();
  state.finger_m = {world.robot_position[robot.left_finger()],
                    world.robot_position[robot.right_finger()]};
  state.finger_m_s = {world.robot_velocity[robot.left_finger()],
                      world.robot_velocity[robot.right_finger()]};
  state.world_from_grasp = privileged.world_from_handle * door_.handle_from_grasp;
  state.hinge_rad = world.hinge_rad;
  state.hinge_rad_s = world.hinge_rad_s;
  state.handle_rad = world.handle_rad;
  state.handle_rad_s = world.handle_rad_s;
  state.handle_done_rad = latch.type == LatchType::kNone ? 0 : latch.handle_done_angle_rad;
  state.locked = world.locked;
  state.hinge_origin_m = privileged.hinge_origin_in_world;
  state.hinge_axis = privileged.hinge_axis_in_world;
  state.handle_origin_m = privileged.handle_origin_in_world;
  state.handle_axis = privileged.handle_axis_in_world;
  return state;
}

void HandStepper::Running::Settle() {
  const DoorContacts& contacts = world_.contacts();
  now_.state = StateNow();
  now_.state.closes_fingers = world_.controller().close_fingers;
  now_.pads = {contacts.pad_points[0] > 0, contacts.pad_points[1] > 0};
  now_.opened = log_.opened();
  now_.diverged = world_.diverged();
  now_.over = IsOver();
}

bool HandStepper::Running::IsOver() const {
  if (world_.diverged() || actions_ >= task_.max_actions) return true;
  if (end_ == HandEpisodeEnd::kBudget) return false;
  const bool far_enough =
      log_.opened() && world_.state().hinge_rad > world_.scene().physics.finish_hinge_rad;
  return far_enough || log_.coasted();
}

Verdict HandStepper::Running::OpeningFailure() const {
  const long without_pads = log_.StepsWithoutPads(world_.step());
  const bool latched = world_.scene().latch.type != LatchType::kNone;
  const PhysicsConfig& physics = world_.scene().physics;
  const double handle_deg = world_.memory().peak_handle_rad / kDegree;
  return JudgeOpening({.hinge_rad = world_.state().hinge_rad,
                       .actions = actions_,
                       .without_pads_s = static_cast<double>(without_pads) * physics.time_step_s,
                       .slip_m = held_ ? world_.Slip() : 0,
                       .coasted = log_.coasted(),
                       .lost_pads = without_pads > physics.steps_per_action,
                       .handle_turned = !latched || world_.state().handle_done,
                       .locked = world_.state().locked,
                       .early = Format("the handle came to %.1f deg", handle_deg),
                       .held_up_at_loss = log_.held_up_at_loss(),
                       .hindrance = world_.HindranceNow()},
                      world_.limits());
}

// Who never touches the handle has not reached it; who never had both pads on it has missed it.
Verdict HandStepper::Running::FailureNow() const {
  if (world_.diverged()) return {EpisodeOutcome::kDiverged, Describe(*world_.world().fault())};
  const double away_m =
      (now_.state.world_from_tcp.translation() - now_.state.world_from_grasp.translation()).norm();
  if (!HasTouched() && !log_.coasted())
    return {EpisodeOutcome::kNotReached,
            Format("no pad touched the handle, tool %.0f mm from it in the end", 1000 * away_m)};
  if (!held_ && !log_.coasted())
    return {EpisodeOutcome::kGraspMissed, Format("never both pads on the handle, hinge at %.1f deg",
                                                 now_.state.hinge_rad / kDegree)};
  return OpeningFailure();
}

Episode HandStepper::Running::Summary() const {
  Episode episode;
  const bool opened = log_.opened() && !world_.diverged();
  const Verdict verdict =
      opened ? Verdict{EpisodeOutcome::kOpened, Format("hinge %.1f deg after %d actions; ",
                                                       now_.state.hinge_rad / kDegree, actions_) +
                                                    log_.touched_at_opening()}
             : FailureNow();
  episode.scene = world_.scene();
  episode.outcome = verdict.outcome;
  episode.detail = verdict.detail;
  episode.peak_hinge_rad = world_.memory().peak_hinge_rad;
  episode.peak_handle_rad = world_.memory().peak_handle_rad;
  episode.simulated_s = world_.state().time_s;
  episode.handle_turned =
      HasTouched() && (world_.scene().latch.type == LatchType::kNone || world_.state().handle_done);
  episode.grasps = held_ ? 1 : 0;
  episode.peak_force_n = world_.memory().forces.normal_n();
  episode.peak_net_force_n = world_.memory().forces.net_n();
  episode.state_sha256 = world_.world().StateHash();
  return episode;
}

HandStepper::HandStepper(const DoorAsset& door, const RobotModel& robot, const HandTaskConfig& task,
                         HandEpisodeEnd end)
    : door_(&door), robot_(&robot), task_(task), end_(end) {
  CheckHandTask(task, "task");
  Require(robot.base() == RobotBase::kFloating, ErrorCode::kInvalidConfig,
          "scene.physics.base: " + std::string(NameOf(robot.base())) +
              ", where a hand that flies is needed; take --preset doorgym, or set "
              "scene.physics.base=floating");
}
HandStepper::~HandStepper() = default;
HandStepper::HandStepper(HandStepper&&) noexcept = default;
HandStepper& HandStepper::operator=(HandStepper&&) noexcept = default;

const HandInstant& HandStepper::Reset(const Scene& scene, Observer* observer) {
  Require(scene.door_id == door_->id, ErrorCode::kInvalidArgument,
          "the scene is of door \"" + scene.door_id + "\", not of \"" + door_->id + '"');
  CheckEpisodeLimits(scene.limits, "scene.limits");
  running_.reset();
  running_ = std::make_unique<Running>(scene, *door_, *robot_, task_, end_, observer);
  return running_->now();
}

HandStepper::Running& HandStepper::Live() const {
  Require(running_ != nullptr, ErrorCode::kInvalidArgument,
          "episode: there is none yet; call Reset() with a scene first");
  return *running_;
}

const HandInstant& HandStepper::Step(const HandCommand& command) {
  Running& running = Live();
  Require(!running.now().over, ErrorCode::kInvalidArgument,
          "command: the episode is over; call Reset() with a scene first");
  CheckCommand(command);
  running.Act(command);
  return running.now();
}

LabelledCloud HandStepper::Look() { return Live().Look(); }

const HandInstant& HandStepper::now() const { return Live().now(); }
Episode HandStepper::Summary() const { return Live().Summary(); }

Episode RunHandEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                       HandPolicy& policy, Observer* observer) {
  HandStepper stepper(door, robot, policy.task());
  stepper.Reset(scene, observer);
  const bool looks = policy.look().has_value();
  while (!stepper.now().over)
    stepper.Step(policy.Act(stepper.now().state, looks ? stepper.Look() : LabelledCloud{}));
  return stepper.Summary();
}

}  // namespace doorforge
