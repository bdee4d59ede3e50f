// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/robot_observation.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/deploy/depth_picture.h"
#include "doorforge/deploy/record_sight.h"
#include "doorforge/policy/gain_critic.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/gripper_clearance.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/sensor/picture.h"

#include "robot_sight_fixture.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

TEST_F(RobotSightTest, APictureAndAStateGiveWhatThePolicySawInTheSimulator) {
  ASSERT_GE(pictures_.size(), 3U);
  for (const char* file : {"camera.yaml", "camera_corner.yaml"}) {
    const CalibratedCamera camera = ReadCalibratedCamera(folder_ / file);
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      const RobotState state = ReadRobotState(State(i), robot_);
      EXPECT_LT((state.world_from_hand.matrix() - hands_[i].matrix()).norm(), 1e-9);
      for (std::size_t k = 0; k < 32; ++k)
        EXPECT_NEAR(state.proprioception.at(k), episode_.decisions[i].proprioception.at(k), 1e-6);
      const DepthImage depth = DecodeDepthPng(ReadFile(Depth(i)), 0.001, "depth");
      const DepthImage rounded = Rounded(i);
      const std::vector<float> found = CropCloud(depth, camera.view).xyz;
      const std::vector<float> expected = CropCloud(rounded, scene_.camera).xyz;
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) ASSERT_NEAR(found[k], expected[k], 2e-6);
      // a pose in decimals is off by its last bit, which decides between points equally far
      const RobotObservation seen = ObserveDepth(depth, {ViewOf(scene_.camera)}, state);
      EXPECT_EQ(seen.observation.cloud.xyz, Sampled(rounded, i).xyz);
      EXPECT_EQ(static_cast<std::size_t>(seen.visible_count), expected.size() / 3);
    }
  }
}

// candidates are drawn decision by decision, so the whole episode is given to one process
TEST_F(RobotSightTest, TheProgramDecidesAsThePolicyDidInTheSimulator) {
  std::string lines;
  for (std::size_t i = 0; i < pictures_.size(); ++i) lines += Line(Depth(i), State(i));
  const std::vector<Json> decisions = Stream(
      With("camera.yaml", "--stage open --candidates " + std::to_string(kCandidates)), lines);
  ASSERT_EQ(decisions.size(), pictures_.size());
  PolicyOptions options;
  options.candidates = kCandidates;
  const auto policy = MakePolicy(UntrainedNetworks(), options);
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const Json& decision = decisions[i];
    const Eigen::Vector3d delta = Vector3FromJson(decision["position_delta_m"], "delta");
    const RigidTransform target = TransformFromJson(decision["world_from_hand"], "hand");
    // the same numbers where the simulator's picture is rounded to millimetres, too
    Observation rounded;
    rounded.cloud = Sampled(Rounded(i), i);
    rounded.proprioception = episode_.decisions[i].proprioception;
    const Action same = policy->Act(rounded);
    EXPECT_LT((delta - same.position_delta_m).norm(), 1e-5) << i;
    EXPECT_LT((target.linear() - same.world_from_hand_rotation).norm(), 1e-4) << i;
    EXPECT_LT((target.translation() - hands_[i].translation() - delta).norm(), 1e-6) << i;
    // and what the rounding is worth: 2 mm and 2 degrees, docs/act.md
    const Action simulated = FromVector(episode_.decisions[i].action);
    EXPECT_LT((delta - simulated.position_delta_m).norm(), 0.002) << i;
    EXPECT_LT(
        RotationVector(target.linear().transpose() * simulated.world_from_hand_rotation).norm(),
        2 * 3.14159265 / 180)
        << i;
  }
}

// The closed door before the robot is in view, as a grasper sees it.
class Onlooker : public SnapshotGraspPolicy {
 public:
  explicit Onlooker(CameraObserver& camera) : camera_(camera) {}
  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    depth = camera_.Render(snapshot).depth;
    approach = -snapshot.door[kHandleLink].linear().col(0);
    return std::nullopt;
  }

  DepthImage depth;
  Eigen::Vector3d approach = Eigen::Vector3d::Zero();

 private:
  CameraObserver& camera_;
};

