// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/stage_dataset.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/training_curves.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode_arrays.h"
#include "doorforge/schemas/mirror.h"
#include "doorforge/training/train_stage.h"
#include "doorforge/training/trainer_state_file.h"

#include "../program_answer.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDecisions = 3;

void WriteProvenance(const fs::path& folder) {
  const PartIdentity body{"body_of_" + folder.filename().string(), "", {}};
  DatasetProvenance provenance;
  provenance.doors.push_back(
      {"door", "", "interior", "lever", body, {"handle", "", {}}, "CC0-1.0", "train"});
  WriteJsonFile(folder / "provenance.json", ProvenanceToJson(provenance));
}

// Every other door is pushed.
nlohmann::ordered_json MetaOf(const Episode& episode, std::size_t number) {
  nlohmann::ordered_json meta = EpisodeMetaToJson(episode);
  if (number % 2 == 1) meta["way"] = "other";
  return meta;
}

// A data set of `episodes` episodes with three decisions each, in one shard.
testing::SyntheticSamples WriteDataset(const fs::path& folder, const std::string& split,
                                       std::size_t episodes, int shard = 0,
                                       const std::string& stage = "open") {
  auto made = testing::MakeSyntheticSamples(11, episodes * kDecisions);
  ShardWriter writer(folder / stage / split, {shard, stage, split, "config"});
  for (std::size_t e = 0; e < episodes; ++e) {
    Episode episode;
    episode.outcome = EpisodeOutcome::kOpened;
    episode.scene.latch.handle_done_angle_rad = 0.44;
    for (std::size_t t = 0; t < kDecisions; ++t) {
      TrainingSample& sample = made.samples[e * kDecisions + t];
      Decision decision;
      decision.cloud.xyz.assign(sample.cloud.begin(), sample.cloud.end());
      decision.cloud.label.assign(sample.cloud.size() / 3, 0);
      for (std::size_t i = 0; i < decision.proprioception.size(); ++i)
        decision.proprioception[i] = 1e-3F * static_cast<float>(100 * e + 40 * t + i);
      decision.action = sample.action;
      decision.executed = sample.executed;
      decision.angle_gain_rad = sample.angle_gain_rad;  // 0.05 to 0.07
      decision.handle_rad = 0.2 * static_cast<double>(t);
      episode.decisions.push_back(decision);
    }
    writer.Add("ep" + std::to_string(100000 + e), kDecisions,
               EncodeEpisode(episode, MetaOf(episode, e), ""));
  }
  writer.Commit();
  WriteProvenance(folder);
  return made;
}

fs::path EmptyDataset(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("doorforge_dataset_" + name);
  fs::remove_all(folder);
  return folder;
}

TEST(StageDataset, HoldsTheDecisionsOfTheShards) {
  const fs::path folder = EmptyDataset("read");
  const auto made = WriteDataset(folder, "train", 4);
  const StageDataset dataset = ReadStageDataset({{folder}}, "open", 0.25);
  ASSERT_EQ(dataset.train.size(), 9U);
  ASSERT_EQ(dataset.validation.size(), 3U);
  EXPECT_EQ(dataset.content_sha256.size(), 64U);
  ASSERT_EQ(dataset.parts.bodies.size(), 1U);
  EXPECT_EQ(dataset.parts.bodies[0].id, "body_of_doorforge_dataset_read");
  const TrainingSample& sample = dataset.train[5];  // episode 1, decision 2
  EXPECT_TRUE(std::equal(sample.cloud.begin(), sample.cloud.end(), made.samples[5].cloud.begin(),
                         made.samples[5].cloud.end()));
  EXPECT_EQ(sample.action, made.samples[5].action);
  EXPECT_EQ(sample.executed, made.samples[5].executed);
  EXPECT_NE(sample.executed, sample.action);
  EXPECT_EQ(sample.angle_gain_rad, made.samples[5].angle_gain_rad);
  EXPECT_EQ(sample.way, MotionWay::kOther);
  EXPECT_EQ(dataset.train[0].way, MotionWay::kUsual);
  EXPECT_FLOAT_EQ(sample.proprioception[0], 0.180F);   // first joint position
  EXPECT_FLOAT_EQ(sample.proprioception[11], 0.191F);  // first joint velocity
  EXPECT_FLOAT_EQ(sample.proprioception[31], 0.211F);  // the hand's quaternion, w
}

