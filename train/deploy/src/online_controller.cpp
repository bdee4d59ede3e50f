// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/online_controller.h"

#include <cmath>
#include <limits>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/deploy/depth_picture.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/rollout/gripper_clearance.h"
#include "doorforge/rollout/run_episode.h"

namespace doorforge {
namespace {

// What of a picture does not fit its camera or another picture is said of these inputs.
template <class Work>
auto NamingInputs(const std::string& inputs, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.code(), inputs + ": " + error.what());
  }
}

// Whatever a driver says of pixels that it could not measure.
DepthImage WithHoles(DepthImage depth) {
  for (float& metres : depth.depth_m)
    if (!(metres > 0)) metres = std::numeric_limits<float>::infinity();
  return depth;
}

void RequireColors(bool uses, bool lacks) {
  Require(!uses || !lacks, ErrorCode::kInvalidArgument,
          "the policy reads colours, and the depth picture has none; pass the colours that show "
          "pixel by pixel the same as --color, in a stream as \"color\"");
}

}  // namespace

void CheckOnlineControllerConfig(const OnlineControllerConfig& config) {
  Require(config.cloud.point_count == 4096, ErrorCode::kInvalidConfig,
          "cloud.point_count: policies read 4096 points");
  Require(config.hold.foreign_percentile >= 0 && config.hold.foreign_percentile <= 100,
          ErrorCode::kInvalidConfig,
          "hold.foreign_percentile (--foreign-limit): expected a number in [0, 100], or off");
  Require(
      std::isfinite(config.hold.least_gain_rad) && std::isfinite(config.hold.least_door_angle_rad),
      ErrorCode::kInvalidConfig,
      "hold.least_gain_rad and least_door_angle_rad (--least-gain): expected a number, or off");
}

OnlineController::OnlineController(const OnlineControllerSetup& setup)
    : setup_(setup), robot_(LoadRobot({}, setup.base)) {
  CheckOnlineControllerConfig(setup.config);
  belief_ = LoadDoorBelief(setup.opener, setup.config.policy);
  opener_ = LoadActor(setup.opener, Stage::kOpen);
  handler_ = LoadHandler(setup.handler);
  grasper_ = LoadGrasper(setup.grasper);
}

std::optional<Familiarity> OnlineController::LoadFamiliarity(const std::string& folder,
                                                             const PolicyRecord& record) {
  auto familiarity =
      ReadFamiliarity(folder, record.provenance.dataset_sha256, record.networks.family);
  if (!familiarity)
    notes_.push_back(folder +
                     " has no familiar.safetensors: how foreign a picture is to this policy cannot "
                     "be told; its training command, run again with --resume, adds it");
  return familiarity;
}

std::optional<OnlineController::Actor> OnlineController::LoadActor(const std::string& folder,
                                                                   Stage stage) {
  if (folder.empty()) return std::nullopt;
  PolicyRecord record = ReadPolicy(folder, NameOf(stage));
  auto familiarity = LoadFamiliarity(folder, record);
  const NetworkView view = record.networks.normalisation.view;
  GainCritic critic(record.networks);
  Actor actor{MakePolicy({std::move(record.networks), stage}, setup_.config.policy, belief_),
              record.weights_sha256, std::move(critic), std::move(familiarity)};
  actor.mirroring = dynamic_cast<MirroringPolicy*>(actor.policy.get());
  actor.policy->Reset();
  actor.remembers = view.remembered_finer > 0;
  actor.crop_radius_m = static_cast<double>(view.cloud_crop_radius_m);
  return actor;
}

std::optional<OnlineController::Actor> OnlineController::LoadHandler(const std::string& folder) {
  std::optional<Actor> actor = LoadActor(folder, Stage::kHandle);
  if (!actor) return actor;
  const auto classifier = ReadTurnedClassifier(
      folder, ReadPolicy(folder, NameOf(Stage::kHandle)).provenance.dataset_sha256);
  if (!classifier) return actor;
  auto turning = std::make_unique<TurningPolicy>(std::move(actor->policy), *classifier,
                                                 setup_.config.policy.switch_probability);
  actor->turning = turning.get();
  actor->policy = std::move(turning);
  return actor;
}

std::optional<OnlineController::Grasper> OnlineController::LoadGrasper(const std::string& folder) {
  if (folder.empty()) return std::nullopt;
  PolicyRecord record = ReadPolicy(folder, NameOf(Stage::kGrasp));
  auto familiarity = LoadFamiliarity(folder, record);
  return Grasper{MakeGraspPolicy(std::move(record.networks), setup_.config.grasp),
                 record.weights_sha256, std::move(familiarity)};
}

