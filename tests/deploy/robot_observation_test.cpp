// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/robot_observation.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/deploy/depth_picture.h"
#include "doorforge/deploy/record_sight.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/gain_critic.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/gripper_clearance.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/npy.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/ray_packet.h"
#include "doorforge/sensor/scene_geometry.h"

#include "../physics/primitive_door.h"
#include "../program_answer.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kActions = 5;
constexpr int kCandidates = 4;

// networks as they are before training, whose actions have the size of a trained policy's
StageNetworks UntrainedNetworks(NetworkFamily family = NetworkFamily::kMotion) {
  StageNormalisation normalisation;
  normalisation.cloud_centre_m = {0.16F, 0, 0.83F};
  normalisation.state.deviation.fill(0.3F);
  normalisation.action.deviation.fill(0.3F);
  for (std::size_t i = 0; i < 3; ++i) normalisation.action.deviation.at(i) = 0.02F;
  normalisation.action.mean = {0.02F, 0, 0, 0, 0, -1, 0, 1, 0};
  normalisation.hand_m.deviation.fill(0.2F);
  normalisation.base_m.deviation.fill(0.2F);
  normalisation.angle_gain_rad.deviation.fill(0.1F);
  return InitialNetworks(normalisation, false, 3, family);
}

void WriteUntrained(const fs::path& folder, const std::string& stage) {
  PolicyProvenance provenance;
  provenance.stage = stage;
  provenance.dataset_sha256 = std::string(64, 'a');
  provenance.config.family = FamilyOf(stage);
  WritePolicy(folder, UntrainedNetworks(FamilyOf(stage)), provenance);
}

// The camera of an episode, which keeps every picture that it made.
class Photographer : public Observer {
 public:
  Photographer(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
      : camera_(scene, door, robot) {}
  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    CameraFrame frame = camera_.Render(snapshot);
    pictures.push_back(std::move(frame.depth));
    hands.push_back(snapshot.robot.world_from_hand);
    links.push_back(LinkPosesOf(snapshot));
    return frame.sampled.cloud;
  }

  std::vector<DepthImage> pictures;
  std::vector<std::vector<RigidTransform>> links;
  std::vector<RigidTransform> hands;

 private:
  CameraObserver camera_;
};

ProgramAnswer RunAct(const std::string& arguments, const std::string& errors = "2>&1") {
  return AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-act act " + arguments + " " + errors);
}

Json CameraFile(const CameraModel& camera, double pixel_centre) {
  const Eigen::Matrix3d k = IntrinsicMatrix(camera);
  return {{"width", camera.width},
          {"height", camera.height},
          {"fx", k(0, 0)},
          {"fy", k(1, 1)},
          {"cx", k(0, 2) - 0.5 + pixel_centre},
          {"cy", k(1, 2) - 0.5 + pixel_centre},
          {"pixel_centre", pixel_centre},
          {"world_from_camera", TransformToJson(WorldFromCamera(camera))}};
}

Json StateFile(const Decision& decision, const Scene& scene) {
  Json state;
  for (std::size_t i = 0; i < 11; ++i) {
    state["joint_positions"].push_back(decision.state.at(i));
    state["joint_velocities"].push_back(decision.proprioception.at(11 + i));
  }
  state["world_from_base"] = TransformToJson(scene.world_from_robot_base);
  return state;
}