TEST_F(RobotSightTest, TheProgramTakesHoldAsTheGrasperDoesInTheSimulator) {
  const DoorAsset door = MakePrimitiveDoor({});
  CameraObserver camera(scene_, door, robot_, {}, /*sees_robot=*/false);
  Onlooker onlooker(camera);
  const auto opener = MakePolicy(UntrainedNetworks());
  RunStages(scene_, door, robot_, {.grasp = &onlooker, .open = opener.get()}, nullptr);

  DepthImage& depth = onlooker.depth;
  PixelMask handle{depth.width, depth.height, {}};
  for (const std::uint8_t label : depth.label)
    handle.set.push_back(label == static_cast<std::uint8_t>(PointLabel::kHandle) ? 1 : 0);
  WriteDepthPng(folder_ / "closed.png", depth);
  CommitFile(folder_ / "mask.png", EncodeMaskPng(handle));
  for (float& metres : depth.depth_m)
    if (std::isfinite(metres)) metres = static_cast<float>(std::round(metres * 1000.0) * 0.001);

  GraspOptions options;
  options.orientations = 5;
  HandleObservation seen = ObserveHandle(depth, handle, {ViewOf(scene_.camera)}, onlooker.approach);
  const GripperClearance clearance(robot_);
  seen.view.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
    return clearance.Fits(seen.view.visible, contact_m, rotation);
  };
  const auto expected =
      MakeGraspPolicy(UntrainedNetworks(NetworkFamily::kGrasp), options)->Choose(seen.view);
  ASSERT_TRUE(expected);
  const double yaw = std::atan2(-onlooker.approach.y(), -onlooker.approach.x());
  const std::string common =
      "--least-gain off --camera " + (folder_ / "camera.yaml").string() +
      " --set grasp.orientations=5 --set door_yaw_rad=" + std::to_string(yaw);
  const std::string grasper = " --grasper " + (folder_ / "grasper").string();
  const std::string look = " --depth " + (folder_ / "closed.png").string() + " --handle-mask " +
                           (folder_ / "mask.png").string();
  const ProgramAnswer answer = RunAct(common + grasper + look, "2>/dev/null");
  ASSERT_EQ(answer.code, 0);
  const Json decision = Json::parse(answer.text);
  EXPECT_EQ(decision["stage"], "grasp");
  EXPECT_EQ(decision["handle_points"], seen.handle_count);
  EXPECT_LT((Vector3FromJson(decision["contact_m"], "contact") - expected->contact_m).norm(), 1e-5);
  const RigidTransform hand = TransformFromJson(decision["world_from_hand"], "hand");
  EXPECT_LT((hand.linear() - expected->world_from_hand_rotation).norm(), 1e-4);
  const Eigen::Vector3d tcp = (hand * robot_.hand_from_tcp()).translation();
  EXPECT_NEAR((tcp - expected->contact_m).dot(hand.linear().col(2)), kGraspInsertion, 1e-5);
  EXPECT_NEAR(decision["expected_door_angle_rad"].get<double>(),
              expected->explanation->expected_opening_rad, 1e-4);
  EXPECT_EQ(decision["expected_gain_rad"], decision["expected_door_angle_rad"]);
  EXPECT_TRUE(decision["foreign"].is_null());
  EXPECT_EQ(
      RunAct(common.substr(sizeof "--least-gain off") + " --least-gain 3.1" + grasper + look).code,
      1);

  const auto refused = [&](const std::string& arguments, int code, const std::string& reason) {
    const ProgramAnswer refusal = RunAct(common + arguments);
    EXPECT_EQ(refusal.code, code) << refusal.text;
    EXPECT_NE(refusal.text.find(reason), std::string::npos) << refusal.text;
  };
  refused(" --opener " + (folder_ / "opener").string() + look, 2, "--grasper");
  refused(" --grasper " + (folder_ / "opener").string() + look, 3, "stage \"open\"");
  refused(grasper + look + " --state " + State(0).string(), 2, "either --state or --handle");
  CommitFile(folder_ / "mask.png",
             EncodeMaskPng(
                 {handle.width, handle.height, std::vector<std::uint8_t>(handle.set.size(), 0)}));
  refused(grasper + look, 2, "mask is empty");
  CommitFile(folder_ / "mask.png", EncodeMaskPng({2, 1, {1, 0}}));
  refused(grasper + look, 2, "2 x 1 pixels");
  WritePng(folder_ / "mask.png", DepthPreview(depth));
  refused(grasper + look, 3, "8 or 16-bit grey");
}