// What of the picture in seen_ a grasp is chosen from.
HandleObservation OnlineController::ViewForGrasp(const InputNames& names) const {
  const CloudConfig& cloud = setup_.config.cloud;
  if (!seen_.handle)
    return NamingInputs(names.depth + " and " + names.camera,
                        [&] { return ObserveClosedDoor(seen_.depth, setup_.camera, cloud); });
  const double yaw = setup_.config.door_yaw_rad;
  return NamingInputs(names.depth + ", " + names.handle + " and " + names.camera, [&] {
    return ObserveHandle(seen_.depth, *seen_.handle, setup_.camera,
                         -Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0), cloud);
  });
}

ActAnswer OnlineController::DecideGrasp(DepthImage depth, std::optional<PixelMask> handle,
                                        const InputNames& names) {
  if (!grasper_)
    throw Error(ErrorCode::kInvalidArgument,
                "a grasp is to be chosen, and --grasper, which chooses it, was not given");
  Require(handle.has_value() || FindsHandle(), ErrorCode::kInvalidArgument,
          "nobody says which points are the handle; pass --handle-mask, or a finder as --set "
          "grasp.finder=FOLDER");
  Require(!handle || !FindsHandle(), ErrorCode::kInvalidArgument,
          "the handle is told by --handle-mask and to be found by grasp.finder; leave one of them "
          "out");
  RequireColors(grasper_->policy->UsesColors(), depth.rgb.empty());
  seen_ = {WithHoles(std::move(depth)), std::move(handle)};
  HandleObservation seen = ViewForGrasp(names);
  KeepBefore(seen.view.visible);
  const GripperClearance clearance(robot_);
  seen.view.hand_from_tcp = robot_.hand_from_tcp();
  seen.view.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
    return clearance.Fits(seen.view.visible, contact_m, rotation);
  };
  const std::optional<GraspAction> choice = grasper_->policy->Choose(seen.view);
  Require(choice.has_value(), ErrorCode::kInvalidArgument,
          names.depth + ": no handle is found in it; look from nearer by, or pass --handle-mask");
  if (FindsHandle())
    seen.handle_count = static_cast<int>(choice->explanation->affordance_rad.size());
  return Answer(*choice, seen);
}

ActAnswer OnlineController::Decide(DepthImage depth, const RobotState& state,
                                   const InputNames& names) {
  seen_ = {WithHoles(std::move(depth)), {}};
  const Stage stage = StageOf(state, names.state);
  Actor& actor = ActorOf(stage);
  const RobotObservation seen = NamingInputs(names.depth + " and " + names.camera,
                                             [&] { return ObservationOf(actor, state); });
  return Answer(stage, actor, state, seen);
}

void OnlineController::Remember(const DepthImage& before, const InputNames& names) {
  KeepBefore(NamingInputs(names.depth + " and " + names.camera, [&] {
    return ObserveBefore(before, setup_.camera, setup_.config.cloud);
  }));
}

// The side of the hinge is told from as many points as it was learned from.
void OnlineController::KeepBefore(LabelledCloud before) {
  const Eigen::Vector3d start(static_cast<double>(before.xyz[0]),
                              static_cast<double>(before.xyz[1]),
                              static_cast<double>(before.xyz[2]));
  belief_->Begin(
      SampleCloud(before, start, {.point_count = setup_.config.cloud.point_count}).cloud);
  before_ = std::move(before);
}

RobotObservation OnlineController::ObservationOf(const Actor& actor,
                                                 const RobotState& state) const {
  const CloudConfig& cloud = setup_.config.cloud;
  RequireColors(actor.policy->UsesColors(), seen_.depth.rgb.empty());
  if (!actor.remembers) return ObserveDepth(seen_.depth, setup_.camera, state, cloud);
  if (!before_)
    throw Error(ErrorCode::kInvalidArgument,
                "the policy that turns the handle remembers what the camera saw before the robot "
                "came, and there is no such picture; pass it as --before, in a stream as "
                "\"before\"");
  Require(!actor.policy->UsesColors() || !before_->rgb.empty(), ErrorCode::kInvalidArgument,
          "the policy that turns the handle reads colours, and the picture from before the robot "
          "came has none; pass them as --before-color, in a stream as \"before_color\"");
  return ObserveDepth(seen_.depth, setup_.camera, state, {*before_, actor.crop_radius_m}, cloud);
}

std::optional<Foreignness> OnlineController::ForeignnessOf(
    const std::optional<Familiarity>& familiarity, const SightNumbers& numbers) const {
  if (!familiarity) return std::nullopt;
  const double distance = familiarity->DistanceOf(numbers);
  return Foreignness{distance, familiarity->PercentileOf(distance),
                     familiarity->DistanceAt(setup_.config.hold.foreign_percentile)};
}

