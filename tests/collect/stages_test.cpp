// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The stages on doors of boxes.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/collect/collect_stage.h"
#include "doorforge/collect/reobserve.h"
#include "doorforge/collect/stage_run.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/dataset/verify_dataset.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode_arrays.h"
#include "doorforge/schemas/npy.h"

#include "../physics/primitive_door.h"
#include "recorded_robot.h"
#include "recording_camera.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class StagesTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("doorforge_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    AddDoor("lever", {});
    AddDoor("bar", {.mechanism = Mechanism::kNone});
  }
  void TearDown() override { fs::remove_all(folder_); }

  void AddDoor(const std::string& id, const PrimitiveDoor& shape) const {
    DoorAsset door = MakePrimitiveDoor(shape);
    door.id = id;
    door.body.id = "body_" + id;
    door.handle.id = "handle_" + id;
    door.body.sha256 = "body of " + id;
    door.handle.sha256 = "handle of " + id;
    fs::create_directories(folder_ / "doors" / id);
    WriteDoor(door, folder_ / "doors" / id);
  }

  StageRequest RequestFor(Stage stage, std::uint64_t episodes) const {
    StageRequest request;
    request.config = DefaultsOf(stage);
    request.config.episodes = episodes;
    request.config.seed = 4;
    request.config.cloud.point_count = 512;
    request.config.collection.val_fraction = 0;
    request.doors = {(folder_ / "doors").string()};
    request.threads = 2;
    return request;
  }

  fs::path Collected(Stage stage, std::uint64_t episodes, double noise_m = 0,
                     double sampled_grasps = 0) const {
    StageRequest stage_request = RequestFor(stage, episodes);
    if (noise_m > 0) stage_request.config.cloud.noise.sensor = DepthSensor::kStructuredLight;
    stage_request.config.sampled_grasps = sampled_grasps;
    StageRun run(stage_request);
    CollectRequest request = run.Request();
    request.folder = folder_ / std::string(NameOf(stage));
    request.threads = 2;
    Collect(
        run.plan(), [&](const PlannedEpisode& planned) { return run.Run(planned); }, request);
    return request.folder;
  }

  ReobserveRequest Again(const fs::path& data) const {
    ReobserveRequest request;
    request.folder = data;
    request.out = data.string() + "_again";
    request.doors = {(folder_ / "doors").string()};
    request.threads = 2;
    return request;
  }

  static void ExpectSound(const fs::path& data) {
    for (const DatasetFinding& finding : VerifyDataset({data, 2, {}}))
      ADD_FAILURE() << finding.code << " " << finding.where << ": " << finding.measured;
  }

  static std::string TarHash(const fs::path& data, Stage stage) {
    return Sha256OfFile(data / NameOf(stage) / "train" / "shard-000000.tar");
  }

  // Code and message of what making the run throws.
  static std::string Refusal(const StageRequest& request) {
    try {
      const StageRun run(request);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(StagesTest, HandleRecordsTurnsAndLeavesDoorsWithoutALatchOut) {
  const fs::path data = Collected(Stage::kHandle, 4);
  ExpectSound(data);
  const DatasetReader reader(data, "handle", "train");
  ASSERT_GE(reader.size(), 3U);
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    const auto meta = reader.Meta(i);
    EXPECT_EQ(meta.at("scene").at("door_id"), "lever");
    EXPECT_EQ(meta.at("stage"), "handle");
    EXPECT_EQ(meta.at("policies").at("open"), "expert");
    for (std::size_t t = 0; t + 1 < arrays.decisions; ++t)
      EXPECT_NEAR(arrays.joints[2 * t + 1] + arrays.score[t], arrays.joints[2 * t + 3], 1e-6);
  }
}

TEST_F(StagesTest, AShareOfTheHandsTakesHoldAtASampledGrasp) {
  StageRequest request = RequestFor(Stage::kOpen, 40);
  request.config.sampled_grasps = 0.5;
  StageRun run(request);
  int sampled = 0;
  for (std::uint64_t number = 0; number < 40; ++number) {
    PlannedEpisode planned = run.plan().shards.at(0).episodes.at(number);
    const auto policies = run.Run(planned).meta.at("policies");
    EXPECT_FALSE(policies.contains("learner"));
    sampled += policies.at("grasp") == "sampled" ? 1 : 0;
  }
  EXPECT_GE(sampled, 11);  // 20 +- 3.2
  EXPECT_LE(sampled, 29);

  request.config.sampled_grasps = 1.5;
  EXPECT_NE(Refusal(request).find("sampled_grasps"), std::string::npos);
}

TEST_F(StagesTest, GraspsGoodAndBadAreWrittenWithTheFinalAngle) {
  const fs::path data = Collected(Stage::kGrasp, 16);
  ExpectSound(data);
  const DatasetReader reader(data, "grasp", "train");
  ASSERT_GE(reader.size(), 10U);
  int good = 0;
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    ASSERT_EQ(arrays.decisions, 1U);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(arrays.cloud[k], arrays.action[k]);
    EXPECT_GE(arrays.score[0], 0);
    const bool opened = reader.Meta(i).at("outcome") == "opened";
    // not the other way round: a door may swing on after the hand has lost it
    if (opened) {
      EXPECT_GT(arrays.score[0], 0.78F);
    }
    good += arrays.score[0] > 0.1F ? 1 : 0;
  }
  EXPECT_GT(good, 0);
  EXPECT_LT(good, static_cast<int>(reader.size()));
}