TEST_F(RobotSightTest, AHandlerThatRemembersIsGivenThePictureFromBeforeAndAsksForIt) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene finer = scene_;
  finer.camera.width *= 2;
  finer.camera.height *= 2;
  CameraObserver camera(finer, door, robot_, {}, /*sees_robot=*/false);
  Onlooker onlooker(camera);
  const auto opener = MakePolicy(UntrainedNetworks());
  RunStages(scene_, door, robot_, {.grasp = &onlooker, .open = opener.get()}, nullptr);
  const fs::path before = folder_ / "before.png";
  WriteDepthPng(before, onlooker.depth);

  // the picture is the simulator's in whole millimetres
  const auto handler = folder_ / "remembers";
  StageNetworks networks = UntrainedNetworks();
  networks.normalisation.view.remembered_finer = 2;
  networks.normalisation.view.cloud_crop_radius_m = 0.25F;
  PolicyProvenance provenance;
  provenance.stage = "handle";
  provenance.dataset_sha256 = std::string(64, 'a');
  WritePolicy(handler, networks, provenance);
  const std::string inputs = "--stage handle --handler " + handler.string() + " --depth " +
                             Depth(0).string() + " --state " + State(0).string();
  const ProgramAnswer answer =
      RunAct(With("camera.yaml", inputs + " --before " + before.string()), "2>/dev/null");
  ASSERT_EQ(answer.code, 0) << answer.text;
  RememberedView simulated(scene_, door, robot_, {},
                           {.resolution_scale = 2, .crop_radius_m = 0.25});
  Observation observation;
  observation.cloud = simulated.With(CropCloud(pictures_[0], scene_.camera),
                                     (hands_[0] * robot_.hand_from_tcp()).translation());
  observation.proprioception = episode_.decisions[0].proprioception;
  const auto policy = MakePolicy(networks);
  const Eigen::Vector3d moves =
      Vector3FromJson(Json::parse(answer.text)["position_delta_m"], "delta");
  EXPECT_LT((moves - policy->Act(observation).position_delta_m).norm(), 0.002);
  observation.cloud = ObserveCloud(pictures_[0], scene_.camera, hands_[0].translation()).cloud;
  EXPECT_GT((moves - policy->Act(observation).position_delta_m).norm(), 1e-4)
      << "these weights do not care what is remembered, so the test shows nothing";

  const ProgramAnswer refused = RunAct(With("camera.yaml", inputs));
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("--before"), std::string::npos) << refused.text;
  const ProgramAnswer other =
      RunAct(With("camera.yaml", inputs + " --before " + WriteCutPicture(before).string()));
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.text.find("pixels"), std::string::npos) << other.text;
  const std::string line =
      Json{{"before", before.string()}, {"depth", Depth(0).string()}, {"state", State(0).string()}}
          .dump();
  const auto streamed =
      Stream(With("camera.yaml", "--stage handle --handler " + handler.string()), line + "\n");
  EXPECT_EQ(streamed.at(0)["position_delta_m"], Json::parse(answer.text)["position_delta_m"]);
}