TEST(StageDataset, SaysOfTheHandlesDecisionsWhichTurnedIt) {
  const fs::path folder = EmptyDataset("turned");
  WriteDataset(folder, "train", 4, 0, "handle");
  const StageDataset dataset = ReadStageDataset({{folder}}, "handle", 0.25);
  ASSERT_EQ(dataset.turned_train.size(), 9U);
  ASSERT_EQ(dataset.turned_validation.size(), 3U);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(dataset.turned_train[i].turned, i % kDecisions == 2) << i;
  const TurnedExample& example = dataset.turned_train[4];  // episode 1, decision 1
  EXPECT_NEAR(example.motion[6], 0.04F, 1e-6);             // the hand's way along x
  EXPECT_NEAR(example.motion[9], 0.04F + dataset.train[4].executed[0], 1e-6);
  const fs::path other = EmptyDataset("not_turned");
  WriteDataset(other, "train", 4);
  EXPECT_TRUE(ReadStageDataset({{other}}, "open", 0.25).turned_train.empty());
}

// In which every other episode of a data set is seen.
enum class Mirror { kSideways, kUpright };

template <class T>
T InMirror(Mirror mirror, T seen) {
  return mirror == Mirror::kSideways ? MirroredSideways(std::move(seen))
                                     : MirroredUpright(std::move(seen));
}

// Episodes of usual doors and of their mirror images in turn, the record saying so; or all shown as
// usual ones.
fs::path WriteBoth(Mirror mirror, const std::string& name, const std::string& stage,
                   bool are_mirrored) {
  const fs::path folder = EmptyDataset(name);
  auto made = testing::MakeSyntheticSamples(5, 4 * kDecisions);
  ShardWriter writer(folder / stage / "train", {0, stage, "train", "config"});
  for (std::size_t e = 0; e < 4; ++e) {
    const bool is_other = e % 2 == 1;
    Episode episode;
    episode.outcome = EpisodeOutcome::kOpened;
    for (std::size_t t = 0; t < kDecisions; ++t) {
      const TrainingSample& sample = made.samples[e * kDecisions + t];
      Decision decision;
      decision.cloud.xyz.assign(sample.cloud.begin(), sample.cloud.end());
      decision.cloud.label.assign(sample.cloud.size() / 3, 0);
      decision.proprioception = sample.proprioception;
      decision.action = sample.action;
      decision.executed = sample.executed;
      decision.angle_gain_rad = sample.angle_gain_rad;
      if (is_other && are_mirrored) {
        decision.cloud = InMirror(mirror, std::move(decision.cloud));
        decision.proprioception = InMirror(mirror, decision.proprioception);
        decision.action = InMirror(mirror, decision.action);
        decision.executed = InMirror(mirror, decision.executed);
      }
      episode.decisions.push_back(decision);
    }
    nlohmann::ordered_json meta = EpisodeMetaToJson(episode);
    if (is_other && !are_mirrored) {
      if (mirror == Mirror::kSideways) meta["side"] = "right";
      if (mirror == Mirror::kUpright) meta["way"] = "other";
    }
    writer.Add("ep" + std::to_string(100000 + e), kDecisions, EncodeEpisode(episode, meta, ""));
  }
  writer.Commit();
  WriteProvenance(folder);
  return folder;
}

// The actor that one step on all of a data set's samples makes.
std::vector<float> Learned(const fs::path& folder, const std::string& stage, bool shows_mirrored) {
  const StageDataset dataset = ReadStageDataset({{folder}}, stage, 0, {false, shows_mirrored});
  TrainConfig config;
  config.epochs = 1;
  config.batch_size = 12;
  config.warmup_steps = 0;
  return TrainStage(dataset.train, {}, config, {}).networks.actor;
}

TEST(StageDataset, DoorsHingedRightTeachWhatTheirMirrorImagesTeach) {
  const fs::path right = WriteBoth(Mirror::kSideways, "hinged_right", "open", false);
  const fs::path mirrored = WriteBoth(Mirror::kSideways, "in_the_mirror", "open", true);
  const std::vector<float> shown = Learned(right, "open", true);
  EXPECT_EQ(shown, Learned(mirrored, "open", true));
  EXPECT_NE(shown, Learned(right, "open", false));
}