/// One simulated episode in which an untrained policy opens, and its files as a robot has them.
class RobotSightTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("robot_observation_test_" + std::to_string(::getpid()));
    WriteUntrained(folder_ / "opener", "open");
    WriteUntrained(folder_ / "handler", "handle");
    WriteUntrained(folder_ / "grasper", "grasp");
    const DoorAsset door = MakePrimitiveDoor({});
    SceneConfig config;
    config.physics.max_opening_actions = kActions;
    scene_ = SampleScene(door, 7, 0, config);
    Photographer photographer(scene_, door, robot_);
    PolicyOptions options;
    options.candidates = kCandidates;
    const auto policy = MakePolicy(UntrainedNetworks(), options);
    episode_ = RunEpisode(scene_, door, robot_, *policy, &photographer);
    pictures_ = std::move(photographer.pictures);
    hands_ = std::move(photographer.hands);
    links_ = std::move(photographer.links);
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      WriteDepthPng(Depth(i), pictures_[i]);
      WriteJsonFile(State(i), StateFile(episode_.decisions[i], scene_));
    }
    WriteJsonFile(folder_ / "camera.yaml", CameraFile(scene_.camera, 0));
    WriteJsonFile(folder_ / "camera_corner.yaml", CameraFile(scene_.camera, 0.5));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path Depth(std::size_t i) { return folder_ / ("d" + std::to_string(i) + ".png"); }
  static fs::path State(std::size_t i) { return folder_ / ("s" + std::to_string(i) + ".yaml"); }

  // the simulator's picture in whole millimetres, and what its camera makes of it
  static DepthImage Rounded(std::size_t i) {
    DepthImage rounded = pictures_[i];
    for (float& depth : rounded.depth_m)
      if (std::isfinite(depth)) depth = static_cast<float>(std::round(depth * 1000.0) * 0.001);
    return rounded;
  }
  static LabelledCloud Sampled(const DepthImage& depth, std::size_t i) {
    const RigidTransform tcp = hands_[i] * robot_.hand_from_tcp();
    return ObserveCloud(depth, scene_.camera, tcp.translation()).cloud;
  }

  // What a training on other episodes of the door would have written.
  static void WriteFamiliar(const fs::path& folder) {
    const DoorAsset door = MakePrimitiveDoor({});
    SceneConfig config;
    config.physics.max_opening_actions = kActions;
    const auto policy = MakePolicy(UntrainedNetworks());
    std::vector<Episode> episodes;
    std::vector<TrainingSample> samples;
    for (std::uint64_t e = 1; e <= 24; ++e) {
      const Scene scene = SampleScene(door, 7, e, config);
      Photographer photographer(scene, door, robot_);
      episodes.push_back(RunEpisode(scene, door, robot_, *policy, &photographer));
    }
    for (const Episode& episode : episodes) {
      for (const Decision& decision : episode.decisions) {
        TrainingSample& sample = samples.emplace_back();
        sample.cloud = decision.cloud.xyz;
        sample.proprioception = decision.proprioception;
      }
    }
    const std::span<const TrainingSample> all(samples);
    const std::size_t fitted = all.size() * 2 / 3;
    WriteFamiliarity(folder,
                     FitFamiliarity(all.first(fitted), all.subspan(fitted), NetworkFamily::kMotion),
                     std::string(64, 'a'));
  }

  // The first picture with other depths, as a file.
  template <class Depth>
  static fs::path WriteOther(const std::string& name, const Depth& depth_at) {
    DepthImage other = pictures_[0];
    for (std::size_t i = 0; i < other.depth_m.size(); ++i)
      other.depth_m[i] = static_cast<float>(depth_at(i));
    WriteDepthPng(folder_ / name, other);
    return folder_ / name;
  }

  static ProgramAnswer Open(const fs::path& policy, const fs::path& depth,
                            const std::string& more = "", const std::string& errors = "2>&1") {
    return RunAct("--camera " + (folder_ / "camera.yaml").string() + " --opener " +
                      policy.string() + " --stage open --depth " + depth.string() + " --state " +
                      State(0).string() + " " + more,
                  errors);
  }

  static std::string With(const std::string& camera, const std::string& more) {
    // what untrained networks expect is arbitrary
    return "--least-gain off --camera " + (folder_ / camera).string() + " --opener " +
           (folder_ / "opener").string() + " " + more;
  }

  static std::string Line(const fs::path& depth, const fs::path& state) {
    return Json{{"depth", depth.string()}, {"state", state.string()}}.dump() + "\n";
  }

  // one process, one answer a line
  static std::vector<Json> Stream(const std::string& arguments, const std::string& lines,
                                  int code = 0) {
    CommitFile(folder_ / "lines", lines);
    const ProgramAnswer answer =
        RunAct(arguments + " --stream < " + (folder_ / "lines").string(), "2>/dev/null");
    EXPECT_EQ(answer.code, code) << answer.text;
    std::istringstream rows(answer.text);
    std::vector<Json> answers;
    for (std::string row; std::getline(rows, row);) answers.push_back(Json::parse(row));
    return answers;
  }

  // The picture without its last column, which no camera of the same shape makes.
  static fs::path WriteCutPicture(const fs::path& path) {
    const DepthImage whole = DecodeDepthPng(ReadFile(path), 0.001, "whole");
    DepthImage cut = whole;
    cut.width -= 1;
    cut.depth_m.resize(static_cast<std::size_t>(cut.width) * static_cast<std::size_t>(cut.height));
    WriteDepthPng(folder_ / "cut.png", cut);
    return folder_ / "cut.png";
  }

  static fs::path WriteState(const std::string& name, const Json& change) {
    Json state = ReadJsonFile(State(0));
    for (const auto& [key, value] : change.items()) {
      if (value.is_null())
        state.erase(key);
      else
        state[key] = value;
    }
    WriteJsonFile(folder_ / name, state);
    return folder_ / name;
  }

  static fs::path folder_;
  static Scene scene_;
  static Episode episode_;
  static std::vector<DepthImage> pictures_;
  static std::vector<RigidTransform> hands_;
  static std::vector<std::vector<RigidTransform>> links_;
  static const RobotModel robot_;
};
fs::path RobotSightTest::folder_;
Scene RobotSightTest::scene_;
Episode RobotSightTest::episode_;
std::vector<DepthImage> RobotSightTest::pictures_;
std::vector<RigidTransform> RobotSightTest::hands_;
std::vector<std::vector<RigidTransform>> RobotSightTest::links_;
const RobotModel RobotSightTest::robot_ = LoadMobileFranka();

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