TEST_F(StagesTest, LookedAtAgainAsItWasADatasetHasTheSameShards) {
  for (const Stage stage : {Stage::kOpen, Stage::kHandle, Stage::kGrasp}) {
    const fs::path data = Collected(stage, 3, 0.01, /*sampled_grasps=*/0.5);
    const ReobserveRequest request = Again(data);
    ReobserveDataset(request);
    ExpectSound(request.out);
    EXPECT_GT(DatasetReader(data, NameOf(stage), "train").size(), 0U) << NameOf(stage);
    EXPECT_EQ(TarHash(request.out, stage), TarHash(data, stage)) << NameOf(stage);
  }
}

PictureCamera PictureCameraAt(const std::string& name, CameraPlace at) {
  PictureCamera camera;
  camera.name = name;
  camera.at = at;
  if (at != CameraPlace::kScene) camera.width = camera.height = 48;
  return camera;
}

std::map<std::string, std::string> MembersIn(const ShardReader& reader, std::size_t episode) {
  std::map<std::string, std::string> members;
  for (const ShardMember& member : reader.index().episodes[episode].members) {
    const auto bytes = reader.Read(episode, member.name);
    members[member.name] = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  return members;
}

// Everything of `without` is in `with`, byte by byte, but for what meta.json says of pictures.
void ExpectSameBesidePictures(const fs::path& without, const fs::path& with, Stage stage) {
  const fs::path index = fs::path(NameOf(stage)) / "train" / "shard-000000.index.json";
  const ShardReader bare(without / index);
  const ShardReader rich(with / index);
  ASSERT_EQ(rich.index().episodes.size(), bare.index().episodes.size());
  for (std::size_t i = 0; i < bare.index().episodes.size(); ++i) {
    auto expected = MembersIn(bare, i);
    auto found = MembersIn(rich, i);
    nlohmann::ordered_json meta = nlohmann::ordered_json::parse(found.at("meta.json"));
    EXPECT_EQ(meta.erase("pictures"), 1U);
    found["meta.json"] = JsonText(meta, 1) + "\n";
    std::erase_if(found, [&](const auto& member) { return !expected.contains(member.first); });
    EXPECT_TRUE(found == expected) << NameOf(stage) << " " << i;
    EXPECT_GT(rich.index().episodes[i].members.size(), expected.size());
  }
}

TEST_F(StagesTest, PicturesChangeNothingElseAndAreTheSameWhenTheyAreTakenLater) {
  PicturesConfig pictures;
  pictures.cameras = {PictureCameraAt("own", CameraPlace::kScene),
                      PictureCameraAt("front", CameraPlace::kWorld),
                      PictureCameraAt("wrist", CameraPlace::kHand)};
  pictures.streams = {PictureStream::kDepth, PictureStream::kDepth32, PictureStream::kLabel,
                      PictureStream::kLink, PictureStream::kNormal};
  pictures.noise.sensor = DepthSensor::kTimeOfFlight;
  pictures.cloud_rgb = true;
  for (const Stage stage : {Stage::kOpen, Stage::kHandle, Stage::kGrasp}) {
    const fs::path bare = folder_ / "bare";
    const fs::path rich = folder_ / "rich";
    for (const fs::path& out : {bare, rich}) {
      StageRequest request = RequestFor(stage, 3);
      request.config.cloud.noise.sensor = DepthSensor::kStructuredLight;
      if (out == rich) request.config.pictures = pictures;
      request.threads = out == rich ? 2 : 1;
      CollectStage({request, out, {}, /*replace=*/false, {}});
      ExpectSound(out);
    }
    ExpectSameBesidePictures(bare, rich, stage);
    EXPECT_EQ(ReadDataset(rich).pictures.size(), 19U);

    ReobserveRequest later = Again(bare);
    later.settings = {"pictures=" + JsonText(ToJson(pictures))};
    later.threads = 1;
    ReobserveDataset(later);
    ExpectSound(later.out);
    EXPECT_EQ(TarHash(later.out, stage), TarHash(rich, stage)) << NameOf(stage);
    const ReobserveRequest again = Again(rich);
    ReobserveDataset(again);
    EXPECT_EQ(TarHash(again.out, stage), TarHash(rich, stage)) << NameOf(stage);
    for (const fs::path& folder : {bare, rich, later.out, again.out}) fs::remove_all(folder);
  }
}

// What a picture without the robot shows is finer there: of the stage "handle" most points are of
// it. Every point has the colour of a pixel that lies where it does.
TEST_F(StagesTest, ColoursOfCloudsNeedNoCameraOfTheirOwn) {
  for (const Stage stage : {Stage::kOpen, Stage::kHandle}) {
    StageRequest request = RequestFor(stage, 2);
    request.config.pictures.cloud_rgb = true;
    request.config.scene.appearance = SceneAppearance::kFull;
    const fs::path data = folder_ / std::string(NameOf(stage));
    CollectStage({request, data, {}, /*replace=*/false, {}});
    ExpectSound(data);
    const DatasetRecord record = ReadDataset(data);
    ASSERT_EQ(record.pictures.size(), 1U);
    EXPECT_EQ(DatasetToJson(record).at("features").back().at("shape"),
              nlohmann::ordered_json({"decisions", "points", 3}));
    const DatasetReader reader(data, std::string(NameOf(stage)), "train");
    const ShardReader& shard = reader.shards().front();
    const auto colors = ViewNpy<std::uint8_t>(shard.Read(0, "cloud_rgb.npy"), "cloud_rgb");
    EXPECT_EQ(colors.shape, (std::vector<std::size_t>{ViewEpisode(shard, 0).decisions,
                                                      ViewEpisode(shard, 0).points, 3}));
    EXPECT_GT(std::set<std::uint8_t>(colors.values.begin(), colors.values.end()).size(), 30U);
  }
}

TEST_F(StagesTest, ColoursOfWholeSurfacesAreRefused) {
  StageRequest request = RequestFor(Stage::kOpen, 2);
  request.config.pictures.cloud_rgb = true;
  request.config.cloud.whole = true;
  EXPECT_NE(Refusal(request).find("cloud_rgb"), std::string::npos) << Refusal(request);
}

// Exit code of a program for Debian's Python.
int RunPython(const std::string& program, const fs::path& argument) {
  const std::string command = "PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" DOORFORGE_SOURCE_DIR
                              "/python' /usr/bin/python3 -c '" +
                              program + "' '" + argument.string() + "'";
  return std::system(command.c_str());
}

TEST_F(StagesTest, TheReaderFindsEveryPointOfTheCloudInThePicture) {
  if (RunPython("import numpy", "") != 0) GTEST_SKIP() << "/usr/bin/python3 has no numpy here";
  for (const Stage stage : {Stage::kOpen, Stage::kGrasp}) {
    StageRequest request = RequestFor(stage, 2);
    request.config.cloud.noise.sensor = DepthSensor::kStructuredLight;
    request.config.cloud.noise.extrinsic_rad = 0.01;
    request.config.pictures.cameras = {PictureCameraAt("own", CameraPlace::kScene)};
    request.config.pictures.streams = {PictureStream::kDepth32, PictureStream::kLabel};
    const fs::path data = folder_ / std::string(NameOf(stage));
    CollectStage({request, data, {}, /*replace=*/false, {}});
    EXPECT_EQ(RunPython(R"(
import sys
import numpy as np
import doorforge_reader
data = doorforge_reader.Dataset(sys.argv[1])
found = 0
for part in data.parts:
    for episode in data.episodes(part.stage, part.split):
        assert episode.cameras() == ["own"], episode.cameras()
        for t in range(episode.decisions):
            pixels, labels = episode.points("own", t).reshape(-1, 3), episode["label_own"][t].ravel()
            cloud = episode["cloud"][t]
            near = np.isin(pixels[:, 0], cloud[:, 0])  # most of the picture is told off by one coordinate
            there = {(*pixel, label) for pixel, label in zip(pixels[near].tolist(), labels[near].tolist())}
            for point, label in zip(cloud.tolist(), episode["label"][t].tolist()):
                assert (*point, label) in there, (point, label)
                found += 1
assert found > 500
)",
                        data),
              0);
  }
}