ActAnswer OnlineController::Answer(const GraspAction& choice, const HandleObservation& seen) const {
  RigidTransform world_from_tcp = RigidTransform::Identity();
  world_from_tcp.linear() = choice.world_from_hand_rotation * robot_.hand_from_tcp().linear();
  world_from_tcp.translation() =
      choice.contact_m + kGraspInsertion * choice.world_from_hand_rotation.col(2);
  ActAnswer answer;
  answer.stage = Stage::kGrasp;
  answer.world_from_hand = world_from_tcp * robot_.hand_from_tcp().inverse();
  answer.contact_m = choice.contact_m;
  answer.expected_gain_rad = choice.explanation->expected_opening_rad;
  answer.foreign = ForeignnessOf(
      grasper_->familiarity,
      SightNumbersOf({choice.cloud.xyz, choice.cloud.label}, {}, NetworkFamily::kGrasp));
  answer.candidates = setup_.config.grasp.points * setup_.config.grasp.orientations;
  answer.visible_points = seen.visible_count;
  answer.median_depth_m = MedianDepth(seen_.depth);
  answer.handle_points = seen.handle_count;
  answer.weights_sha256 = grasper_->weights_sha256;
  Judge(setup_.config.hold, answer);
  return answer;
}

Stage OnlineController::StageOf(const RobotState& state, const std::string& name) {
  if (setup_.stage) return *setup_.stage;
  if (!state.unlocked && !unlocked_ && !Predicts())
    throw Error(ErrorCode::kInvalidConfig,
                name +
                    ": the key \"unlocked\" is missing, which says whether the handle has "
                    "been turned; pass --stage, or use --stream with a --handler that says it "
                    "itself (it has a turned.safetensors)");
  unlocked_ = unlocked_ || (state.unlocked ? *state.unlocked : handler_->turning->Turned());
  return unlocked_ ? Stage::kOpen : Stage::kHandle;
}

// Whether the handle policy can say when the handle is turned: it has seen the episode so far.
bool OnlineController::Predicts() const {
  return setup_.sees_every_decision && handler_ && handler_->turning != nullptr;
}

OnlineController::Actor& OnlineController::ActorOf(Stage stage) {
  std::optional<Actor>& actor = stage == Stage::kOpen ? opener_ : handler_;
  if (!actor)
    throw Error(ErrorCode::kInvalidArgument,
                stage == Stage::kOpen
                    ? "the door is to be opened, and --opener, which opens, was not given"
                    : "the handle is to be turned (unlocked: false), and --handler, which turns "
                      "it, was not given; pass it, or --stage open");
  return *actor;
}

ActAnswer OnlineController::Answer(Stage stage, Actor& actor, const RobotState& state,
                                   const RobotObservation& seen) {
  const Observation& observation = seen.observation;
  const Action action = actor.policy->Act(observation);
  ActAnswer answer;
  answer.stage = stage;
  answer.world_from_hand.linear() = action.world_from_hand_rotation;
  answer.world_from_hand.translation() =
      state.world_from_hand.translation() + action.position_delta_m;
  answer.world_from_hand_now = state.world_from_hand;
  const Observation shown = actor.mirroring->AsShown(observation);
  answer.expected_gain_rad = actor.critic.GainOf(shown, actor.mirroring->AsShown(action));
  answer.foreign = ForeignnessOf(
      actor.familiarity, SightNumbersOf({shown.cloud.xyz, shown.cloud.label}, shown.proprioception,
                                        NetworkFamily::kMotion));
  answer.candidates = setup_.config.policy.candidates;
  answer.visible_points = seen.visible_count;
  answer.median_depth_m = MedianDepth(seen_.depth);
  answer.weights_sha256 = actor.weights_sha256;
  Judge(setup_.config.hold, answer);
  // an action on a picture of something else must not end the stage, and whether the hand follows
  // only an unbroken sequence can tell
  const bool held = !answer.hold_reasons.empty();
  if (held || !setup_.sees_every_decision) actor.mirroring->TakeBack();
  if (stage == Stage::kHandle && Predicts()) {
    if (held) actor.turning->TakeBack();
    answer.turned = actor.turning->Turned();
  }
  return answer;
}

void RememberFromFile(OnlineController& controller, const DecisionFiles& files) {
  if (files.before.empty()) return;
  DepthImage before = ReadDepthPicture(files.before, controller.camera());
  AddColors(files.before_color, before);
  controller.Remember(before, {.depth = files.before, .camera = files.camera});
}

ActAnswer DecideFromFiles(OnlineController& controller, const DecisionFiles& files) {
  RememberFromFile(controller, files);
  InputNames names;
  names.depth = files.depth;
  names.camera = files.camera;
  DepthImage depth = ReadDepthPicture(files.depth, controller.camera());
  AddColors(files.color, depth);
  const bool told = !files.handle.empty();
  if (!told && !files.state.empty()) {
    names.state = files.state;
    return controller.Decide(std::move(depth), ReadRobotState(files.state, controller.robot()),
                             names);
  }
  names.handle = files.handle;
  return controller.DecideGrasp(
      std::move(depth), told ? std::optional(ReadMaskPicture(files.handle)) : std::nullopt, names);
}

}  // namespace doorforge