TEST_F(RobotSightTest, ThePictureOfAnAnswerIsNotReplacedUnasked) {
  const fs::path picture = folder_ / "answer.png";
  const std::string draw = "--least-gain off --picture " + picture.string();
  EXPECT_EQ(Open(folder_ / "opener", Depth(0), draw).code, 0);
  const std::string first = ReadFile(picture);
  EXPECT_EQ(first.substr(1, 3), "PNG");
  const ProgramAnswer again = Open(folder_ / "opener", Depth(1), draw);
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.text.find("--overwrite"), std::string::npos) << again.text;
  EXPECT_EQ(ReadFile(picture), first);
  EXPECT_EQ(Open(folder_ / "opener", Depth(1), draw + " --overwrite").code, 0);
  EXPECT_NE(ReadFile(picture), first);
}

TEST_F(RobotSightTest, ThePictureShowsWhereTheHandIsToGo) {
  const fs::path picture = folder_ / "drawn.png";
  const ProgramAnswer answer =
      Open(folder_ / "opener", Depth(0), "--least-gain off --picture " + picture.string(),
           "2>/dev/null");
  ASSERT_EQ(answer.code, 0);
  const RigidTransform hand =
      TransformFromJson(Json::parse(answer.text)["world_from_hand"], "hand");
  // the drawn hand reaches from the tool centre 12 cm back
  const Eigen::Vector3d middle = hand * robot_.hand_from_tcp() * Eigen::Vector3d(0, 0, -0.05);
  const Eigen::Vector3d pixel =
      IntrinsicMatrix(scene_.camera) * (WorldFromCamera(scene_.camera).inverse() * middle);
  // the left of two tiles of 640 pixels holds the whole picture, behind a margin of a few pixels
  const double scale = 640.0 / scene_.camera.width;
  const ProgramAnswer red =
      AnswerOf(PYTHON " " DOORFORGE_SOURCE_DIR "/tests/deploy/colored_pixels.py " +
               picture.string() + " 220 40 40 650");
  std::istringstream numbers(red.text);
  double count = 0;
  double x = 0;
  double y = 0;
  numbers >> count >> x >> y;
  EXPECT_GT(count, 30) << red.text;
  EXPECT_NEAR(x, scale * pixel.x() / pixel.z(), 20);
  EXPECT_NEAR(y, scale * pixel.y() / pixel.z(), 20);
}

// A lens as ROS's plumb_bob describes it, in the words of its makers, of a camera that stands where
// the episode's does.
struct DistortedCamera {
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 288;
  static constexpr double kFocal = 130;
  static constexpr double kCx = 161.2;  // of the first pixel's centre, 0
  static constexpr double kCy = 139.6;
  static constexpr double kK1 = -0.16;
  static constexpr double kK2 = 0.03;
  static constexpr double kP1 = 0.002;
  static constexpr double kP2 = -0.003;

