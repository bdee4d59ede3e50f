// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/batch_norm.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/training/train_stage.h"
#include "doorforge/training/trainer_state_file.h"

#include "device_encoder.h"
#include "door_cloud.h"
#include "encoder_checks.h"
#include "reference_network.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

// Two clouds through an encoder with normalised layers, of whose features some are read.
class NormalisedEncoder : public ::testing::Test {
 protected:
  NormalisedEncoder() {
    AddEncoderLayers("encoder.", layout_, {EncoderNorm::kBatch});
    AddEncoderLayers("", reference_layout_, {EncoderNorm::kBatch});
    AddEncoderLayers("", plain_layout_);
    parameters_ = HeInitialisation(layout_, 3, "");
    Rng rng(3, "test/norm");
    for (std::size_t i = 0; i < layout_.layers().size(); ++i) {
      const DenseLayer* norm = NormBehind(layout_, i);
      if (norm == nullptr) continue;
      // scales and shifts that are neither 1 nor 0, so that their use is seen
      for (std::size_t k = norm->offset; k < norm->bias_offset(); ++k)
        parameters_[k] = static_cast<float>(rng.Uniform(0.5, 1.5));
      for (std::size_t k = norm->bias_offset(); k < norm->end(); ++k)
        parameters_[k] = static_cast<float>(rng.Uniform(-0.3, 0.3));
    }
    for (const std::vector<float>& cloud : clouds_)
      geometries_.push_back(std::make_shared<const CloudGeometry>(
          BuildWholeGeometry(cloud, {testing::kCloudCentre}, read_, BestInstructionSet())));
    Rng draws(5, "test/wanted");
    wanted_.resize(clouds_.size() * read_.size() * kFeatureSize);
    for (float& w : wanted_) w = static_cast<float>(draws.Uniform(0.1, 1));
  }

  // The reference reads all points: what is wanted of the others is 0.
  testing::ReferenceNetwork::Result Expected() const {
    testing::ReferenceNetwork reference(reference_layout_, parameters_, clouds_,
                                        testing::kCloudCentre, testing::Precision::kDouble);
    std::vector<float> wanted(clouds_.size() * kCloudPoints * kFeatureSize);
    for (std::size_t row = 0; row < clouds_.size() * read_.size(); ++row)
      std::copy_n(wanted_.begin() + static_cast<std::ptrdiff_t>(row * kFeatureSize), kFeatureSize,
                  wanted.begin() + static_cast<std::ptrdiff_t>(ReferenceRow(row) * kFeatureSize));
    return reference.Run(wanted);
  }

  std::size_t ReferenceRow(std::size_t row) const {
    return row / read_.size() * kCloudPoints + read_[row % read_.size()];
  }

  std::vector<std::uint16_t> read_ = {0, 77, 4095};
  std::vector<std::vector<float>> clouds_ = {testing::DoorCloud(1, 0.3),
                                             testing::DoorCloud(2, 0.9)};
  ParameterLayout layout_, reference_layout_, plain_layout_;
  std::vector<float> parameters_;
  internal::Geometries geometries_;
  std::vector<float> wanted_;
};

TEST_F(NormalisedEncoder, GivesTheFeaturesGradientsAndStatisticsOfTheFormula) {
  const auto expected = Expected();
  internal::DeviceEncoder encoder(layout_, parameters_, "libtorch", /*in_double=*/true);
  const std::vector<float> features = encoder.Forward(geometries_, true);
  ASSERT_EQ(features.size(), wanted_.size());
  for (std::size_t i = 0; i < features.size(); ++i)
    ASSERT_NEAR(features[i],
                expected.features[ReferenceRow(i / kFeatureSize) * kFeatureSize + i % kFeatureSize],
                1e-5);
  const LayerStatistics statistics = encoder.Statistics();
  ASSERT_EQ(statistics.mean.size(), expected.mean.size());
  for (std::size_t i = 0; i < expected.mean.size(); ++i) {
    const double rows = expected.rows[i];
    const double unbiased = static_cast<double>(expected.variance[i]) * rows / (rows - 1);
    ASSERT_NEAR(statistics.mean[i], expected.mean[i], 1e-5);
    ASSERT_NEAR(statistics.variance[i], unbiased, 1e-5 * (1 + unbiased));
  }
  std::vector<float> gradient(parameters_.size());
  encoder.AddGradient(wanted_, gradient);
  for (const DenseLayer& layer : layout_.layers()) {
    const auto part = [&](const std::vector<float>& all) {
      return std::span(all).subspan(layer.offset, layer.end() - layer.offset);
    };
    EXPECT_LT(testing::RelativeDistance(part(expected.gradient), part(gradient)), 1e-5)
        << layer.name;
  }
}

// With the statistics of the batch itself, what is folded gives what the batch gave.
TEST_F(NormalisedEncoder, FoldedIntoTheWeightsItIsThePlainNetwork) {
  const auto expected = Expected();
  const std::vector<float> folded =
      FoldNorms(layout_, parameters_, {expected.mean, expected.variance});
  ASSERT_EQ(folded.size(), plain_layout_.size());
  const PointEncoder plain(plain_layout_, "", folded, BestInstructionSet());
  for (std::size_t c = 0; c < clouds_.size(); ++c) {
    const std::vector<float> features =
        plain
            .Forward(
                BuildGeometry(clouds_[c], {testing::kCloudCentre}, read_, BestInstructionSet()))
            .features;
    ASSERT_EQ(features.size(), read_.size() * kFeatureSize);
    for (std::size_t r = 0; r < read_.size(); ++r) {
      const std::size_t row = ReferenceRow(c * read_.size() + r);
      EXPECT_LT(testing::RelativeDistance(
                    std::span(expected.features).subspan(row * kFeatureSize, kFeatureSize),
                    std::span(features).subspan(r * kFeatureSize, kFeatureSize)),
                1e-4);  // single precision through 22 layers
    }
  }
  EXPECT_EQ(FoldNorms(plain_layout_, folded, {}), folded);
}