TEST(StageDataset, HandlesThatUnlockTheOtherWayTeachWhatTheirMirrorImagesTeach) {
  const fs::path reversed = WriteBoth(Mirror::kUpright, "reversed", "handle", false);
  const fs::path mirrored = WriteBoth(Mirror::kUpright, "upside_down", "handle", true);
  const std::vector<float> shown = Learned(reversed, "handle", true);
  EXPECT_EQ(shown, Learned(mirrored, "handle", true));
  EXPECT_NE(shown, Learned(reversed, "handle", false));
}

TEST(StageDataset, PushedDoorsAreNotShownUpsideDown) {
  const fs::path pushed = WriteBoth(Mirror::kUpright, "pushed", "open", false);
  const StageDataset shown = ReadStageDataset({{pushed}}, "open", 0, {false, true});
  EXPECT_EQ(shown.train[kDecisions].way, MotionWay::kOther);
  EXPECT_FALSE(shown.train[kDecisions].is_upside_down);
}

void ExpectTurnsOfMirrorImages(Mirror mirror, const std::string& name) {
  const fs::path other = WriteBoth(mirror, "handle_" + name, "handle", false);
  const fs::path mirrored = WriteBoth(mirror, "handle_as_usual_" + name, "handle", true);
  const auto shown = ReadStageDataset({{other}}, "handle", 0, {false, true}).turned_train;
  const auto expected = ReadStageDataset({{mirrored}}, "handle", 0).turned_train;
  ASSERT_EQ(shown.size(), expected.size());
  for (std::size_t i = 0; i < shown.size(); ++i)
    for (std::size_t k = 0; k < shown[i].motion.size(); ++k)
      EXPECT_NEAR(shown[i].motion[k], expected[i].motion[k], 1e-5) << i << ' ' << k;
  const auto as_it_is = ReadStageDataset({{other}}, "handle", 0).turned_train;
  double apart = 0;
  for (std::size_t k = 0; k < as_it_is[4].motion.size(); ++k)
    apart += std::abs(as_it_is[4].motion[k] - shown[4].motion[k]);
  EXPECT_GT(apart, 1e-3);
}

TEST(StageDataset, HandlesOfOtherDoorsAreTurnedAsTheirMirrorImagesAre) {
  ExpectTurnsOfMirrorImages(Mirror::kSideways, "right");
  ExpectTurnsOfMirrorImages(Mirror::kUpright, "reversed");
}

// One episode with three decisions, the last of which brought the handle to 34 degrees and back,
// and whose rewards are no angles.
std::vector<bool> TurnedOf(EpisodeOutcome outcome, double simulated_s) {
  const fs::path folder = EmptyDataset("rewarded");
  ShardWriter writer(folder / "handle" / "train", {0, "handle", "train", "config"});
  Episode episode;
  episode.outcome = outcome;
  episode.simulated_s = simulated_s;
  episode.scene.latch.handle_done_angle_rad = 0.44;
  for (const double handle_rad : {0.1, 0.3, 0.6}) {
    Decision decision;
    decision.cloud.xyz.assign(3 * kCloudPoints, 0.5F);
    decision.cloud.label.assign(kCloudPoints, 0);
    decision.proprioception.fill(0.1F);
    decision.action.fill(0.1F);
    decision.executed.fill(0.1F);
    decision.handle_rad = handle_rad;
    decision.angle_gain_rad = 7 - 10 * handle_rad;
    decision.time_s = 2 + static_cast<double>(episode.decisions.size()) / 6;
    episode.decisions.push_back(decision);
  }
  writer.Add("ep100000", 3, EncodeEpisode(episode, EpisodeMetaToJson(episode), ""));
  writer.Commit();
  WriteProvenance(folder);
  std::vector<bool> turned;
  for (const TurnedExample& example : ReadStageDataset({{folder}}, "handle", 0).turned_train)
    turned.push_back(example.turned);
  return turned;
}

TEST(StageDataset, WhetherAHandleIsTurnedIsNotReadFromTheReward) {
  using Turned = std::vector<bool>;
  EXPECT_EQ(TurnedOf(EpisodeOutcome::kOpened, 5), (Turned{false, true, true}));
  EXPECT_EQ(TurnedOf(EpisodeOutcome::kGripLost, 3), (Turned{false, true, true}));
  EXPECT_EQ(TurnedOf(EpisodeOutcome::kCollision, 2.5), (Turned{false, true, false}));
}