  static Eigen::Vector2d Bent(const Eigen::Vector2d& p) {
    const double r2 = p.squaredNorm();
    return Eigen::Vector2d(2 * kP1 * p.x() * p.y() + kP2 * (r2 + 2 * p.x() * p.x()),
                           kP1 * (r2 + 2 * p.y() * p.y()) + 2 * kP2 * p.x() * p.y());
  }

  // OpenCV's way: again and again what the distortion at the last guess leaves over.
  static Eigen::Vector3d DirectionOf(int column, int row) {
    const Eigen::Vector2d seen((column - kCx) / kFocal, (row - kCy) / kFocal);
    Eigen::Vector2d ideal = seen;
    for (int i = 0; i < 2000; ++i) {
      const double r2 = ideal.squaredNorm();
      const Eigen::Vector2d next = (seen - Bent(ideal)) / (1 + kK1 * r2 + kK2 * r2 * r2);
      const bool is_done = (next - ideal).norm() < 1e-14;
      ideal = next;
      if (is_done) break;
    }
    return ideal.homogeneous();
  }

  static std::string Info(const CameraModel& camera) {
    return "image_width: 320\nimage_height: 288\ndistortion_model: plumb_bob\n"
           "camera_matrix: {rows: 3, cols: 3, data: [130, 0, 161.2, 0, 130, 139.6, 0, 0, 1]}\n"
           "distortion_coefficients: {rows: 1, cols: 5, data: [-0.16, 0.03, 0.002, -0.003, 0]}\n"
           "rectified: false\nworld_from_camera: " +
           JsonText(TransformToJson(WorldFromCamera(camera))) + "\n";
  }
};

/// What a real sensor would write, and where the points really are.
struct DistortedSight {
  std::vector<float> depth_m;
  LabelledCloud points;
};

DistortedSight LookThroughLens(const CameraModel& camera, const std::vector<RigidTransform>& links,
                               const CloudConfig& crop) {
  SceneGeometry scene(VisibleMeshesOf(MakePrimitiveDoor({}), LoadMobileFranka()));
  scene.MoveLinks(links);
  const RigidTransform pose = WorldFromCamera(camera);
  DistortedSight sight;
  for (int row = 0; row < DistortedCamera::kHeight; ++row) {
    for (int begin = 0; begin < DistortedCamera::kWidth; begin += 16) {
      RayPacket packet;
      for (int i = 0; i < 16; ++i)
        packet.Set(static_cast<std::size_t>(i), pose.translation().cast<float>(),
                   (pose.linear() * DistortedCamera::DirectionOf(begin + i, row)).cast<float>(),
                   100);
      const PacketHits hits = CastRays(scene, packet);
      for (std::size_t i = 0; i < 16; ++i) {
        const bool is_hit = (hits.hits >> i & 1U) != 0;
        sight.depth_m.push_back(is_hit ? hits.distance[i] : std::nanf(""));
        if (!is_hit || hits.distance[i] >= static_cast<float>(crop.max_depth_m)) continue;
        const Eigen::Vector3f at(packet.direction_x[i], packet.direction_y[i],
                                 packet.direction_z[i]);
        const Eigen::Vector3f point = pose.translation().cast<float>() + hits.distance[i] * at;
        if (point.z() <= static_cast<float>(crop.min_height_m)) continue;
        sight.points.xyz.insert(sight.points.xyz.end(), {point.x(), point.y(), point.z()});
      }
    }
  }
  return sight;
}