TEST_F(RobotSightTest, TheStateSaysWhoActsAndWhatIsUnlockedStaysSo) {
  const fs::path locked = WriteState("locked.yaml", {{"unlocked", false}});
  const fs::path unlocked = WriteState("unlocked.yaml", {{"unlocked", true}});
  const std::vector<Json> answers =
      Stream(With("camera_corner.yaml", "--handler " + (folder_ / "handler").string()),
             Line(Depth(0), State(0)) + Line(Depth(0), locked) + Line(Depth(0), unlocked) +
                 Line(Depth(0), locked) + "not json\n",
             1);
  std::vector<std::string> stages;
  for (const Json& answer : answers) stages.push_back(answer.value("stage", "error"));
  EXPECT_EQ(stages, (std::vector<std::string>{"error", "handle", "open", "open", "error"}));
  EXPECT_NE(answers.at(0)["error"].get<std::string>().find("unlocked"), std::string::npos);
}

TEST_F(RobotSightTest, InALoopTheHandlePolicySaysItselfWhenOpeningBegins) {
  TurnedClassifier always;
  always.deviation.fill(1);
  always.bias = 10;
  WriteUntrained(folder_ / "says_when", "handle");
  WriteTurnedClassifier(folder_ / "says_when", always, std::string(64, 'a'));
  const std::string handler = "--handler " + (folder_ / "says_when").string();
  const std::vector<Json> answers = Stream(With("camera_corner.yaml", handler),
                                           Line(Depth(0), State(0)) + Line(Depth(1), State(1)));
  EXPECT_EQ(answers.at(0)["stage"], "handle");
  EXPECT_EQ(answers.at(0)["turned"], true);
  EXPECT_EQ(answers.at(1)["stage"], "open");
  // what is not to be carried out does not turn the handle
  std::string held = With("camera_corner.yaml", handler);
  held.replace(held.find("--least-gain off"), 16, "--least-gain 3.1");
  for (const Json& answer : Stream(held, Line(Depth(0), State(0)) + Line(Depth(1), State(1)), 1)) {
    EXPECT_EQ(answer["stage"], "handle");
    EXPECT_EQ(answer["turned"], false);
  }
  const ProgramAnswer alone = RunAct(With("camera_corner.yaml", handler) + " --depth " +
                                     Depth(0).string() + " --state " + State(0).string());
  EXPECT_EQ(alone.code, 2) << "one picture does not say how far the hand has turned";
  EXPECT_NE(alone.text.find("unlocked"), std::string::npos) << alone.text;
}

TEST_F(RobotSightTest, APictureOrAStateThatCannotBeUsedIsNamedAndTheLoopGoesOn) {
  std::vector<std::string> words;
  std::string lines;
  const auto add = [&](const fs::path& depth, const fs::path& state, const std::string& word) {
    lines += Line(depth, state);
    words.push_back(word);
  };
  const auto add_state = [&](const Json& change, const std::string& word) {
    add(Depth(0), WriteState("state" + std::to_string(words.size()) + ".yaml", change), word);
  };
  add_state({{"joint_positions", nullptr}}, "joint_positions");
  add_state({{"joint_position", 1}}, "did you mean");
  add_state({{"joint_velocities", Json::array({1, 2})}}, "expected 11 numbers");
  Json degrees = ReadJsonFile(State(0))["joint_positions"];
  for (Json& angle : degrees) angle = angle.get<double>() * 57.3;
  add_state({{"joint_positions", degrees}}, "radians");
  add_state({{"world_from_base", {{"position_m", {0, 0, 0}}}}}, "quaternion_xyzw");
  add_state({{"world_from_hand", TransformToJson(RigidTransform::Identity())}}, "panda_hand");
  add_state({{"unlocked", "yes"}}, "true or false");
  add_state({{"unlocked", false}}, "--handler");
  CommitFile(folder_ / "nan.yaml", "joint_positions: [.nan, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n");
  add(Depth(0), folder_ / "nan.yaml", "nan");
  DepthImage empty = pictures_[0];
  empty.depth_m.assign(empty.depth_m.size(), std::numeric_limits<float>::infinity());
  WriteDepthPng(folder_ / "empty.png", empty);
  const fs::path good = WriteState("good.yaml", {{"unlocked", true}});
  add(folder_ / "empty.png", good, "gives 0 points");
  for (std::size_t i = 0; i < 4095; ++i) empty.depth_m[i] = 1;
  WriteDepthPng(folder_ / "few.png", empty);
  add(folder_ / "few.png", good, "4095 of 65536 pixels");
  WritePng(folder_ / "colour.png", DepthPreview(pictures_[0]));
  add(folder_ / "colour.png", good, "16-bit grey");
  CommitFile(folder_ / "cut.png", ReadFile(Depth(0)).substr(0, 2000));
  add(folder_ / "cut.png", good, "damaged");
  CommitFile(folder_ / "text.png", "a picture");
  add(folder_ / "text.png", good, "no PNG");
  add(folder_ / "missing.png", good, "missing.png");
  const std::vector<Json> answers =
      Stream(With("camera.yaml", ""), lines + Line(Depth(0), good), 1);
  ASSERT_EQ(answers.size(), words.size() + 1);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string error = answers[i].value("error", "none");
    EXPECT_NE(error.find(words[i]), std::string::npos) << words[i] << " not in: " << error;
  }
  EXPECT_EQ(answers.back().value("stage", ""), "open");
}

