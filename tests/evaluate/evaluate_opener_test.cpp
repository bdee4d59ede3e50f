// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/evaluate_opener.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/evaluate/run_trials.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode_arrays.h"
#include "doorforge/training/stage_dataset.h"

#include "../physics/primitive_door.h"
#include "../program_answer.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

DoorAsset DoorNamed(const std::string& body, const std::string& handle) {
  DoorAsset door = MakePrimitiveDoor({});
  door.id = body + "__" + handle;
  door.body.id = body;
  door.body.sha256 = "hash of " + body;
  door.handle.id = handle;
  door.handle.sha256 = "hash of " + handle;
  return door;
}

void WriteDoorFolder(const DoorAsset& door, const fs::path& folder) {
  fs::create_directories(folder / door.id);
  WriteDoor(door, folder / door.id);
}

void WriteDataset(const DoorAsset& door, const fs::path& folder) {
  const RobotModel robot = LoadMobileFranka();
  const Scene scene = SampleScene(door, 7, 0);
  CameraObserver camera(scene, door, robot);
  OpeningExpert expert;
  const Episode episode = RunEpisode(scene, door, robot, expert, &camera);
  for (const std::string stage : {"open", "handle", "grasp"}) {
    ShardWriter shard(folder / stage / "train", {0, stage, "train", "config"});
    shard.Add("ep000000", episode.decisions.size(),
              EncodeEpisode(episode, EpisodeMetaToJson(episode), "a preview's bytes"));
    shard.Commit();
  }
  DatasetProvenance provenance;
  provenance.doors.push_back({door.id, ContentHash(door), "interior", "lever", door.body,
                              door.handle, "CC0-1.0", "train"});
  WriteJsonFile(folder / "provenance.json", ProvenanceToJson(provenance));
}

// networks as they are before training: whatever they do, they do it reproducibly
void WriteUntrainedPolicy(const fs::path& data, const std::string& stage, const fs::path& folder,
                          bool colors = false) {
  const StageDataset dataset = ReadStageDataset({{data}}, stage, 0);
  PolicyProvenance provenance;
  provenance.stage = stage;
  provenance.dataset_sha256 = dataset.content_sha256;
  provenance.trained_on = dataset.parts;
  provenance.config.family = FamilyOf(stage);
  provenance.config.colors = colors;
  NetworkView view;
  view.colors = colors;
  WritePolicy(folder,
              InitialNetworks(MeasureNormalisation(dataset.train, view), false, 3,
                              provenance.config.family),
              provenance);
}

class EvaluateOpenerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("evaluate_opener_test_" + std::to_string(::getpid()));
    const DoorAsset trained_on = DoorNamed("body_a", "handle_a");
    WriteDoorFolder(trained_on, folder_ / "seen");
    WriteDoorFolder(DoorNamed("body_b", "handle_a"), folder_ / "half_seen");
    WriteDoorFolder(DoorNamed("body_b", "handle_b"), folder_ / "held_out");
    WriteDataset(trained_on, folder_ / "data");
    WriteUntrainedPolicy(folder_ / "data", "open", folder_ / "policy");
    WriteUntrainedPolicy(folder_ / "data", "handle", folder_ / "handler");
    WriteUntrainedPolicy(folder_ / "data", "grasp", folder_ / "grasper");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  // Without pictures, which take most of an evaluation: the tests that look at them ask for them.
  static EvaluationRequest RequestFor(const std::string& doors) {
    EvaluationRequest request;
    request.policies.opener = folder_ / "policy";
    request.doors.folders = {folder_ / doors};
    request.data = {folder_ / "data"};
    request.config.seeds = 1;
    request.config.scene.physics.max_opening_actions = 4;
    request.threads = 1;
    request.pictures = false;
    return request;
  }

  static std::string RefusalOf(const EvaluationRequest& request) {
    try {
      EvaluateOpener(request);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "";
  }

  static fs::path folder_;
};
fs::path EvaluateOpenerTest::folder_;

TEST_F(EvaluateOpenerTest, RunsTheNetworksInClosedLoopBesideTheExpert) {
  EvaluationRequest request = RequestFor("held_out");
  request.pictures = true;
  const Evaluation evaluation = EvaluateOpener(request);
  const EvaluationReport& report = evaluation.report;
  ASSERT_EQ(report.episodes.size(), 1U);
  ASSERT_EQ(report.reference.size(), 1U);
  EXPECT_EQ(report.provenance.policy, "policy");
  EXPECT_EQ(report.provenance.policy_sha256, ReadPolicy(request.policies.opener).weights_sha256);
  EXPECT_EQ(report.training_doors.size(), 1U);
  EXPECT_EQ(evaluation.pictures.doors.size(), 2U) << "the held-out door and a preview from a shard";
  EXPECT_EQ(evaluation.pictures.doors.at("body_a__handle_a"), "a preview's bytes");
  EXPECT_NE(report.episodes[0].state_sha256, report.reference[0].state_sha256);

  EvaluationRequest again = request;
  again.threads = 2;
  const Evaluation second = EvaluateOpener(again);
  EXPECT_EQ(ReportToJson(second.report).dump(), ReportToJson(report).dump());
  EXPECT_EQ(ReportPage(second.report, second.pictures), ReportPage(report, evaluation.pictures));

  again.pictures = false;
  const Evaluation counted = EvaluateOpener(again);
  EXPECT_EQ(ReportToJson(counted.report).dump(), ReportToJson(report).dump());
  EXPECT_TRUE(counted.pictures.doors.empty() && counted.pictures.episodes.empty());
}