TEST_F(RobotSightTest, APictureThroughALensIsDecidedOnAsThePinholesIs) {
  CommitFile(folder_ / "lens.yaml", DistortedCamera::Info(scene_.camera));
  std::string pinhole = DistortedCamera::Info(scene_.camera);
  pinhole.replace(pinhole.find("-0.16, 0.03, 0.002, -0.003"), 26, "0, 0, 0, 0");
  CommitFile(folder_ / "no_lens.yaml", pinhole);
  const CloudConfig crop;
  const DistortedSight sight = LookThroughLens(scene_.camera, links_[0], crop);
  CommitFile(folder_ / "lens.npy",
             MakeNpy<float>(sight.depth_m, {DistortedCamera::kHeight, DistortedCamera::kWidth}));
  // the cloud is where the rays met the scene, and would not be without the lens
  const auto farthest = [&](const char* file) {
    const CalibratedCamera camera = ReadCalibratedCamera(folder_ / file);
    const LabelledCloud cloud =
        CropCloud(ReadDepthPicture(folder_ / "lens.npy", camera), camera, crop);
    double most = 0;
    for (std::size_t i = 0; i < std::min(cloud.xyz.size(), sight.points.xyz.size()); ++i)
      most = std::max<double>(most, std::fabs(cloud.xyz[i] - sight.points.xyz[i]));
    return std::pair(cloud.xyz.size() == sight.points.xyz.size(), most);
  };
  EXPECT_TRUE(farthest("lens.yaml").first);
  EXPECT_LT(farthest("lens.yaml").second, 5e-6);
  EXPECT_GT(farthest("no_lens.yaml").second, 0.05);
  // and the decision that of the pinhole's picture, but for which points are sampled
  const auto decide = [&](const std::string& camera, const fs::path& depth) {
    const ProgramAnswer answer = RunAct(
        With(camera, "--stage open --depth " + depth.string() + " --state " + State(0).string() +
                         " --picture " + (folder_ / "lens.png").string() + " --overwrite"),
        "2>/dev/null");
    EXPECT_EQ(answer.code, 0) << answer.text;
    return TransformFromJson(Json::parse(answer.text)["world_from_hand"], "hand");
  };
  const RigidTransform expected = decide("camera.yaml", Depth(0));
  const RigidTransform seen = decide("lens.yaml", folder_ / "lens.npy");
  EXPECT_LT((seen.translation() - expected.translation()).norm(), 0.003);
  EXPECT_LT(RotationVector(seen.linear().transpose() * expected.linear()).norm(),
            3 * 3.14159265 / 180);
  // the drawn hand is where the lens shows it
  const Eigen::Vector3d middle = seen * robot_.hand_from_tcp() * Eigen::Vector3d(0, 0, -0.05);
  const Eigen::Vector2d ideal = (WorldFromCamera(scene_.camera).inverse() * middle).hnormalized();
  const double r2 = ideal.squaredNorm();
  const Eigen::Vector2d pixel =
      DistortedCamera::kFocal *
          (ideal * (1 + DistortedCamera::kK1 * r2 + DistortedCamera::kK2 * r2 * r2) +
           DistortedCamera::Bent(ideal)) +
      Eigen::Vector2d(DistortedCamera::kCx + 0.5, DistortedCamera::kCy + 0.5);
  const ProgramAnswer red =
      AnswerOf(PYTHON " " DOORFORGE_SOURCE_DIR "/tests/deploy/colored_pixels.py " +
               (folder_ / "lens.png").string() + " 220 40 40 650");
  std::istringstream numbers(red.text);
  double count = 0;
  double x = 0;
  double y = 0;
  numbers >> count >> x >> y;
  EXPECT_GT(count, 30) << red.text;
  EXPECT_NEAR(x, 10 + 2 * pixel.x(), 20);
  EXPECT_NEAR(y, 10 + 32 + 2 * pixel.y(), 20);
}

TEST_F(RobotSightTest, TheAnswerIsDrawnIntoAPictureInColoursOfTheSameSize) {
  const fs::path picture = folder_ / "on_colours.png";
  WritePng(folder_ / "blue.png", {256, 256, [] {
                                    std::vector<std::uint8_t> blue;
                                    for (int i = 0; i < 256 * 256; ++i)
                                      blue.insert(blue.end(), {0, 0, 250});
                                    return blue;
                                  }()});
  const std::string draw = "--least-gain off --picture " + picture.string() + " --color ";
  EXPECT_EQ(Open(folder_ / "opener", Depth(0), draw + (folder_ / "blue.png").string()).code, 0);
  const ProgramAnswer blue =
      AnswerOf(PYTHON " " DOORFORGE_SOURCE_DIR "/tests/deploy/colored_pixels.py " +
               picture.string() + " 0 0 250 650");
  EXPECT_GT(std::stod(blue.text), 4 * 4096) << "what the policy is given";
  WritePng(folder_ / "small.png", {1, 1, {0, 0, 250}});
  const ProgramAnswer small =
      Open(folder_ / "opener", Depth(0), draw + (folder_ / "small.png").string() + " --overwrite");
  EXPECT_EQ(small.code, 2);
  EXPECT_NE(small.text.find("register"), std::string::npos) << small.text;
  EXPECT_EQ(Open(folder_ / "opener", Depth(0), "--color " + (folder_ / "blue.png").string()).code,
            2);
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