TEST_F(StagesTest, PicturesThatCannotBeTakenAreRefusedBeforeAnyWork) {
  StageRequest request = RequestFor(Stage::kOpen, 2);
  PictureCamera inside = PictureCameraAt("front", CameraPlace::kWorld);
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 4, 0, request.config.scene);
  const Eigen::Vector3d leaf =
      scene.world_from_door *
      Eigen::Vector3d((DoorFromLinks(door, 0, 0)[kLeafLink] *
                       door.links[kLeafLink].geometry[0].hulls[0].vertices[0]) *
                          0.5 +
                      (DoorFromLinks(door, 0, 0)[kLeafLink] *
                       door.links[kLeafLink].geometry[0].hulls[0].vertices[7]) *
                          0.5);
  inside.position_m = {leaf.x(), leaf.y(), leaf.z()};
  request.config.pictures.cameras = {inside};
  EXPECT_NE(Refusal(request).find("inside the leaf"), std::string::npos) << Refusal(request);

  request.config.pictures.cameras = {PictureCameraAt("front", CameraPlace::kWorld)};
  request.config.pictures.cameras[0].width = 0;
  EXPECT_NE(Refusal(request).find("width 0"), std::string::npos);

  // so many episodes of 16 decisions and 16 million pixels are more than any disk
  request.config.pictures.cameras[0].width = request.config.pictures.cameras[0].height = 4096;
  request.config.episodes = 100'000;
  try {
    CollectStage({request, folder_ / "large", {}, false, {}});
    ADD_FAILURE() << "began";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("are needed"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(folder_ / "large" / "open"));
}