TEST_F(RobotSightTest, ACameraFileWithAMissingKeyAndAPolicyOfAnotherStageAreRefused) {
  Json camera = CameraFile(scene_.camera, 0);
  camera["width"] = 128;
  WriteJsonFile(folder_ / "narrow.yaml", camera);
  camera.erase("fx");
  WriteJsonFile(folder_ / "no_fx.yaml", camera);
  const auto refusal = [&](const std::string& file) -> std::string {
    try {
      ObserveDepth(pictures_[0], ReadCalibratedCamera(folder_ / file),
                   ReadRobotState(State(0), robot_));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("narrow.yaml").find("256 x 256"), std::string::npos);
  EXPECT_NE(refusal("no_fx.yaml").find("\"fx\" is missing"), std::string::npos);
  const ProgramAnswer answer = RunAct("--camera " + (folder_ / "camera.yaml").string() +
                                      " --opener " + (folder_ / "handler").string() + " --depth " +
                                      Depth(0).string() + " --state " + State(0).string());
  EXPECT_EQ(answer.code, 3) << answer.text;
  EXPECT_NE(answer.text.find("handle"), std::string::npos) << answer.text;
}

TEST_F(RobotSightTest, AnAnswerSaysWhatTheCriticExpectsOfItsAction) {
  const ProgramAnswer answer =
      Open(folder_ / "opener", Depth(1), "--least-gain off", "2>/dev/null");
  ASSERT_EQ(answer.code, 0);
  const Json decision = Json::parse(answer.text);
  Observation rounded;
  rounded.cloud = Sampled(Rounded(1), 0);
  rounded.proprioception = episode_.decisions[0].proprioception;
  const Action action = MakePolicy(UntrainedNetworks())->Act(rounded);
  const double gain = GainCritic(UntrainedNetworks()).GainOf(rounded, action);
  EXPECT_NEAR(decision["expected_gain_rad"].get<double>(), gain, 1e-4);
  const ProgramAnswer text = Open(folder_ / "opener", Depth(1), "--least-gain off --text");
  char expected[40];
  std::snprintf(expected, sizeof expected, "turns %.4f rad", gain);
  EXPECT_NE(text.text.find(expected), std::string::npos) << text.text;
  EXPECT_NE(text.text.find("hold:     no"), std::string::npos) << text.text;
}

TEST_F(RobotSightTest, WhereLessIsExpectedThanAskedForItSaysHold) {
  const fs::path opener = folder_ / "opener";
  const ProgramAnswer held = Open(opener, Depth(0), "--least-gain 3", "2>/dev/null");
  EXPECT_EQ(held.code, 1);
  const Json decision = Json::parse(held.text);
  EXPECT_EQ(decision["hold"], true);
  EXPECT_NE(decision["hold_reasons"][0].get<std::string>().find("least is 3"), std::string::npos);
  EXPECT_TRUE(decision.contains("world_from_hand"));
  EXPECT_EQ(Open(opener, Depth(0), "--least-gain -3").code, 0);
  EXPECT_EQ(Open(opener, Depth(0), "--set hold.gain=false").code, 0);
  const ProgramAnswer wrong = Open(opener, Depth(0), "--least-gain much");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.text.find("a number or off"), std::string::npos) << wrong.text;
  EXPECT_EQ(Open(opener, Depth(0), "--foreign-limit 101").code, 2);
  const std::vector<Json> answers =
      Stream("--camera " + (folder_ / "camera.yaml").string() + " --opener " + opener.string() +
                 " --stage open --least-gain 3",
             Line(Depth(0), State(0)) + "{}\n", 1);
  EXPECT_EQ(answers.at(0)["hold"], true);
  EXPECT_EQ(answers.at(1)["hold"], true) << "what was refused must not be waited for";
}