TEST(StageDataset, UsesTheSplitForValidationWhereThereIsOne) {
  const fs::path folder = EmptyDataset("val");
  WriteDataset(folder, "train", 2);
  const std::string alone = ReadStageDataset({{folder}}, "open", 0).content_sha256;
  WriteDataset(folder, "val", 3);
  const StageDataset dataset = ReadStageDataset({{folder}}, "open", 0.5);
  EXPECT_EQ(dataset.train.size(), 6U);
  EXPECT_EQ(dataset.validation.size(), 9U);
  EXPECT_NE(dataset.content_sha256, alone);
  EXPECT_THROW(ReadStageDataset({{folder / "none"}}, "open", 0), Error);
}

TEST(StageDataset, HoldsSeveralDataSetsInTheirOrder) {
  const fs::path first = EmptyDataset("first");
  const fs::path second = EmptyDataset("second");
  const auto made = WriteDataset(first, "train", 4);
  WriteDataset(second, "train", 2);
  const StageDataset dataset = ReadStageDataset({{second, first}}, "open", 0.5);
  ASSERT_EQ(dataset.train.size(), 9U);  // halves of 2 and 4 episodes of 3 decisions
  EXPECT_EQ(dataset.validation.size(), 9U);
  EXPECT_EQ(dataset.train[5].action, made.samples[2].action);
  EXPECT_EQ(dataset.parts.bodies.size(), 2U);
  EXPECT_EQ(dataset.parts.handles.size(), 1U);
  EXPECT_NE(dataset.content_sha256,
            ReadStageDataset({{first, second}}, "open", 0.5).content_sha256);
  EXPECT_THROW(ReadStageDataset({}, "open", 0), Error);
}

