// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/training_curves.h"
#include "doorforge/schemas/safetensors.h"
#include "doorforge/training/loss_files.h"
#include "doorforge/training/trainer_state_file.h"

#include "synthetic_samples.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

fs::path EmptyFolder(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("doorforge_checkpoint_" + name);
  fs::remove_all(folder);
  return folder;
}

TrainerState SomeState() {
  const auto made = testing::MakeSyntheticSamples(1, 3);
  TrainerState state;
  state.networks = InitialNetworks(MeasureNormalisation(made.samples), false, 9);
  state.step = 2;
  state.actor_first_moment.assign(ActorLayout().size(), 0.25F);
  state.actor_second_moment.assign(ActorLayout().size(), 0.5F);
  state.critic_first_moment.assign(CriticLayout().size(), -1.0F);
  state.critic_second_moment.assign(CriticLayout().size(), 1e-20F);
  state.steps = {{0.1, 0.2, 0.3, 0.4}, {0.01, 1.0 / 3, 0.03, 0.04}};
  state.epochs = {{{0.055, 0.25, 0.165, 0.22}, {}}};
  state.best = {{0, 1}, state.networks};
  state.best.networks.actor.clear();
  state.best.networks.critic[3] = 0.125F;
  return state;
}

// Half precision has 11 bits; below 6.1e-5 steps of 6.0e-8.
void ExpectRounded(const std::vector<float>& found, const std::vector<float>& exact) {
  ASSERT_EQ(found.size(), exact.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_LE(std::abs(found[i] - exact[i]),
              std::max(std::ldexp(std::abs(exact[i]), -11), 3.0e-8F));
}

void ExpectError(ErrorCode code, const std::string& part, const std::function<void()>& call) {
  try {
    call();
    FAIL() << "no error; expected: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Checkpoint, APolicyComesBackAsItWasWritten) {
  const fs::path folder = EmptyFolder("policy");
  const TrainerState state = SomeState();
  TrainConfig config;
  config.epochs = 3;
  const SeenParts parts{{{"body", "b", {}}}, {{"handle", "h", {}}, {"knob", "k", {}}}};
  const PolicyProvenance provenance{"open", "abc", "0.1.0+test", config, 77, "def", parts};
  WritePolicy(folder, state.networks, provenance);
  const PolicyRecord record = ReadPolicy(folder);
  ExpectRounded(record.networks.actor, state.networks.actor);
  ExpectRounded(record.networks.critic, state.networks.critic);
  EXPECT_EQ(record.provenance.from_weights_sha256, "def");
  ASSERT_EQ(record.provenance.trained_on.handles.size(), 2U);
  EXPECT_EQ(record.provenance.trained_on.handles[1].sha256, "k");
  EXPECT_EQ(record.networks.normalisation.state.deviation,
            state.networks.normalisation.state.deviation);
  EXPECT_EQ(record.networks.normalisation.cloud_centre_m,
            state.networks.normalisation.cloud_centre_m);
  EXPECT_EQ(record.provenance.dataset_sha256, "abc");
  EXPECT_EQ(record.provenance.step, 77U);
  EXPECT_EQ(record.provenance.config.epochs, 3);
  EXPECT_EQ(record.weights_sha256, Sha256OfFile(folder / "policy.safetensors"));

  const std::string before = ReadFile(folder / "policy.json");
  WritePolicy(folder, record.networks, record.provenance);
  EXPECT_EQ(ReadFile(folder / "policy.json"), before);
}

TEST(Checkpoint, WhatTheNetworksAreToldComesBackAndIsWhatItWasInEarlierRecords) {
  const auto made = testing::MakeSyntheticSamples(1, 3);
  const NetworkView view{ViewFrame::kHand, StateKind::kNone, 0.25F, 4, 0.5F};
  auto json = NormalisationToJson(MeasureNormalisation(made.samples, view));
  EXPECT_EQ(NormalisationFromJson(json, "policy.json").view, view);
  json["state_of"] = "elsewhere";
  ExpectError(ErrorCode::kFormat, "policy.json.state_of",
              [&] { NormalisationFromJson(json, "policy.json"); });
  for (const char* key : {"frame", "state_of", "context_m", "zoom", "cloud_within_m"})
    json.erase(key);
  EXPECT_EQ(NormalisationFromJson(json, "policy.json").view,
            (NetworkView{ViewFrame::kWorld, StateKind::kJoints, 0, 1, 0}));
}

TEST(Checkpoint, ColoursOnAnotherScaleAreNotThoseThatThePolicyLearned) {
  const auto made = testing::MakeSyntheticSamples(1, 3);
  NetworkView view;
  view.colors = true;
  auto json = NormalisationToJson(MeasureNormalisation(made.samples, view));
  EXPECT_TRUE(NormalisationFromJson(json, "policy.json").view.colors);
  json.erase("color_scale");  // as in the first policies with colours
  ExpectError(ErrorCode::kFormat, "policy.json.color_scale",
              [&] { NormalisationFromJson(json, "policy.json"); });
}

TEST(Checkpoint, AGraspComesBackAsItWasWrittenAndIsNoOtherStagesPolicy) {
  const fs::path folder = EmptyFolder("grasp");
  const auto made = testing::MakeSyntheticSamples(1, 3);
  const StageNetworks networks =
      InitialNetworks(MeasureNormalisation(made.samples), false, 9, NetworkFamily::kGrasp);
  TrainConfig config;
  config.family = NetworkFamily::kGrasp;
  config.sampled_points = 7;
  WritePolicy(folder, networks, {"grasp", "abc", "0.1.0+test", config, 77});
  const PolicyRecord record = ReadPolicy(folder, "grasp");
  EXPECT_EQ(record.networks.family, NetworkFamily::kGrasp);
  ExpectRounded(record.networks.actor, networks.actor);
  ExpectRounded(record.networks.critic, networks.critic);
  EXPECT_EQ(record.provenance.config.sampled_points, 7);
  const std::string weights = ReadFile(folder / "policy.safetensors");
  EXPECT_NE(weights.find("\"discriminator.action.2.weight\""), std::string::npos);
  EXPECT_NE(weights.find("\"affordance.point.0.weight\""), std::string::npos);
  ExpectError(ErrorCode::kFormat, "of the stage \"grasp\", where one of the stage \"open\"",
              [&] { ReadPolicy(folder); });
}

TEST(Checkpoint, WeightsOfAnotherNetworkAreRefusedAlsoWhereTheirHashIsTheRecords) {
  const fs::path folder = EmptyFolder("network");
  const auto made = testing::MakeSyntheticSamples(1, 3);
  const StageNormalisation normalisation = MeasureNormalisation(made.samples);
  TrainConfig config;
  config.family = NetworkFamily::kGrasp;
  WritePolicy(folder / "grasp", InitialNetworks(normalisation, false, 9, config.family),
              {"grasp", "abc", "v", config, 1});
  WritePolicy(folder / "open", SomeState().networks, {"open", "abc", "v", {}, 1});
  const std::string own = Sha256OfFile(folder / "open/policy.safetensors");
  CommitFile(folder / "open/policy.safetensors", ReadFile(folder / "grasp/policy.safetensors"));
  std::string record = ReadFile(folder / "open/policy.json");
  record.replace(record.find(own), own.size(), Sha256OfFile(folder / "open/policy.safetensors"));
  CommitFile(folder / "open/policy.json", record);
  ExpectError(ErrorCode::kFormat, "policy.safetensors: ", [&] { ReadPolicy(folder / "open"); });
  ExpectError(ErrorCode::kFormat, "actor.", [&] { ReadPolicy(folder / "open"); });
}

// Takes tensors away from a policy's file and lets its record name what is left.
void WithoutTensors(const fs::path& folder, std::initializer_list<const char*> prefixes) {
  const fs::path path = folder / "policy.safetensors";
  TensorFile file = DecodeTensors(ReadFile(path), path.string());
  for (const char* prefix : prefixes)
    std::erase_if(file.tensors, [&](const auto& t) { return t.first.starts_with(prefix); });
  std::string record = ReadFile(folder / "policy.json");
  const std::string own = Sha256OfFile(path);
  CommitFile(path, EncodeTensors(file));
  record.replace(record.find(own), own.size(), Sha256OfFile(path));
  CommitFile(folder / "policy.json", record);
}

TEST(Checkpoint, AMotionMayBeWithoutThePosteriorThatTrainingAloneReads) {
  const fs::path folder = EmptyFolder("posterior");
  const StageNetworks networks = SomeState().networks;
  WritePolicy(folder / "open", networks, {"open", "abc", "v", {}, 1});
  const StageNetworks whole = ReadPolicy(folder / "open").networks;
  WithoutTensors(folder / "open",
                 {"actor.action.", "actor.posterior.", "actor.mean.", "actor.log_variance."});
  const StageNetworks slim = ReadPolicy(folder / "open").networks;
  const StageNetworks untrained =
      InitialNetworks(whole.normalisation, whole.linear_branches, 0, whole.family);
  EXPECT_EQ(slim.critic, whole.critic);
  for (const DenseLayer& layer : whole.actor_layout().layers()) {
    const bool acts = layer.name.starts_with("encoder.") || layer.name.starts_with("state.") ||
                      layer.name.starts_with("decoder.");
    const std::vector<float>& expected = acts ? whole.actor : untrained.actor;
    for (std::size_t i = layer.offset; i < layer.bias_offset() + layer.outputs; ++i) {
      const float rounding = std::max(std::ldexp(std::abs(expected[i]), -11), 3.0e-8F);
      ASSERT_NEAR(slim.actor[i], expected[i], rounding) << layer.name;
    }
  }
}

TEST(Checkpoint, HalfAPosteriorIsRefused) {
  const fs::path folder = EmptyFolder("half_posterior");
  WritePolicy(folder, SomeState().networks, {"open", "abc", "v", {}, 1});
  WithoutTensors(folder, {"actor.posterior.", "actor.mean."});
  ExpectError(ErrorCode::kFormat, "actor.posterior.0.weight", [&] { ReadPolicy(folder); });
}

TEST(Checkpoint, DamagedPoliciesAreRefused) {
  const fs::path folder = EmptyFolder("damaged");
  ExpectError(ErrorCode::kMissing, "policy.json", [&] { ReadPolicy(folder); });
  WritePolicy(folder, SomeState().networks, {"open", "abc", "v", {}, 1});
  std::string weights = ReadFile(folder / "policy.safetensors");
  weights[weights.size() / 2] ^= 1;
  CommitFile(folder / "policy.safetensors", weights);
  ExpectError(ErrorCode::kFormat, "SHA-256", [&] { ReadPolicy(folder); });
  std::string record = ReadFile(folder / "policy.json");
  record.replace(record.find("\"mean\""), 6, "\"men\" ");
  CommitFile(folder / "policy.json", record);
  ExpectError(ErrorCode::kFormat, "mean", [&] { ReadPolicy(folder); });
}

TEST(Checkpoint, ATrainingStateComesBackExactly) {
  const fs::path folder = EmptyFolder("state");
  EXPECT_FALSE(HasTrainerState(folder));
  const TrainerState state = SomeState();
  const PolicyProvenance provenance{"open", "abc", "v", {}, 0};
  WriteTrainerState(folder, state, provenance);
  const TrainerState back = ReadTrainerState(folder, provenance);
  EXPECT_EQ(back.step, state.step);
  EXPECT_EQ(back.networks.actor, state.networks.actor);
  EXPECT_EQ(back.networks.normalisation.action.mean, state.networks.normalisation.action.mean);
  EXPECT_EQ(back.actor_first_moment, state.actor_first_moment);
  EXPECT_EQ(back.actor_second_moment, state.actor_second_moment);
  EXPECT_EQ(back.critic_first_moment, state.critic_first_moment);
  EXPECT_EQ(back.critic_second_moment, state.critic_second_moment);
  EXPECT_EQ(back.best.epochs, (BestEpochs{0, 1}));
  EXPECT_TRUE(back.best.networks.actor.empty());
  EXPECT_EQ(back.best.networks.critic, state.best.networks.critic);
  EXPECT_EQ(back.steps[1].rotation_rad, 1.0 / 3);
  EXPECT_FALSE(back.epochs[0].validation.divergence.has_value());
}

TEST(Checkpoint, AStateOfAnotherRunIsNotResumed) {
  const fs::path folder = EmptyFolder("other");
  PolicyProvenance provenance{"open", "abc", "v", {}, 0};
  WriteTrainerState(folder, SomeState(), provenance);
  provenance.dataset_sha256 = "def";
  ExpectError(ErrorCode::kInvalidArgument, "sha256: recorded abc, given def",
              [&] { ReadTrainerState(folder, provenance); });
  provenance.dataset_sha256 = "abc";
  provenance.from_weights_sha256 = "123";
  ExpectError(ErrorCode::kInvalidArgument, "weights: recorded none, given those of sha256 123",
              [&] { ReadTrainerState(folder, provenance); });
  provenance.from_weights_sha256 = "";
  provenance.config.learning_rate = 2e-3;
  ExpectError(ErrorCode::kInvalidArgument, "learning_rate: recorded 0.001, given 0.002",
              [&] { ReadTrainerState(folder, provenance); });
}

TEST(Checkpoint, ADamagedStateIsNotGoneOnFrom) {
  const fs::path folder = EmptyFolder("damaged");
  const PolicyProvenance provenance{"open", "abc", "v", {}, 0};
  WriteTrainerState(folder, SomeState(), provenance);
  const fs::path file = folder / "training.safetensors";
  const std::string sound = ReadFile(file);
  for (const double place : {0.3, 0.5, 0.7, 0.9, 0.999}) {
    std::string damaged = sound;
    const auto at = static_cast<std::size_t>(place * static_cast<double>(sound.size()));
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    CommitFile(file, damaged);
    ExpectError(ErrorCode::kFormat, "training.safetensors",
                [&] { ReadTrainerState(folder, provenance); });
  }
  CommitFile(file, sound);
  EXPECT_EQ(ReadTrainerState(folder, provenance).step, SomeState().step);
}

TEST(Checkpoint, TheGraspsLossesHaveTheirOwnNamesAndGapsUntilTheyAreKnown) {
  const fs::path folder = EmptyFolder("grasp_losses");
  TrainerState state = SomeState();
  state.networks.family = NetworkFamily::kGrasp;
  state.steps = {StageLosses{}, StageLosses{}};
  state.steps[0].angle_gain_rad = 0.5;
  state.steps[1].angle_gain_rad = 0.25;
  state.steps[1].affordance_rad = 0.125;
  TrainConfig config;
  config.family = NetworkFamily::kGrasp;
  config.epochs = 1;
  config.warmup_steps = 0;
  WriteLosses(folder, state, {config, 1});  // each network has its own schedule
  EXPECT_EQ(ReadFile(folder / "losses.jsonl"),
            "{\"step\": 1, \"epoch\": 1, \"learning_rate\": 0.001, "
            "\"discriminator.score_rad\": 0.5}\n"
            "{\"step\": 2, \"epoch\": 2, \"learning_rate\": 0.001, "
            "\"discriminator.score_rad\": 0.25, \"affordance.score_rad\": 0.125}\n");
}

TEST(Checkpoint, LossCurvesAreWrittenForPeopleAndPrograms) {
  const fs::path folder = EmptyFolder("losses");
  TrainConfig config;
  config.epochs = 1;
  config.warmup_steps = 4;
  config.schedule = RateSchedule::kConstant;
  WriteLosses(folder, SomeState(), {config, 2});
  EXPECT_EQ(ReadFile(folder / "losses.jsonl"),
            "{\"step\": 1, \"epoch\": 1, \"learning_rate\": 0.00025, \"actor.position_m\": 0.1, "
            "\"actor.rotation_rad\": 0.2, "
            "\"actor.divergence\": 0.3, \"critic.score_rad\": 0.4}\n"
            "{\"step\": 2, \"epoch\": 1, \"learning_rate\": 0.0005, \"actor.position_m\": 0.01, "
            "\"actor.rotation_rad\": 0.333333333, "
            "\"actor.divergence\": 0.03, \"critic.score_rad\": 0.04}\n");
  const std::vector<TrainingCurve> curves = ReadTrainingCurves(folder);
  ASSERT_EQ(curves.size(), 4U);
  EXPECT_EQ(curves[1].name, "actor.rotation_rad");
  EXPECT_EQ(curves[1].epoch, std::vector<double>{1});
  EXPECT_EQ(curves[1].train, std::vector<double>{0.25});
  EXPECT_TRUE(std::isnan(curves[1].validation[0]));
}

}  // namespace
}  // namespace doorforge