// A shard beside the first one, sound in itself, with the first episode under another key or with
// other meta data: made by another program, as far as anybody can tell.
void AddForeignShard(const fs::path& data, const std::string& key,
                     const std::function<void(nlohmann::ordered_json&)>& change) {
  const fs::path part = data / "open" / "train";
  const ShardReader reader(part / "shard-000000.index.json");
  const ShardEpisode& episode = reader.index().episodes.at(0);
  nlohmann::ordered_json meta = ReadEpisodeMeta(reader, 0);
  change(meta);
  std::vector<MemberBytes> members;
  for (const ShardMember& member : episode.members) {
    const auto bytes = reader.Read(0, member.name);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    members.push_back({member.name, member.name == "meta.json" ? JsonText(meta) : text});
  }
  ShardWriter writer(part, {1, "open", "train", reader.index().header.config_sha256});
  writer.Add(key.empty() ? episode.key : key, episode.decisions, std::move(members));
  writer.Commit();
}

TEST_F(StagesTest, AForeignShardIsRefusedByNameAndWithWhatIsWrong) {
  const fs::path data = Collected(Stage::kOpen, 2);
  const auto expect = [&](const std::string& key, const std::string& problem,
                          const std::function<void(nlohmann::ordered_json&)>& change) {
    AddForeignShard(data, key, change);
    const ReobserveRequest request = Again(data);
    try {
      ReobserveDataset(request);
      ADD_FAILURE() << problem << ": was looked at again";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat) << error.what();
      EXPECT_NE(std::string(error.what()).find(problem), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("shard-000001.tar"), std::string::npos)
          << error.what();
    }
    for (const char* ending : {".tar", ".index.json"})
      fs::remove(data / "open" / "train" / (std::string("shard-000001") + ending));
    fs::remove_all(request.out);
  };
  const auto nothing = [](nlohmann::ordered_json&) {};
  expect("epXYZ", "none of an episode of a plan", nothing);
  expect("ep99999999999999999999999999", "none of an episode of a plan", nothing);
  expect("", "is in another shard as well", nothing);
  expect("ep000009", "which provenance.json does not name",
         [](nlohmann::ordered_json& meta) { meta["scene"]["door_id"] = "nobody"; });
  expect("ep000009", "decision times", [](nlohmann::ordered_json& meta) {
    meta["decision_time_s"] = nlohmann::ordered_json::array();
  });
  expect("ep000009", "robot_seen",
         [](nlohmann::ordered_json& meta) { meta["robot_seen"] = "perhaps"; });
  ReobserveDataset(Again(data));
  ExpectSound(Again(data).out);
}