TEST_F(RobotSightTest, AWallARoomAndAPictureUpsideDownAreForeignAndHeld) {
  WriteUntrained(folder_ / "familiar", "open");
  WriteFamiliar(folder_ / "familiar");
  const auto look = [&](const fs::path& depth, const std::string& more, int code) {
    const ProgramAnswer answer =
        Open(folder_ / "familiar", depth, "--least-gain off " + more, "2>/dev/null");
    EXPECT_EQ(answer.code, code) << depth << answer.text;
    return Json::parse(answer.text);
  };
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const ProgramAnswer answer =
        RunAct("--camera " + (folder_ / "camera.yaml").string() + " --opener " +
                   (folder_ / "familiar").string() + " --stage open --least-gain off --depth " +
                   Depth(i).string() + " --state " + State(i).string(),
               "2>/dev/null");
    EXPECT_EQ(answer.code, 0) << answer.text;
    EXPECT_EQ(Json::parse(answer.text)["hold"], false);
  }
  // a camera 1.8 m above the floor that looks slightly down: a floor below, a wall above
  const auto width = static_cast<std::size_t>(pictures_[0].width);
  const double focal = IntrinsicMatrix(scene_.camera)(0, 0);
  const auto room = [&](std::size_t i) {
    const double down = (static_cast<double>(i / width) - 0.5 * static_cast<double>(width)) / focal;
    return std::min(2.2, down > 0 ? 1.6 / (down + 0.17) : 2.2);
  };
  const std::vector<fs::path> foreign = {
      WriteOther("wall.png", [](std::size_t) { return 1.4; }),
      WriteOther("far_wall.png", [](std::size_t) { return 2.3; }), WriteOther("room.png", room),
      WriteOther("upside_down.png", [&](std::size_t i) {
        return pictures_[0].depth_m[pictures_[0].depth_m.size() - 1 - i];
      })};
  for (const fs::path& depth : foreign) {
    const Json decision = look(depth, "", 1);
    EXPECT_EQ(decision["hold"], true) << depth;
    EXPECT_NE(decision["hold_reasons"][0].get<std::string>().find("foreign"), std::string::npos);
    EXPECT_EQ(decision["foreign"]["percentile"], 100);
    EXPECT_GT(decision["foreign"]["distance"], decision["foreign"]["limit"]);
    EXPECT_EQ(look(depth, "--foreign-limit off", 0)["hold"], false);
  }
}

TEST_F(RobotSightTest, APolicyThatCannotTellHowForeignAPictureIsSaysSoAndGoesOn) {
  const ProgramAnswer answer = Open(folder_ / "opener", Depth(0), "--least-gain off");
  EXPECT_EQ(answer.code, 0);
  EXPECT_NE(answer.text.find("no familiar.safetensors"), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("--resume"), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("\"foreign\": null"), std::string::npos) << answer.text;
}