TEST(WholeGeometry, LeavesNothingOfTheWindowOut) {
  const std::vector<float> cloud = testing::DoorCloud(7, 0.1);
  const std::vector<std::uint16_t> read = {0, 5};
  for (const float radius_m : {0.0F, 0.5F}) {
    const CloudGeometry whole =
        BuildWholeGeometry(cloud, {testing::kCloudCentre, radius_m}, read, BestInstructionSet());
    EXPECT_EQ(whole.upsampling[0].size(), whole.xyz.size() / 3);
    for (std::size_t l = 0; l < 4; ++l) {
      EXPECT_EQ(whole.levels[l].size(), static_cast<std::size_t>(kSetAbstractions[l].points));
    }
    for (std::size_t l = 0; l < 3; ++l)
      EXPECT_EQ(whole.upsampling[l + 1].size(), whole.levels[l].size());
    ASSERT_EQ(whole.read.size(), 2U);
    EXPECT_EQ(whole.read[0], 0);
    EXPECT_EQ(whole.xyz.size() / 3 < static_cast<std::size_t>(kCloudPoints), radius_m > 0);
  }
}

TEST(LayerStatistics, MoveByATenth) {
  LayerStatistics running{{1.0F}, {2.0F}};
  MoveTowards({{11.0F}, {2.5F}}, running);
  EXPECT_FLOAT_EQ(running.mean[0], 2.0F);
  EXPECT_FLOAT_EQ(running.variance[0], 2.05F);
}

TrainConfig NormalisedConfig() {
  TrainConfig config;
  config.epochs = 1;
  config.batch_size = 4;
  config.warmup_steps = 2;
  config.encoder_norm = EncoderNorm::kBatch;
  return config;
}

TEST(TrainWithBatchNorm, GivesTheSameBitsForAnyNumberOfThreadsAndAnyInterruption) {
  const auto train = testing::MakeSyntheticSamples(1, 6);
  const auto validation = testing::MakeSyntheticSamples(2, 2);
  TrainConfig config = NormalisedConfig();
  config.batch_size = 2;
  TrainHooks one;
  one.threads = 1;
  const TrainerState whole = TrainStage(train.samples, validation.samples, config, one);
  EXPECT_EQ(whole.step, 3U);
  EXPECT_NE(whole.actor_statistics.mean,
            InitialStatistics(ActorLayout(config.family, {EncoderNorm::kBatch})).mean);

  TrainHooks hooks;
  hooks.threads = 2;
  hooks.stop = [count = 0]() mutable { return ++count == 2; };
  const TrainerState stopped = TrainStage(train.samples, validation.samples, config, hooks);
  const auto folder = std::filesystem::path(::testing::TempDir()) / "doorforge_batch_norm";
  std::filesystem::remove_all(folder);
  const PolicyProvenance provenance{"open", "abc", "v", config, 2};
  WriteTrainerState(folder, stopped, provenance);
  hooks.stop = nullptr;
  hooks.resume = ReadTrainerState(folder, provenance);
  const TrainerState resumed = TrainStage(train.samples, validation.samples, config, hooks);
  EXPECT_EQ(resumed.networks.actor, whole.networks.actor);
  EXPECT_EQ(resumed.networks.critic, whole.networks.critic);
  EXPECT_EQ(resumed.actor_statistics.mean, whole.actor_statistics.mean);
  EXPECT_EQ(resumed.critic_statistics.variance, whole.critic_statistics.variance);
  EXPECT_EQ(resumed.epochs[0].validation.rotation_rad, whole.epochs[0].validation.rotation_rad);

  // what acts has no normalised layers, and only that is written
  EXPECT_THROW(WritePolicy(folder, whole.networks, provenance), Error);
  WritePolicy(folder, PolicyOf(whole), provenance);
  EXPECT_EQ(ReadPolicy(folder).networks.actor.size(), ActorLayout().size());
}

TEST(TrainWithBatchNorm, RefusesWhatItCannotDo) {
  const auto train = testing::MakeSyntheticSamples(1, 4);
  TrainConfig config = NormalisedConfig();
  TrainHooks hooks;
  hooks.initial = InitialNetworks(MeasureNormalisation(train.samples), false, 1);
  hooks.initial->normalisation.view.frame = ViewFrame::kHand;
  hooks.initial->normalisation.view.state = StateKind::kHand;
  try {
    TrainStage(train.samples, {}, config, hooks);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("folded"), std::string::npos) << error.what();
  }
  class Two : public ProcessGroup {
   public:
    int rank() const override { return 0; }
    int size() const override { return 2; }
    std::vector<float> Gather(std::span<const float> mine) override {
      return {mine.begin(), mine.end()};
    }
    void Sum(std::span<float>) override {}
  } two;
  hooks.initial.reset();
  hooks.group = &two;
  EXPECT_THROW(TrainStage(train.samples, {}, config, hooks), Error);
}

}  // namespace
}  // namespace doorforge