TEST(StageConfigTest, MoreEpisodesThanAPlanHoldsAreRefused) {
  StageConfig config = DefaultsOf(Stage::kOpen);
  EXPECT_NO_THROW(CheckStageConfig(config));
  for (const std::uint64_t episodes : {std::uint64_t{0}, std::uint64_t{2147483647}}) {
    config.episodes = episodes;
    EXPECT_THROW(CheckStageConfig(config), Error) << episodes;
  }
}

TEST(RecordedRobotTest, OnlyAFileOfTheDatasetOrOfTheCommandLineIsOpened) {
  EXPECT_EQ(RecordedRobot("data", "", ""), "");
  EXPECT_EQ(RecordedRobot("data", "data/robot.urdf", ""), "data/robot.urdf");
  EXPECT_EQ(RecordedRobot("data", "/etc/passwd", "mine.urdf"), "mine.urdf");
  for (const char* elsewhere : {"/etc/passwd", "robot.urdf", "data/../robot.urdf", "database/r"})
    EXPECT_THROW(RecordedRobot("data", elsewhere, ""), Error) << elsewhere;
}

TEST_F(StagesTest, WithoutTheRobotOnlyWhatIsSeenChanges) {
  const fs::path data = Collected(Stage::kOpen, 2);
  ReobserveRequest request = Again(data);
  request.without_robot = true;
  ReobserveDataset(request);
  ExpectSound(request.out);
  const DatasetReader with(data, "open", "train");
  const DatasetReader without(request.out, "open", "train");
  ASSERT_EQ(with.size(), without.size());
  const auto robot_points = [](std::span<const std::uint8_t> labels) {
    return std::count(labels.begin(), labels.end(), static_cast<std::uint8_t>(PointLabel::kRobot));
  };
  for (std::size_t i = 0; i < with.size(); ++i) {
    const EpisodeArrays a = with.Arrays(i);
    const EpisodeArrays b = without.Arrays(i);
    EXPECT_EQ(with.entry(i).key, without.entry(i).key);
    EXPECT_TRUE(std::equal(a.action.begin(), a.action.end(), b.action.begin(), b.action.end()));
    EXPECT_TRUE(std::equal(a.state.begin(), a.state.end(), b.state.begin(), b.state.end()));
    EXPECT_GT(robot_points(a.label), 0);
    EXPECT_EQ(robot_points(b.label), 0);
  }
}

// as after a recorded handle, where a trained opener goes on looking
TEST_F(StagesTest, ThePreviewEndsWithTheLastLookThatIsRecorded) {
  const PrimitiveDoor shape;
  const DoorAsset door = MakePrimitiveDoor(shape);
  const StageConfig config = DefaultsOf(Stage::kHandle);
  const RobotModel robot = LoadRobot("", config.scene.physics.base);
  const Scene scene = PlaceRobotBase(robot, SampleScene(door, 1, 0, config.scene), door);
  const auto preview_after = [&](const std::vector<double>& hinges, std::size_t recorded) {
    RecordingCamera camera(scene, door, robot, config.cloud);
    for (const double hinge_rad : hinges) {
      SceneSnapshot snapshot;
      snapshot.robot =
          robot.PoseAt(JointVector::Zero(robot.joint_count()), scene.world_from_robot_base);
      snapshot.door = DoorFromLinks(door, hinge_rad, 0);
      for (RigidTransform& pose : snapshot.door) pose = scene.world_from_door * pose;
      camera.ObserveAll(snapshot);
    }
    return camera.PreviewPng(recorded);
  };
  const std::string recorded = preview_after({0, 0.2}, 2);
  EXPECT_EQ(preview_after({0, 0.2, 0.9}, 2), recorded);
  EXPECT_NE(preview_after({0, 0.9}, 2), recorded);
}