TEST_F(EvaluateOpenerTest, DoorsWithSeenPartsAreRefusedByName) {
  EXPECT_NE(RefusalOf(RequestFor("seen")).find("body_a__handle_a"), std::string::npos);
  EXPECT_NE(RefusalOf(RequestFor("half_seen")).find("body_b__handle_a"), std::string::npos);
  EvaluationRequest allowed = RequestFor("half_seen");
  allowed.allow_seen = true;
  allowed.config.expert_reference = false;
  EXPECT_EQ(EvaluateOpener(allowed).report.episodes.size(), 1U);
}

TEST_F(EvaluateOpenerTest, ThePolicyItselfKnowsWhatWasSeen) {
  EvaluationRequest request = RequestFor("half_seen");
  request.data.clear();
  EXPECT_NE(RefusalOf(request).find("body_b__handle_a"), std::string::npos);
  request = RequestFor("held_out");
  request.data.clear();
  request.config.expert_reference = false;
  const EvaluationReport report = EvaluateOpener(request).report;
  EXPECT_TRUE(report.training_doors.empty());
  ASSERT_EQ(report.trained_on.bodies.size(), 1U);
  EXPECT_EQ(report.trained_on.bodies[0].id, "body_a");

  PolicyRecord old = ReadPolicy(request.policies.opener);
  old.provenance.trained_on = {};
  WritePolicy(folder_ / "old", old.networks, old.provenance);
  request.policies.opener = folder_ / "old";
  EXPECT_NE(RefusalOf(request).find("does not say which bodies"), std::string::npos);

  WriteDataset(DoorNamed("body_c", "handle_c"), folder_ / "other_data");
  EvaluationRequest wrong = RequestFor("held_out");
  wrong.data = {folder_ / "other_data"};
  EXPECT_NE(RefusalOf(wrong).find("trained from"), std::string::npos);
}

TEST_F(EvaluateOpenerTest, ATrainedHandlePolicyTurnsTheHandleAndItsDoorsAreSeenToo) {
  EvaluationRequest request = RequestFor("held_out");
  request.policies.opener = "expert";
  request.data.clear();
  request.config.expert_reference = false;
  const EvaluationReport ruled = EvaluateOpener(request).report;
  EXPECT_FALSE(IsSwitchPredicted(ruled.provenance)) << "a rule has the simulator's answer";
  const std::string by_rule = ruled.episodes.at(0).state_sha256;
  request.policies.handler = folder_ / "handler";
  request.config.unlock_switch = SwitchSource::kSimulator;
  const EvaluationReport report = EvaluateOpener(request).report;
  EXPECT_NE(report.episodes.at(0).state_sha256, by_rule);
  EXPECT_EQ(report.provenance.handler_sha256,
            ReadPolicy(request.policies.handler, "handle").weights_sha256);

  request.doors.folders = {folder_ / "half_seen"};
  EXPECT_NE(RefusalOf(request).find("body_b__handle_a"), std::string::npos);
  request.policies.handler = folder_ / "policy";
  EXPECT_THROW(EvaluateOpener(request), Error) << "an opener does not turn handles";
}

TEST_F(EvaluateOpenerTest, AHandlePolicyThatSaysWhenItIsDoneIsBelieved) {
  EvaluationRequest request = RequestFor("held_out");
  request.policies.opener = "expert";
  request.data.clear();
  request.config.expert_reference = false;
  const fs::path handler = folder_ / "handler";
  request.policies.handler = handler.string();
  EXPECT_NE(RefusalOf(request).find("run its training command again with --resume"),
            std::string::npos);

  TurnedClassifier always;
  always.deviation.fill(1);
  always.bias = 10;
  WriteTurnedClassifier(handler, always, ReadPolicy(handler, "handle").provenance.dataset_sha256);
  const EvaluationReport report = EvaluateOpener(request).report;
  EXPECT_TRUE(IsSwitchPredicted(report.provenance));
  const EvaluatedEpisode& row = report.episodes.at(0);
  EXPECT_FALSE(row.handle_turned);
  EXPECT_EQ(row.outcome, EpisodeOutcome::kHandleStuck) << row.detail;
  EXPECT_NE(row.detail.find("the switch came with the handle at"), std::string::npos) << row.detail;
  fs::remove(handler / "turned.safetensors");
}