int RunTrain(const std::string& arguments, const std::string& variables = {}) {
  const std::string command = variables +
                              std::string(DOORFORGE_BINARY_DIR "/bin/doorforge-train train open ") +
                              arguments + " > /dev/null 2> /dev/null";
  const int status = std::system(command.c_str());  // NOLINT: fixed program
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(TrainProgram, ResumesToTheBytesOfAnUninterruptedRun) {
  const fs::path folder = EmptyDataset("program");
  WriteDataset(folder / "data", "train", 4);
  const std::string common = "--data " + (folder / "data").string() +
                             " --epochs 2 --set batch_size=4 --set warmup_steps=1 --seed 5 --out ";
  const std::string whole = (folder / "whole").string();
  const std::string cut = (folder / "cut").string();
  ASSERT_EQ(RunTrain(common + whole + " --threads 1"), 0);
  // each run stops after its first step
  ASSERT_EQ(RunTrain(common + cut + " --threads 2 --minutes 0.00001"), 0);
  EXPECT_NE(ReadFile(cut + "/policy.safetensors"), ReadFile(whole + "/policy.safetensors"));
  EXPECT_EQ(RunTrain(common + cut), 2) << "a folder with a training is not overwritten";
  EXPECT_EQ(RunTrain(common + cut + " --resume --set learning_rate=1e-4"), 2);
  ASSERT_EQ(RunTrain(common + cut + " --threads 2 --resume"), 0);
  for (const char* file :
       {"policy.safetensors", "policy.json", "training.safetensors", "losses.jsonl", "losses.json",
        "config.yaml", "events.out.tfevents.doorforge", "best/policy.safetensors",
        "best/policy.json"})
    EXPECT_EQ(ReadFile(fs::path(cut) / file), ReadFile(fs::path(whole) / file)) << file;
}

TEST(TrainProgram, KeepsTheBestBesideTheLast) {
  const fs::path folder = EmptyDataset("best");
  WriteDataset(folder / "data", "train", 6);
  const std::string out = (folder / "out").string();
  const std::string common = "--data " + (folder / "data").string() +
                             " --set batch_size=4 --set warmup_steps=1 --threads 1 --out " + out;
  ASSERT_EQ(RunTrain(common + " --epochs 3"), 0);
  const std::vector<TrainingCurve> curves = ReadTrainingCurves(out);
  const auto validation = [&](const char* name) {
    return std::ranges::find(curves, name, &TrainingCurve::name)->validation;
  };
  const TrainConfig config;
  std::vector<double> actor;
  for (std::size_t e = 0; e < 3; ++e)
    actor.push_back(config.lambda_position * validation("actor.position_m")[e] +
                    config.lambda_rotation * validation("actor.rotation_rad")[e]);
  const auto epoch_of_least = [](const std::vector<double>& errors) {
    return static_cast<int>(std::ranges::min_element(errors) - errors.begin()) + 1;
  };
  const PolicyRecord best = ReadPolicy(folder / "out/best");
  EXPECT_EQ(best.provenance.best.actor, epoch_of_least(actor));
  EXPECT_EQ(best.provenance.best.critic, epoch_of_least(validation("critic.score_rad")));
  EXPECT_EQ(ReadPolicy(out).provenance.best, BestEpochs{});
  // nothing to choose by: nothing is called the best, also not what lay there
  CommitFile(folder / "out/best/notes.txt", "a user's");
  ASSERT_EQ(RunTrain(common + " --epochs 1 --overwrite --set validation_share=0"), 0);
  EXPECT_FALSE(fs::exists(folder / "out/best/policy.json"));
  EXPECT_FALSE(fs::exists(folder / "out/best/policy.safetensors"));
  EXPECT_EQ(ReadFile(folder / "out/best/notes.txt"), "a user's");
}

TEST(TrainProgram, WritesWhatTellsForeignPicturesAndResumingAddsItWhereItIsMissing) {
  const fs::path folder = EmptyDataset("familiar");
  WriteDataset(folder / "data", "train", 8);
  const fs::path out = folder / "out";
  const std::string common = "--data " + (folder / "data").string() +
                             " --set batch_size=8 --set warmup_steps=1 --threads 1 --epochs 1 "
                             "--out " +
                             out.string();
  ASSERT_EQ(RunTrain(common), 0);
  const std::vector<fs::path> files = {out / "familiar.safetensors",
                                       out / "best/familiar.safetensors"};
  const std::string written = ReadFile(files[0]);
  const StageDataset dataset = ReadStageDataset({{folder / "data"}}, "open", 0.1);
  const auto familiarity = ReadFamiliarity(out, dataset.content_sha256, NetworkFamily::kMotion);
  ASSERT_TRUE(familiarity);
  EXPECT_EQ(familiarity->distances.size(), dataset.validation.size());
  for (const fs::path& file : files) EXPECT_TRUE(fs::remove(file)) << file;
  ASSERT_EQ(RunTrain(common + " --resume"), 0);
  for (const fs::path& file : files) EXPECT_EQ(ReadFile(file), written) << file;
  ASSERT_EQ(RunTrain(common + " --overwrite --set validation_share=0"), 0);
  EXPECT_FALSE(fs::exists(files[1])) << "of no best policy";
}

TEST(TrainProgram, TwoProcessesEndInTheBytesOfOne) {
  const fs::path folder = EmptyDataset("nodes");
  WriteDataset(folder / "data", "train", 4);
  const auto arguments = [&](const char* out) {
    return "--data " + (folder / "data").string() +
           " --epochs 1 --set batch_size=8 --threads 1 --out " + (folder / out).string();
  };
  ASSERT_EQ(RunTrain(arguments("one")), 0);
  const auto run = [&](int rank) {
    return RunTrain(
        arguments("two") + " --nodes",
        "WORLD_SIZE=2 MASTER_ADDR=127.0.0.1 MASTER_PORT=29537 RANK=" + std::to_string(rank) + " ");
  };
  int second = -1;
  {
    std::jthread other([&] { second = run(1); });
    const int first = run(0);
    if (first == 2) GTEST_SKIP() << "this build has no distributed back end";
    ASSERT_EQ(first, 0);
  }
  EXPECT_EQ(second, 0);
  for (const char* file : {"policy.safetensors", "policy.json", "training.safetensors"})
    EXPECT_EQ(ReadFile(folder / "two" / file), ReadFile(folder / "one" / file)) << file;
}

ProgramAnswer RunTraining(const std::string& arguments) {
  return AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-train train " + arguments + " 2>&1");
}

void ExpectRefusal(const std::string& arguments, const std::string& reason) {
  const ProgramAnswer answer = RunTraining(arguments);
  EXPECT_EQ(answer.code, 3) << answer.text;
  EXPECT_NE(answer.text.find(reason), std::string::npos) << answer.text;
}

TEST(TrainProgram, RefusesShardsOfAnotherStageOrVersion) {
  const fs::path folder = EmptyDataset("other");
  const std::string data = (folder / "data").string();
  const std::string common = " --data " + data + " --out " + (folder / "out").string();
  WriteDataset(data, "train", 2);
  ExpectRefusal("handle" + common, "handle/train: no such part of a dataset; it holds open/train");
  fs::rename(folder / "data/open", folder / "data/handle");
  ExpectRefusal("handle" + common, "a shard of the stage \"open\" among those of \"handle\"");
  fs::rename(folder / "data/handle", folder / "data/open");
  const fs::path index = folder / "data/open/train/shard-000000.index.json";
  nlohmann::ordered_json record = nlohmann::ordered_json::parse(ReadFile(index));
  record["schema_version"] = 99;
  record.erase("index_crc32c");
  CommitFile(index, record.dump());
  ExpectRefusal("open" + common,
                "version 99, this build reads doorforge.shard_index up to version 1");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(TrainProgram, NamesACorruptShardInTheMiddleAndKeepsTheCheckpoint) {
  const fs::path folder = EmptyDataset("corrupt");
  for (int shard = 0; shard < 3; ++shard) WriteDataset(folder / "data", "train", 1, shard);
  const std::string out = (folder / "out").string();
  const std::string arguments = "open --data " + (folder / "data").string() +
                                " --epochs 1 --set batch_size=4 --threads 1 --out " + out;
  ASSERT_EQ(RunTraining(arguments).code, 0);
  const std::string policy = ReadFile(out + "/policy.safetensors");
  const std::string state = ReadFile(out + "/training.safetensors");

  const fs::path tar = folder / "data/open/train/shard-000001.tar";
  std::string bytes = ReadFile(tar);
  bytes[bytes.size() / 2] ^= 4;  // one bit of a cloud
  CommitFile(tar, bytes);
  ExpectRefusal(arguments + " --resume", "shard-000001.tar: ep100000.cloud.npy");
  ExpectRefusal(arguments + " --overwrite", "shard-000001.tar");
  CommitFile(tar, bytes.substr(0, bytes.size() / 2));
  ExpectRefusal(arguments + " --resume", "shard-000001.tar");
  EXPECT_EQ(ReadFile(out + "/policy.safetensors"), policy);
  EXPECT_EQ(ReadFile(out + "/training.safetensors"), state);
}

// Writers refuse such numbers; a foreign one might not.
TEST(TrainProgram, NamesTheEpisodeWithANumberThatIsNone) {
  const fs::path folder = EmptyDataset("nan");
  const auto made = testing::MakeSyntheticSamples(11, 1);
  Episode episode;
  Decision& decision = episode.decisions.emplace_back();
  decision.cloud.xyz.assign(made.samples[0].cloud.begin(), made.samples[0].cloud.end());
  decision.cloud.label.assign(decision.cloud.xyz.size() / 3, 0);
  std::vector<MemberBytes> members = EncodeEpisode(episode, EpisodeMetaToJson(episode), "");
  for (MemberBytes& member : members) {
    const float none = std::nanf("");
    if (member.name == "score.npy")
      std::memcpy(member.bytes.data() + member.bytes.size() - sizeof none, &none, sizeof none);
  }
  ShardWriter writer(folder / "open/train", {0, "open", "train", "config"});
  writer.Add("ep000007", 1, std::move(members));
  writer.Commit();
  WriteProvenance(folder);
  ExpectRefusal("open --data " + folder.string() + " --out " + (folder / "out").string(),
                "episode ep000007: score holds a number that is not finite");
}

TEST(TrainProgram, ALossThatIsNoNumberEndsTheRunAndTheLastGoodPolicyIsKept) {
  const fs::path folder = EmptyDataset("diverged");
  WriteDataset(folder / "data", "train", 4);
  const fs::path out = folder / "out";
  TrainConfig config;
  config.epochs = 2;
  config.batch_size = 4;
  config.warmup_steps = 1;
  const StageDataset dataset =
      ReadStageDataset({{folder / "data"}}, "open", config.validation_share);
  TrainHooks hooks;
  bool epoch_done = false;
  hooks.on_epoch = [&](const TrainerState&) { epoch_done = true; };
  hooks.stop = [&] { return epoch_done; };
  const TrainerState good = TrainStage(dataset.train, dataset.validation, config, hooks);
  config.learning_rate = 1e30;  // what a run that goes wrong in its second epoch has behind it
  WriteTrainerState(out, good, {"open", dataset.content_sha256, "v", config, 0});
  const std::string state = ReadFile(out / "training.safetensors");

  const ProgramAnswer answer = RunTraining("open --data " + (folder / "data").string() +
                                           " --epochs 2 --set batch_size=4 --set warmup_steps=1 "
                                           "--set learning_rate=1e30 --resume --threads 1 --out " +
                                           out.string());
  EXPECT_EQ(answer.code, 4) << answer.text;
  EXPECT_NE(answer.text.find("is not finite; lower learning_rate"), std::string::npos)
      << answer.text;
  EXPECT_NE(answer.text.find("after step " + std::to_string(good.step)), std::string::npos)
      << answer.text;
  EXPECT_EQ(ReadFile(out / "training.safetensors"), state);
  const PolicyRecord kept = ReadPolicy(out);
  WritePolicy(folder / "good", good.networks, kept.provenance);
  EXPECT_EQ(kept.networks.actor, ReadPolicy(folder / "good").networks.actor);
  EXPECT_EQ(kept.provenance.step, good.step);
}

TEST(TrainProgram, ARefusalToGoOnNamesTheSettingsThatDifferAndTheWaysOut) {
  const fs::path folder = EmptyDataset("other_settings");
  WriteDataset(folder / "data", "train", 4);
  WriteDataset(folder / "more", "train", 5);
  const std::string out = (folder / "out").string();
  const std::string common = " --set batch_size=4 --set warmup_steps=1 --threads 1 --out " + out;
  const std::string data = "open --data " + (folder / "data").string();
  ASSERT_EQ(RunTraining(data + common + " --epochs 1").code, 0);
  const std::string state = ReadFile(out + "/training.safetensors");
  const std::string ways =
      "; give what is recorded to go on, --overwrite to begin anew, or "
      "another --out, there with --from " +
      out + " to begin with these weights\n  ";

  const ProgramAnswer longer =
      RunTraining(data + common + " --epochs 3 --set learning_rate=0.5 --resume");
  EXPECT_EQ(longer.code, 2);
  EXPECT_EQ(longer.text.substr(longer.text.find("doorforge: " + out)),
            "doorforge: " + out + "/training.safetensors: this training has other settings" + ways +
                "epochs: recorded 1, given 3\n  learning_rate: recorded 0.001, given 0.5\n");

  const ProgramAnswer other =
      RunTraining("open --data " + (folder / "more").string() + common + " --epochs 1 --resume");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.text.find("this training has other data than --data" + ways + "sha256: "),
            std::string::npos)
      << other.text;
  EXPECT_EQ(ReadFile(out + "/training.safetensors"), state);
}

TEST(TrainProgram, RefusesAbsurdPlacesInAGroup) {
  const fs::path folder = EmptyDataset("places");
  fs::create_directories(folder);
  const std::string use = "--nodes --data " + folder.string() + " --out " + (folder / "o").string();
  const std::string place = "MASTER_ADDR=127.0.0.1 MASTER_PORT=29538 ";
  EXPECT_EQ(RunTrain(use, "env -u RANK "), 2);
  EXPECT_EQ(RunTrain(use, place + "WORLD_SIZE=3 RANK=0 "), 2) << "not a power of two";
  EXPECT_EQ(RunTrain(use, place + "WORLD_SIZE=2 RANK=2 "), 2);
  EXPECT_EQ(RunTrain(use, place + "WORLD_SIZE=2x RANK=0 "), 2);
}

TEST(TrainProgram, RefusesWrongUse) {
  const fs::path folder = EmptyDataset("use");
  fs::create_directories(folder);
  EXPECT_EQ(RunTrain("--out x"), 2);
  EXPECT_EQ(RunTrain("--data " + folder.string() + " --out " + (folder / "o").string()), 3);
  EXPECT_EQ(
      RunTrain("--data " + folder.string() + " --set batchsize=3 --out " + (folder / "o").string()),
      2);
  EXPECT_FALSE(fs::exists(folder / "o"));
}

}  // namespace
}  // namespace doorforge