TEST_F(StagesTest, AnotherCameraIsInTheRecord) {
  const fs::path data = Collected(Stage::kOpen, 2);
  ReobserveRequest request = Again(data);
  request.settings = {"camera.position_m=[1.6, 0.8, 1.7]"};
  ReobserveDataset(request);
  const DatasetReader moved(request.out, "open", "train");
  ASSERT_GT(moved.size(), 0U);
  EXPECT_EQ(moved.Meta(0).at("scene").at("camera").at("position_m")[1], 0.8);
  EXPECT_NE(TarHash(request.out, Stage::kOpen), TarHash(data, Stage::kOpen));
}

// Who opens after the recorded stage may be a class of somebody's program.
TEST_F(StagesTest, APolicyOfOnesOwnActsAndIsInTheRecord) {
  class Standing : public Policy {
   public:
    Action Act(const Observation& seen) override {
      return {Eigen::Vector3d::Zero(), seen.privileged.world_from_hand.linear()};
    }
    bool UsesPointCloud() const override { return false; }
  };
  StageRequest request = RequestFor(Stage::kGrasp, 1);
  const std::string by_expert = StageRun(request).Request().config_text;
  request.registry.Add(MotionPolicyRow{Stage::kOpen, "standing",
                                       [](const auto&) { return std::make_unique<Standing>(); }});
  request.policies.opener = "standing";
  StageRun run(request);
  const CollectedEpisode collected = run.Run({.number = 0, .door = 0});
  EXPECT_NE(collected.episode.outcome, EpisodeOutcome::kOpened) << "it stands still";
  EXPECT_EQ(collected.meta.at("policies").at("open"), "standing");
  EXPECT_EQ(collected.meta.at("policies").at("unlock"), "expert");
  EXPECT_NE(run.Request().config_text, by_expert) << "a run by another is not gone on with";
  request.policies.opener = "standign";
  EXPECT_NE(Refusal(request).find("did you mean \"standing\""), std::string::npos)
      << Refusal(request);
}

TEST_F(StagesTest, RefusesAPolicyBeforeAnyWork) {
  StageRequest request = RequestFor(Stage::kGrasp, 2);
  request.policies.opener = (folder_ / "policy").string();
  EXPECT_NE(Refusal(request).find("no such folder"), std::string::npos);

  fs::create_directories(request.policies.opener);
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(fs::path(request.policies.opener) / name) << text;
  };
  const std::string tail = R"("weights": "w", "weights_sha256": ")" + Sha256Hex("numbers") +
                           R"(", "provenance": {"dataset_sha256": "d", "code_version": "v"}})";
  write("w", "numbers");
  write("policy.json",
        R"({"schema": "doorforge.policy", "schema_version": 1, "stage": "handle", )" + tail);
  EXPECT_NE(Refusal(request).find("a policy of the stage \"handle\"; --opener takes one"),
            std::string::npos);
  write("policy.json",
        R"({"schema": "doorforge.policy", "schema_version": 9, "stage": "open", )" + tail);
  EXPECT_NE(Refusal(request).find("version"), std::string::npos);
  write("policy.json",
        R"({"schema": "doorforge.policy", "schema_version": 1, "stage": "open", )" + tail);
  StageRequest corrected = RequestFor(Stage::kHandle, 2);
  corrected.policies.learner = request.policies.opener;
  EXPECT_NE(Refusal(corrected).find("the stage \"open\"; --learner takes one of"),
            std::string::npos)
      << Refusal(corrected);
  corrected = RequestFor(Stage::kGrasp, 2);
  corrected.policies.learner = request.policies.opener;
  EXPECT_NE(Refusal(corrected).find("--learner takes one of the stage \"grasp\""),
            std::string::npos)
      << Refusal(corrected);
  write("policy.json", R"({"schema": "doorforge.policy", "schema_version": 1, "stage": "open", )"
                       R"("sizes": {"cloud_points": 4096}, )" +
                           tail);
  EXPECT_NE(Refusal(request).find("takes clouds of 4096 points; config.cloud.point_count is 512"),
            std::string::npos)
      << Refusal(request);
  write("w", "other numbers");
  EXPECT_NE(Refusal(request).find("SHA-256 is not the one"), std::string::npos);

  StageRequest open = RequestFor(Stage::kOpen, 2);
  open.policies.opener = request.policies.opener;
  EXPECT_NE(Refusal(open).find("--opener: belongs to"), std::string::npos);
}

}  // namespace
}  // namespace doorforge
