// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode_run.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numbers>
#include <utility>

#include "doorforge/rollout/standing_place.h"

namespace doorforge::internal {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kOpenAngle = 45 * kDegree;
constexpr double kReachSpeedFraction = 0.6;  // of the joints' velocity limits
constexpr double kApproachSpeed = 0.15;      // [m/s]
constexpr double kCloseTime = 1.2;           // [s]
constexpr double kBothPadsTime = 0.12;       // [s] of touch that makes a grasp
constexpr double kCenteringSpeed = 0.05;     // [m/s]
constexpr double kTurnSpeed = 0.8;           // [rad/s]
constexpr double kTurnLead = 0.25;           // [rad] ahead of the measured handle
constexpr double kTurnBeyond = 0.07;         // [rad] past "handle done"
constexpr double kTurnTime = 4;              // [s]
constexpr double kLostTime = 0.25;           // [s] without any pad on the handle
constexpr double kFarthestMove = 10;         // [m] no arm gets there, and the way would take hours
constexpr double kReachTolerance = 0.012;    // [m]
constexpr double kBlockingForce = 50;        // [N] of the arm or the hand on the door
constexpr double kHandBehind = 0.01;         // [m] of the hand, where something holds it up

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
Format(const char* format, ...) {
  char text[400];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace

EpisodeRun::EpisodeRun(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                       const EpisodeRoles& roles, Observer* observer)
    : door_(door),
      robot_(robot),
      roles_(roles),
      observer_(observer),
      world_(scene, door, robot, StartPosition(scene, robot)),
      controller_(robot, scene.world_from_robot_base, StartPosition(scene, robot)),
      action_noise_(scene.seed,
                    "episode/" + scene.door_id + "/" + std::to_string(scene.episode) + "/actions") {
  episode_.scene = scene;
  episode_.scene.robot = {robot.name(), robot.sha256()};
}

// ---- stepping -----------------------------------------------------------------------------------

void EpisodeRun::Step(const RobotCommand& command) {
  if (diverged_) return;
  world_.Step(command);
  ++step_;
  const WorldState& state = world_.state();
  diverged_ = world_.fault().has_value();
  if (diverged_) return;
  episode_.peak_hinge_rad = std::max(episode_.peak_hinge_rad, state.hinge_rad);
  episode_.peak_handle_rad = std::max(episode_.peak_handle_rad, state.handle_rad);
}

void EpisodeRun::StepHand() {
  Step(controller_.Step(world_.state().robot_position, episode_.scene.physics.time_step_s));
}

int EpisodeRun::StepsIn(double seconds) const {
  return static_cast<int>(std::lround(seconds / episode_.scene.physics.time_step_s));
}

double EpisodeRun::HandError(const RigidTransform& world_from_hand) const {
  return (world_.PoseOfRobot().world_from_hand.translation() - world_from_hand.translation())
      .norm();
}

bool EpisodeRun::MoveHand(const RigidTransform& world_from_hand, double speed_m_s) {
  const double distance =
      (world_from_hand.translation() - controller_.CommandedHand().translation()).norm();
  if (!(distance < kFarthestMove)) return false;
  controller_.MoveHandTo(world_from_hand, distance / speed_m_s);
  const int patience = StepsIn(0.4);
  for (int waited = 0; waited < patience && !diverged_;) {
    StepHand();
    if (!controller_.Arrived()) continue;
    ++waited;
    if (HandError(world_from_hand) < 0.002) return true;
  }
  return HandError(world_from_hand) < kReachTolerance;
}

// ---- stages -------------------------------------------------------------------------------------

void EpisodeRun::Plan(const GraspPlan& plan) {
  plan_ = plan;
  controller_.SetPosture(plan_.grasp);
}

EpisodeRun::Failure EpisodeRun::TakeHold() {
  Watch("start");
  Plan(PlanGrasp(episode_.scene, door_, robot_));
  if (const Failure failure = Reach()) return failure;
  return Grasp();
}

EpisodeRun::Failure EpisodeRun::TakeHold(GraspChooser& chooser) {
  Watch("start");
  chosen_ = true;
  std::optional<GraspAction> chosen = chooser.Choose(Snapshot("start"));
  if (!chosen) {
    problem_ = "no point to take hold of is in view";
    return EpisodeOutcome::kNotReached;
  }
  RigidTransform world_from_hand = RigidTransform::Identity();
  world_from_hand.linear() = chosen->world_from_hand_rotation;
  RigidTransform world_from_tcp = world_from_hand * robot_.hand_from_tcp();
  world_from_tcp.translation() =
      chosen->contact_m + kGraspInsertion * chosen->world_from_hand_rotation.col(2);
  const ArmReach reach = PlanReach(episode_.scene, robot_, world_from_tcp);
  Plan({WorldFromHandle(0).inverse() * reach.world_from_tcp, reach.pregrasp, reach.grasp, 0});
  RecordChoice(std::move(*chosen));
  const Failure unreached = Reach();
  const std::string problem = std::exchange(problem_, {});
  const Failure missed = Grasp();
  if (!missed || !unreached || diverged_) return missed;
  problem_ = problem + "; " + problem_;
  return unreached;
}

void EpisodeRun::RecordChoice(GraspAction chosen) {
  if (roles_.recorded != Stage::kGrasp) return;
  Observation observation;
  observation.cloud = std::move(chosen.cloud);
  if (HasProprioception(robot_))
    observation.proprioception =
        ProprioceptionOf(robot_, world_.state(), episode_.scene.world_from_robot_base);
  episode_.decisions.push_back(
      DecisionAt(observation, {chosen.contact_m, chosen.world_from_hand_rotation}));
}

EpisodeRun::Failure EpisodeRun::Reach() {
  const double dt = episode_.scene.physics.time_step_s;
  const int budget = StepsIn(4);
  for (int i = 0; i < budget && !diverged_; ++i) {
    const JointVector& now = world_.state().robot_position;
    Step(controller_.StepJoints(plan_.pregrasp, now, dt, kReachSpeedFraction));
    const JointVector rest = plan_.pregrasp - world_.state().robot_position;
    if (rest.head(robot_.arm_count()).cwiseAbs().maxCoeff() < 0.01) break;
  }
  Watch("reach");
  const RigidTransform goal =
      WorldFromHandle(0) * plan_.handle_from_tcp * robot_.hand_from_tcp().inverse();
  const bool arrived = MoveHand(goal, kApproachSpeed);
  if (arrived) return std::nullopt;
  problem_ = Format("hand %.0f mm from the grasp pose", 1000 * HandError(goal));
  const DoorContacts contacts = world_.Contacts();
  NoteSelfContact(contacts);
  return HeldUpBy(contacts).value_or(EpisodeOutcome::kNotReached);
}

// What keeps the hand from where it should be: the door in the arm's way, or the end of a joint.
EpisodeRun::Failure EpisodeRun::HeldUpBy(const DoorContacts& contacts) {
  if (HandError(controller_.CommandedHand()) < kHandBehind) return std::nullopt;
  if (contacts.arm_force_n > kBlockingForce) {
    problem_ += ", blocked at " + contacts.arm_touches;
    return EpisodeOutcome::kCollision;
  }
  if (contacts.self_force_n > kBlockingForce) {
    problem_ += ", blocked by itself at " + contacts.self_touches;
    return EpisodeOutcome::kCollision;
  }
  const JointVector& now = world_.state().robot_position;
  for (int i = 0; i < robot_.arm_count(); ++i) {
    const RobotJoint& joint = robot_.joint(i);
    const double position = now[i];
    const double margin = joint.prismatic ? 0.003 : 0.01;
    if (position - joint.lower > margin && joint.upper - position > margin) continue;
    problem_ += ", " + joint.name + " at its limit";
    return EpisodeOutcome::kJointLimit;
  }
  return std::nullopt;
}

// The arm does not yield to a finger that touches first, so it follows that finger.
void EpisodeRun::CenterHand(const DoorContacts& contacts) {
  if (contacts.BothPads() || !contacts.AnyPad()) return;
  RigidTransform hand = controller_.CommandedHand();
  const double way = contacts.pad_points[0] > 0 ? 1 : -1;
  const double distance = kCenteringSpeed * episode_.scene.physics.time_step_s;
  hand.translation() += way * distance * hand.linear().col(1);
  controller_.FollowHand(hand);
}

EpisodeRun::Failure EpisodeRun::Grasp() {
  controller_.close_fingers = true;
  const int budget = StepsIn(kCloseTime);
  const int enough = StepsIn(kBothPadsTime);
  int both = 0;
  DoorContacts contacts;
  for (int i = 0; i < budget && both < enough && !diverged_; ++i) {
    StepHand();
    contacts = world_.Contacts();
    NoteSelfContact(contacts);
    NoteForce(contacts);
    both = contacts.BothPads() ? both + 1 : 0;
    CenterHand(contacts);
  }
  Watch("grasp");
  handle_from_hand_at_grasp_ =
      WorldFromHandle(world_.state().handle_rad).inverse() * world_.PoseOfRobot().world_from_hand;
  // a chosen grasp is to show what comes of it, also where a single finger holds
  const bool on_trial = chosen_ && contacts.AnyPad();
  if (both >= enough || on_trial) {
    last_pad_step_ = step_;
    return std::nullopt;
  }
  problem_ =
      Format("pads touch with %d and %d points, fingers at %.1f mm", contacts.pad_points[0],
             contacts.pad_points[1], 1000 * world_.state().robot_position[robot_.left_finger()]);
  return EpisodeOutcome::kGraspMissed;
}

EpisodeRun::Failure EpisodeRun::Unlock() {
  if (episode_.scene.latch.type == LatchType::kNone) return std::nullopt;
  const double dt = episode_.scene.physics.time_step_s;
  const double goal = std::min(episode_.scene.latch.handle_done_angle_rad + kTurnBeyond,
                               door_.handle_joint.upper_rad);
  const int budget = StepsIn(kTurnTime);
  int lost = 0;
  double commanded = world_.state().handle_rad;
  for (int i = 0; i < budget && !diverged_; ++i) {
    const WorldState& state = world_.state();
    if (IsTurned()) {
      Watch("unlock");
      return std::nullopt;
    }
    // leads the measured angle, so that a stuck handle does not wind the arm up
    commanded =
        std::min({commanded + kTurnSpeed * dt, state.handle_rad + kTurnLead, goal + kTurnLead});
    controller_.FollowHand(WorldFromHandle(commanded) * handle_from_hand_at_grasp_);
    StepHand();
    const DoorContacts contacts = world_.Contacts();
    NoteForce(contacts);
    lost = contacts.AnyPad() ? 0 : lost + 1;
    if (lost > StepsIn(kLostTime)) break;
  }
  Watch("unlock");
  return TurnFailure(lost > 0);
}

// The sticky flag alone would not do: closing fingers may have knocked the handle down for a
// moment.
bool EpisodeRun::IsTurned() const {
  if (episode_.scene.latch.type == LatchType::kNone) return true;
  const WorldState& state = world_.state();
  return !state.locked && state.handle_rad >= episode_.scene.latch.handle_done_angle_rad;
}

// Whether it is time to open, by whoever says so.
bool EpisodeRun::EndsTurn() const {
  if (!roles_.predicted_turned) return IsTurned();
  return actions_ > 0 && roles_.predicted_turned();
}

EpisodeRun::Failure EpisodeRun::Turn(Policy& handle) {
  const PhysicsConfig& physics = episode_.scene.physics;
  BeginStage(handle, Stage::kHandle);
  const auto off = [&] { return step_ - last_pad_step_; };
  while (actions_ < physics.max_handle_actions && !diverged_ && !EndsTurn()) {
    Decide(handle, Stage::kHandle);
    if (off() > 3L * physics.steps_per_action) break;
  }
  Watch("unlock");
  const bool lost = off() > physics.steps_per_action;
  const bool said = EndsTurn();
  if (!said && (lost || !roles_.predicted_turned)) return TurnFailure(lost);
  const WorldState& state = world_.state();
  if (!IsTurned() && !state.handle_done)
    early_ =
        Format("%s with the handle at %.1f of %.1f deg",
               said ? "the switch came" : "no switch came, opening was tried",
               state.handle_rad / kDegree, episode_.scene.latch.handle_done_angle_rad / kDegree);
  return std::nullopt;
}

EpisodeRun::Failure EpisodeRun::TurnFailure(bool lost) {
  // the arm is stiff: if the handle alone is behind, the hand has turned on it
  const bool slipped = lost || Slip() > 0.025 || TurnSlip() > kTurnLead / 2;
  problem_ = Format("handle at %.1f of %.1f deg, grasp moved %.0f mm and turned %.0f deg in it",
                    world_.state().handle_rad / kDegree,
                    episode_.scene.latch.handle_done_angle_rad / kDegree, 1000 * Slip(),
                    TurnSlip() / kDegree);
  if (slipped) return EpisodeOutcome::kHandleSlipped;
  return HeldUpBy(world_.Contacts()).value_or(EpisodeOutcome::kHandleStuck);
}

void EpisodeRun::NoteSelfContact(const DoorContacts& contacts) {
  if (contacts.self_points > 0)
    touched_itself_ = contacts.self_touches + Format(" with %.0f N", contacts.self_force_n);
}

void EpisodeRun::NoteForce(const DoorContacts& contacts) {
  const double force = contacts.pad_force_n[0] + contacts.pad_force_n[1] + contacts.arm_force_n;
  episode_.peak_force_n = std::max(episode_.peak_force_n, force);
}

void EpisodeRun::NoteContacts() {
  const DoorContacts contacts = world_.Contacts();
  NoteSelfContact(contacts);
  NoteForce(contacts);
  const int per_action = episode_.scene.physics.steps_per_action;
  if (!contacts.AnyPad() && last_pad_step_ == step_ - 1) {
    held_up_at_loss_ = HeldUpBy(contacts);
    why_lost_ = std::exchange(problem_, {});
  }
  if (contacts.AnyPad()) last_pad_step_ = step_;
  if (contacts.AnyPad() || contacts.arm_points > 0) last_touch_step_ = step_;
  const bool beyond = world_.state().hinge_rad > kOpenAngle;
  if (!beyond || opened_ || coasted_) return;
  const bool pads = last_pad_step_ >= 0 && step_ - last_pad_step_ <= per_action;
  opened_ = pads;
  coasted_ = !opened_;
  touched_at_opening_ = Format("%s at 45 deg, finger to handle %.1f mm",
                               contacts.BothPads() ? "both pads"
                               : pads              ? "one pad or just before"
                                                   : "no pad",
                               1000 * contacts.pad_distance_m);
  if (contacts.arm_points > 0)
    touched_at_opening_ +=
        ", arm touches " + contacts.arm_touches + Format(" with %.0f N", contacts.arm_force_n);
}

void EpisodeRun::HoldAction() {
  for (int i = 0; i < episode_.scene.physics.steps_per_action && !diverged_; ++i) {
    StepHand();
    NoteContacts();
  }
}

Decision EpisodeRun::DecisionAt(const Observation& observation, const Action& action) const {
  const WorldState& state = world_.state();
  Decision decision;
  decision.cloud = observation.cloud;
  decision.proprioception = observation.proprioception;
  decision.action = ToVector(action);
  decision.executed = decision.action;
  decision.time_s = state.time_s;
  decision.hinge_rad = state.hinge_rad;
  decision.handle_rad = state.handle_rad;
  if (HasProprioception(robot_)) {
    const int missing_sliders = kSliderCount - robot_.base_count();
    std::copy(state.robot_position.begin(), state.robot_position.end(),
              decision.state.begin() + missing_sliders);
  }
  decision.state[kStateHinge] = state.hinge_rad;
  decision.state[kStateHandle] = state.handle_rad;
  decision.state[kStateBolt] = state.bolt_m;
  return decision;
}

void EpisodeRun::BeginStage(Policy& policy, Stage stage) {
  policy.Reset();
  if (stage == roles_.recorded && roles_.learner != nullptr) roles_.learner->Reset();
  actions_ = 0;
}

bool EpisodeRun::LearnerDrives(Stage stage) const {
  return stage == roles_.recorded && roles_.learner != nullptr &&
         actions_ < roles_.learner_decisions;
}

void EpisodeRun::Decide(Policy& policy, Stage stage) {
  const std::string_view name = stage == Stage::kOpen ? "open" : "unlock";
  const bool recorded = stage == roles_.recorded;
  Watch(name);
  const WorldState& state = world_.state();
  Observation observation;
  if (observer_ != nullptr && (recorded || policy.Looks()))
    observation.cloud = observer_->Observe(Snapshot(name));
  if (HasProprioception(robot_))
    observation.proprioception =
        ProprioceptionOf(robot_, state, episode_.scene.world_from_robot_base);
  observation.privileged = Privileged();
  const Action action = policy.Act(observation);
  Action executed = action;
  if (LearnerDrives(stage)) {
    executed = roles_.learner->Act(observation);
  } else if (recorded) {
    executed = WithNoise(action);
  }
  std::optional<Decision> decision;
  if (recorded) decision = DecisionAt(observation, action);
  if (recorded) decision->executed = ToVector(executed);
  const double hinge_rad = state.hinge_rad;
  const double handle_rad = state.handle_rad;

  const PhysicsConfig& physics = episode_.scene.physics;
  RigidTransform target = RigidTransform::Identity();
  target.linear() = executed.world_from_hand_rotation;
  target.translation() =
      observation.privileged.world_from_hand.translation() + executed.position_delta_m;
  controller_.MoveHandTo(target, physics.steps_per_action * physics.time_step_s);
  HoldAction();
  ++actions_;
  if (!decision) return;
  decision->score_rad = stage == Stage::kOpen ? world_.state().hinge_rad - hinge_rad
                                              : world_.state().handle_rad - handle_rad;
  episode_.decisions.push_back(std::move(*decision));
}

// Half of the noise is a bias that stays for the episode: a trained policy errs that way.
Action EpisodeRun::WithNoise(const Action& action) {
  const PhysicsConfig& physics = episode_.scene.physics;
  if (physics.action_noise_m == 0 && physics.action_noise_rad == 0) return action;
  if (!action_bias_) {
    action_bias_.emplace();
    for (double& bias : *action_bias_) bias = action_noise_.Normal();
  }
  std::array<double, 6> noise{};
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = std::sqrt(0.5) * ((*action_bias_)[i] + action_noise_.Normal());
  const Eigen::Vector3d turn =
      physics.action_noise_rad * Eigen::Vector3d(noise[3], noise[4], noise[5]);
  Action noisy = action;
  noisy.position_delta_m += physics.action_noise_m * Eigen::Vector3d(noise[0], noise[1], noise[2]);
  if (turn.norm() > 0)
    noisy.world_from_hand_rotation =
        RotationAbout(turn.normalized(), turn.norm()).linear() * action.world_from_hand_rotation;
  return noisy;
}

EpisodeRun::Failure EpisodeRun::Open(Policy& opening) {
  const PhysicsConfig& physics = episode_.scene.physics;
  // a hand that has been off the door for a second does not come back by itself
  const int given_up = 6 * physics.steps_per_action;
  BeginStage(opening, Stage::kOpen);
  last_touch_step_ = step_;
  for (int i = 0; i < physics.max_opening_actions && !coasted_ && !diverged_; ++i) {
    if (opened_ && world_.state().hinge_rad > physics.finish_hinge_rad) break;
    Decide(opening, Stage::kOpen);
    if (step_ - last_touch_step_ > given_up) break;
  }
  Watch("end");
  episode_.handle_done = early_.empty() || world_.state().handle_done;
  if (opened_) return std::nullopt;
  const bool lost = step_ - last_pad_step_ > physics.steps_per_action;
  problem_ = Format(
      "hinge at %.1f deg after %d actions, last pad contact %.2f s before the end, "
      "grasp moved %.0f mm",
      world_.state().hinge_rad / kDegree, actions_,
      static_cast<double>(step_ - last_pad_step_) * physics.time_step_s, 1000 * Slip());
  const DoorContacts contacts = world_.Contacts();
  if (!contacts.arm_touches.empty()) problem_ += ", arm touches " + contacts.arm_touches;
  if (coasted_) problem_ += ", the door coasted past 45 deg by itself";
  if (coasted_) return EpisodeOutcome::kGripLost;
  if (!episode_.handle_done) {
    problem_ += "; " + early_;
    if (world_.state().locked) return EpisodeOutcome::kHandleStuck;
  }
  if (!lost) return HeldUpBy(contacts).value_or(EpisodeOutcome::kDoorStuck);
  problem_ += why_lost_;
  return held_up_at_loss_.value_or(EpisodeOutcome::kGripLost);
}

// ---- what is seen -------------------------------------------------------------------------------

RigidTransform EpisodeRun::WorldFromHandle(double handle_rad) const {
  return episode_.scene.world_from_door *
         DoorFromLinks(door_, world_.state().hinge_rad, handle_rad)[kHandleLink];
}

double EpisodeRun::Slip() const {
  const RigidTransform now =
      WorldFromHandle(world_.state().handle_rad).inverse() * world_.PoseOfRobot().world_from_hand;
  const Eigen::Vector3d tcp = robot_.hand_from_tcp().translation();
  return (now * tcp - handle_from_hand_at_grasp_ * tcp).norm();
}

double EpisodeRun::TurnSlip() const {
  const RigidTransform now =
      WorldFromHandle(world_.state().handle_rad).inverse() * world_.PoseOfRobot().world_from_hand;
  return RotationVector(now.linear().transpose() * handle_from_hand_at_grasp_.linear()).norm();
}

PrivilegedState EpisodeRun::Privileged() const {
  const WorldState& state = world_.state();
  const auto links = world_.WorldFromDoorLinks();
  PrivilegedState privileged;
  privileged.hinge_rad = state.hinge_rad;
  privileged.handle_rad = state.handle_rad;
  privileged.world_from_handle = links[kHandleLink];
  privileged.world_from_hand = world_.PoseOfRobot().world_from_hand;
  privileged.hinge_origin_in_world = links[kLeafLink].translation();
  privileged.hinge_axis_in_world = links[kLeafLink].linear() * door_.hinge.axis;
  privileged.handle_origin_in_world = links[kHandleLink].translation();
  privileged.handle_axis_in_world = links[kHandleLink].linear() * door_.handle_joint.axis;
  privileged.handle_from_hand_at_grasp = handle_from_hand_at_grasp_;
  return privileged;
}

SceneSnapshot EpisodeRun::Snapshot(std::string_view stage) const {
  return {world_.PoseOfRobot(), world_.WorldFromDoorLinks(), world_.state().time_s, stage};
}

void EpisodeRun::Watch(std::string_view stage) {
  if (observer_ != nullptr && !diverged_) observer_->Watch(Snapshot(stage));
}

std::string EpisodeRun::Detail(Failure failure) const {
  std::string text = Format("grasp cost %.2f; ", plan_.cost);
  if (!touched_itself_.empty()) text += "robot touched itself at " + touched_itself_ + "; ";
  if (failure) return text + problem_;
  return text +
         Format("hinge %.1f deg after %d actions; ", world_.state().hinge_rad / kDegree, actions_) +
         touched_at_opening_ + Format("; grasp moved %.0f mm", 1000 * Slip());
}

Episode EpisodeRun::Finish(Failure failure) {
  if (diverged_) {
    failure = EpisodeOutcome::kDiverged;
    problem_ = Describe(*world_.fault());
  }
  episode_.outcome = failure.value_or(EpisodeOutcome::kOpened);
  episode_.detail = Detail(failure);
  episode_.simulated_s = world_.state().time_s;
  if (roles_.recorded == Stage::kGrasp) {
    for (Decision& decision : episode_.decisions)
      decision.score_rad = std::max(0.0, world_.state().hinge_rad);
  }
  episode_.state_sha256 = world_.StateHash();
  return std::move(episode_);
}

}  // namespace doorforge::internal