TEST_F(EvaluateOpenerTest, AProgramWithItsOwnPolicyEvaluatesItWithOneCommand) {
  const std::string program = DOORFORGE_BINARY_DIR "/bin/evaluate_own_policy";
  const fs::path out = folder_ / "own_report";
  const ProgramAnswer answer = AnswerOf(
      program + " --doors " + (folder_ / "held_out").string() +
      " --seeds 1 --threads 1 --set expert_reference=false --out " + out.string() + " 2>/dev/null");
  EXPECT_EQ(answer.code, 0) << answer.text;
  EXPECT_NE(answer.text.find("95 % interval"), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("handle: rule; opening: circle_about_hinge"), std::string::npos)
      << answer.text;
  const EvaluationReport report = ReportFromJson(ReadJsonFile(out / "report.json"), "report");
  EXPECT_EQ(report.provenance.policy, "circle_about_hinge");
  ASSERT_EQ(report.episodes.size(), 1U);
  EXPECT_EQ(report.episodes[0].outcome, EpisodeOutcome::kOpened) << report.episodes[0].detail;
  EXPECT_TRUE(fs::exists(out / "report.html"));

  // what it was trained on, if anything, is for its maker to say
  const std::string seen = program + " --doors " + (folder_ / "seen").string() + " --data " +
                           (folder_ / "data").string() + " 2>&1";
  const ProgramAnswer refused = AnswerOf(seen);
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("body_a__handle_a"), std::string::npos) << refused.text;
}

TEST_F(EvaluateOpenerTest, ATrainedGrasperTakesHoldAndItsDoorsAreSeenToo) {
  EvaluationRequest request = RequestFor("held_out");
  request.policies.opener = "expert";
  request.data.clear();
  request.config.expert_reference = false;
  request.config.grasp.orientations = 4;
  const std::string by_rule = EvaluateOpener(request).report.episodes.at(0).state_sha256;
  request.policies.grasper = folder_ / "grasper";
  request.pictures = true;
  const Evaluation evaluation = EvaluateOpener(request);
  const EvaluationReport& report = evaluation.report;
  EXPECT_NE(report.episodes.at(0).state_sha256, by_rule);
  ASSERT_EQ(evaluation.pictures.grasps.size(), 1U) << "a heat map";
  EXPECT_NE(evaluation.pictures.grasps[0].picture.caption.find("affordance"), std::string::npos);
  EXPECT_EQ(report.provenance.grasper_sha256,
            ReadPolicy(request.policies.grasper, "grasp").weights_sha256);
  const EvaluationReport back = ReportFromJson(ReportToJson(report), "report");
  EXPECT_EQ(back.provenance.grasper_sha256, report.provenance.grasper_sha256);

  request.doors.folders = {folder_ / "half_seen"};
  EXPECT_NE(RefusalOf(request).find("body_b__handle_a"), std::string::npos);
  request.policies.grasper = folder_ / "policy";
  EXPECT_THROW(EvaluateOpener(request), Error) << "an opener does not choose grasps";

  request.policies.grasper = "random";
  const Evaluation sampled = EvaluateOpener(request);
  EXPECT_EQ(sampled.report.provenance.grasper_sha256, "random");
  EXPECT_TRUE(sampled.pictures.grasps.empty());
}

TEST_F(EvaluateOpenerTest, TheExpertNeedsNeitherPolicyNorData) {
  EvaluationRequest request = RequestFor("seen");
  request.policies.opener = "expert";
  request.data.clear();
  request.config.scene.physics.max_opening_actions = 25;
  const Evaluation evaluation = EvaluateOpener(request);
  EXPECT_EQ(evaluation.report.provenance.policy, "expert");
  EXPECT_TRUE(evaluation.report.reference.empty());
  EXPECT_EQ(evaluation.report.episodes[0].outcome, EpisodeOutcome::kOpened);
}

// All three stages: where they read colours, it matters how the scene looks, and only then.
TEST_F(EvaluateOpenerTest, APolicyThatReadsColoursIsShownThem) {
  const auto states = [&](bool colors, SceneAppearance appearance) {
    const fs::path out = folder_ / (colors ? "with_colors" : "without_colors");
    for (const std::string stage : {"open", "handle", "grasp"}) {
      if (!fs::exists(out / stage))
        WriteUntrainedPolicy(folder_ / "data", stage, out / stage, colors);
    }
    EvaluationRequest request = RequestFor("held_out");
    request.policies = {
        .opener = out / "open", .handler = out / "handle", .grasper = out / "grasp"};
    request.config.scene.appearance = appearance;
    request.config.unlock_switch = SwitchSource::kSimulator;
    std::vector<std::string> ends;
    for (const EvaluatedEpisode& episode : EvaluateOpener(request).report.episodes)
      ends.push_back(episode.state_sha256);
    return ends;
  };
  EXPECT_EQ(states(false, SceneAppearance::kOff), states(false, SceneAppearance::kFull));
  EXPECT_EQ(states(true, SceneAppearance::kFull), states(true, SceneAppearance::kFull));
  EXPECT_NE(states(true, SceneAppearance::kOff), states(true, SceneAppearance::kFull));
}

}  // namespace
}  // namespace doorforge