TEST_F(RobotSightTest, PicturesWithoutUseAreRefusedWithTheirNumbers) {
  const auto refused = [&](const fs::path& depth, const std::string& reason) {
    const ProgramAnswer answer = Open(folder_ / "opener", depth);
    EXPECT_EQ(answer.code, 2) << answer.text;
    EXPECT_NE(answer.text.find(reason), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find(depth.string()), std::string::npos) << answer.text;
  };
  refused(WriteOther("zeros.png", [](std::size_t) { return HUGE_VAL; }),
          "each of its 65536 pixels is 0");
  refused(WriteOther("far.png", [](std::size_t) { return 9; }),
          "0 of them are nearer than 2.50 m (the nearest is at 9.00 m)");
  DepthImage small = pictures_[0];
  small.width = 128;
  small.height = 512;
  WriteDepthPng(folder_ / "small.png", small);
  refused(folder_ / "small.png", "128 x 512 pixels, the camera file says 256 x 256");
}

TEST_F(RobotSightTest, AQuaternionOfFourDecimalsIsTakenAndOneFartherFromUnitIsNot) {
  const auto with = [&](double factor) {
    Json camera = CameraFile(scene_.camera, 0);
    for (Json& q : camera["world_from_camera"]["quaternion_xyzw"]) q = q.get<double>() * factor;
    WriteJsonFile(folder_ / "scaled.yaml", camera);
    return ReadCalibratedCamera(folder_ / "scaled.yaml");
  };
  const RigidTransform expected = WorldFromCamera(scene_.camera);
  for (const double factor : {0.9991, 1.0009})
    EXPECT_LT((with(factor).view.world_from_camera.matrix() - expected.matrix()).norm(), 1e-9);
  for (const double factor : {0.9985, 1.0015}) {
    try {
      with(factor);
      ADD_FAILURE() << factor;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      EXPECT_NE(std::string(error.what()).find("within 0.001"), std::string::npos) << error.what();
    }
  }
}

// What is recorded for a user is what the policies are given in the simulator.
TEST_F(RobotSightTest, ARecordedEpisodeIsReadByTheProgram) {
  const auto made = std::make_shared<const DoorAsset>(MakePrimitiveDoor({}));
  const IdentifiedDoor door{made, ContentHash(*made)};
  SightRequest request;
  request.seed = 7;
  request.all_decisions = true;
  const fs::path out = folder_ / "recorded";
  const RecordedSight recorded = RecordSight(door, request, out);
  EXPECT_GE(recorded.open_decisions, 3);
  const std::string lines = ReadFile(out / "lines");
  const std::vector<Json> answers =
      Stream(With("recorded/open/camera.yaml", "--handler " + (folder_ / "handler").string()),
             lines.substr(lines.find('\n') + 1));  // behind the grasp's
  ASSERT_EQ(static_cast<int>(answers.size()), recorded.handle_decisions + recorded.open_decisions);
  for (int i = 0; i < static_cast<int>(answers.size()); ++i) {
    const Json& answer = answers[static_cast<std::size_t>(i)];
    EXPECT_EQ(answer.value("stage", answer.dump()),
              i < recorded.handle_decisions ? "handle" : "open");
  }
  const ProgramAnswer grasp =
      RunAct("--least-gain off --camera " + (out / "grasp/camera.yaml").string() + " --depth " +
             (out / "grasp/depth.png").string() + " --handle-mask " +
             (out / "grasp/mask.png").string() + " --grasper " + (folder_ / "grasper").string());
  EXPECT_EQ(grasp.code, 0) << grasp.text;
}

// From the folder of the sources, as the help has them.
TEST(ActHelp, TheExamplesWithSampleInputsWorkAsTyped) {
  std::string help = AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge act --help").text;
  for (std::size_t at; (at = help.find("\\\n")) != std::string::npos;) help.erase(at, 2);
  std::istringstream lines(help);
  int tried = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find("doorforge act --depth data/sight");
    if (begin == std::string::npos) continue;
    const ProgramAnswer answer =
        AnswerOf("cd " DOORFORGE_SOURCE_DIR " && PATH=" DOORFORGE_BINARY_DIR "/bin:$PATH " +
                 line.substr(begin) + " 2>&1");
    EXPECT_EQ(answer.code, 0) << line << answer.text;
    ++tried;
  }
  EXPECT_EQ(tried, 2);
}

}  // namespace
}  // namespace doorforge
