// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The grasp stage on a world of our own: a grasp opens the door where it takes hold of the upper
// half of the handle, with the fingers closing upright.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/orientation_sampling.h"
#include "doorforge/training/train_stage.h"

namespace doorforge {
namespace {

const Eigen::Vector3d kApproach(-1, 0, 0);

TEST(OrientationSampling, IsOrthonormalAndClosesTheFingersInThePlaneNormalToTheApproach) {
  const Eigen::Vector3d axis = Eigen::Vector3d(-2, 0.3, 0.1);
  Rng rng(1, "test");
  for (const Eigen::Matrix3d& r : SampleOrientations(axis, {200, 0}, rng)) {
    EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(r.determinant(), 1, 1e-12);
    EXPECT_LT((r.col(2) - axis.normalized()).norm(), 1e-12);
    EXPECT_NEAR(r.col(1).dot(axis), 0, 1e-12);
  }
  EXPECT_THROW(SampleOrientations(Eigen::Vector3d::Zero(), {}, rng), Error);
}

TEST(OrientationSampling, TurnsEvenlyAndTiltsAsAskedFor) {
  constexpr int kCount = 4000;
  Rng rng(2, "test");
  std::array<int, 8> sectors{};
  double tilt_squared = 0;
  for (const Eigen::Matrix3d& r : SampleOrientations(kApproach, {kCount, 0.1}, rng)) {
    const double turn = std::atan2(r(2, 1), r(1, 1)) + std::numbers::pi;
    ++sectors.at(
        static_cast<std::size_t>(std::min(7.0, std::floor(turn / (std::numbers::pi / 4)))));
    const double tilt = std::acos(std::clamp(r.col(2).dot(kApproach), -1.0, 1.0));
    tilt_squared += tilt * tilt;
  }
  // binomial, five standard deviations: 500 +- 5 * 20.9; two tilts of 0.1: mean square 0.02
  for (const int count : sectors) EXPECT_NEAR(count, kCount / 8, 105);
  EXPECT_NEAR(tilt_squared / kCount, 0.02, 0.002);
}

TEST(OrientationSampling, HalfATurnIsTheSameGraspWithTheFingersExchanged) {
  Rng rng(3, "test");
  for (const Eigen::Matrix3d& r : SampleOrientations(kApproach, {20, 0.2}, rng)) {
    const Action turned = FromVector(HalfTurned(ToVector({{1, 2, 3}, r})));
    const Eigen::Matrix3d expected =
        r * RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi).linear();
    EXPECT_LT((turned.world_from_hand_rotation - expected).norm(), 1e-5);
    EXPECT_EQ(turned.position_delta_m, Eigen::Vector3d(1, 2, 3));
  }
}

// A leaf with an upright bar of a handle at a place of its own.
struct GraspWorld {
  explicit GraspWorld(std::uint64_t seed) {
    Rng rng(seed, "test/grasp_world");
    handle_y = rng.Uniform(-0.2, 0.2);
    for (int i = 0; i < kCloudPoints; ++i) {
      const bool handle = i < kCloudPoints / 16;
      const double y = handle ? handle_y + rng.Uniform(-0.01, 0.01) : rng.Uniform(-0.5, 0.5);
      const double z = handle ? handle_z + rng.Uniform(-0.1, 0.1) : rng.Uniform(0.2, 1.9);
      for (const double v : {handle ? 0.05 : 0.0, y, z})
        cloud.xyz.push_back(static_cast<float>(v + 0.001 * rng.Normal()));
      cloud.label.push_back(handle ? 1 : 0);
    }
  }

  Eigen::Vector3d Point(std::size_t i) const {
    return Eigen::Vector3f(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2])
        .cast<double>();
  }

  // 0.8 rad, or nothing.
  float Angle(const Eigen::Vector3d& contact, const Eigen::Matrix3d& rotation) const {
    const bool opens = contact.z() > handle_z && std::abs(rotation(2, 1)) > 0.7;
    return opens ? 0.8F : 0.0F;
  }

  // The cloud with the point nearest to `start` first.
  LabelledCloud From(const Eigen::Vector3d& start) const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < cloud.label.size(); ++i)
      if ((Point(i) - start).norm() < (Point(nearest) - start).norm()) nearest = i;
    LabelledCloud sampled = cloud;
    for (std::size_t k = 0; k < 3; ++k) std::swap(sampled.xyz[k], sampled.xyz[3 * nearest + k]);
    std::swap(sampled.label[0], sampled.label[nearest]);
    return sampled;
  }

  double handle_y = 0;
  double handle_z = 1;
  LabelledCloud cloud;
};

struct GraspSamples {
  std::vector<LabelledCloud> clouds;
  std::vector<TrainingSample> samples;
};

GraspSamples MakeGraspSamples(std::uint64_t seed, std::size_t count) {
  GraspSamples made;
  Rng rng(seed, "test/grasp_samples");
  for (std::size_t i = 0; i < count; ++i) {
    const GraspWorld world(1000 * seed + i);
    const Eigen::Vector3d contact = world.Point(rng.Index(kCloudPoints / 16));
    const Eigen::Matrix3d rotation = SampleOrientations(kApproach, {1, 0.1}, rng).front();
    made.clouds.push_back(world.From(contact));
    TrainingSample sample;
    sample.action = ToVector({contact, rotation});
    sample.angle_gain_rad = world.Angle(contact, rotation);
    sample.approach = {-1, 0, 0};
    made.samples.push_back(sample);
  }
  for (std::size_t i = 0; i < count; ++i) {
    made.samples[i].cloud = made.clouds[i].xyz;
    made.samples[i].label = made.clouds[i].label;
  }
  return made;
}

TrainConfig GraspConfig() {
  TrainConfig config;
  config.family = NetworkFamily::kGrasp;
  config.batch_size = 16;
  config.warmup_steps = 5;
  config.sampled_points = 3;
  config.sampled_orientations = 12;
  config.best_orientations = 3;
  return config;
}

TEST(TrainGrasp, GivesTheSameBitsForAnyNumberOfThreadsAndInterruptionsInBothPhases) {
  const GraspSamples train = MakeGraspSamples(1, 16);
  const GraspSamples validation = MakeGraspSamples(2, 2);
  TrainConfig config = GraspConfig();
  config.epochs = 2;
  config.batch_size = 8;
  config.augment_roll_rad = 0.4;
  config.augment_mirror = true;
  TrainHooks hooks;
  hooks.threads = 1;
  const TrainerState whole = TrainStage(train.samples, validation.samples, config, hooks);
  EXPECT_EQ(whole.step, 8U);
  ASSERT_EQ(whole.epochs.size(), 4U);
  EXPECT_FALSE(whole.epochs[1].validation.affordance_rad.has_value());
  EXPECT_TRUE(whole.epochs[2].validation.affordance_rad.has_value());
  EXPECT_EQ(whole.epochs[3].validation.angle_gain_rad, whole.epochs[1].validation.angle_gain_rad);
  for (const int stop_after : {1, 7}) {
    TrainHooks stopped;
    stopped.threads = 2;
    stopped.geometry_cache_bytes = 0;
    stopped.stop = [stop_after, count = 0]() mutable { return ++count == stop_after; };
    TrainHooks resumed;
    resumed.threads = 2;
    resumed.resume = TrainStage(train.samples, validation.samples, config, stopped);
    const TrainerState state = TrainStage(train.samples, validation.samples, config, resumed);
    EXPECT_EQ(state.networks.actor, whole.networks.actor) << stop_after;
    EXPECT_EQ(state.networks.critic, whole.networks.critic) << stop_after;
    EXPECT_EQ(state.actor_second_moment, whole.actor_second_moment) << stop_after;
    EXPECT_EQ(state.epochs[3].validation.affordance_rad, whole.epochs[3].validation.affordance_rad);
  }
}

TEST(TrainGrasp, GivesTheSameBitsWithNormalisedLayersInBothPhases) {
  const GraspSamples train = MakeGraspSamples(1, 4);
  const GraspSamples validation = MakeGraspSamples(2, 1);
  TrainConfig config = GraspConfig();
  config.epochs = 1;
  config.batch_size = 2;
  config.near_points = 0;
  config.augment_mirror = true;
  config.encoder_norm = EncoderNorm::kBatch;
  const TrainerState whole = TrainStage(train.samples, validation.samples, config, {});
  EXPECT_EQ(whole.step, 4U);
  EXPECT_NE(whole.actor_statistics.mean, whole.critic_statistics.mean);
  TrainHooks hooks;
  hooks.stop = [count = 0]() mutable { return ++count == 3; };
  hooks.resume = TrainStage(train.samples, validation.samples, config, hooks);
  hooks.stop = nullptr;
  const TrainerState state = TrainStage(train.samples, validation.samples, config, hooks);
  EXPECT_EQ(state.networks.actor, whole.networks.actor);
  EXPECT_EQ(state.actor_statistics.variance, whole.actor_statistics.variance);
  EXPECT_EQ(state.epochs[1].validation.affordance_rad, whole.epochs[1].validation.affordance_rad);
}

// Asked again it chooses the same, and others where that does not fit or has failed.
void ExpectOtherChoices(GraspPolicy& policy, const GraspObservation& view,
                        const GraspAction& choice, const GraspWorld& world) {
  const auto again = policy.Choose(view);
  EXPECT_EQ(again->contact_m, choice.contact_m);
  EXPECT_EQ(again->world_from_hand_rotation, choice.world_from_hand_rotation);
  GraspObservation narrow = view;
  narrow.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
    return contact_m != choice.contact_m && rotation != choice.world_from_hand_rotation;
  };
  const auto other = policy.Choose(narrow);
  EXPECT_TRUE(narrow.fits(other->contact_m, other->world_from_hand_rotation));
  narrow.fits = [](const auto&, const auto&) { return false; };
  EXPECT_EQ(policy.Choose(narrow)->world_from_hand_rotation, choice.world_from_hand_rotation)
      << "where none fits, the best is taken";
  GraspObservation later = view;
  later.tried = {{choice.contact_m, choice.world_from_hand_rotation}};
  EXPECT_GT((policy.Choose(later)->contact_m - choice.contact_m).norm(), 0.02)
      << "where a grasp has failed, another place of the bar is next";
  for (double z = world.handle_z - 0.1; z <= world.handle_z + 0.1; z += 0.02)
    later.tried.push_back({{0.05, world.handle_y, z}, choice.world_from_hand_rotation});
  EXPECT_TRUE(policy.Choose(later).has_value()) << "no place is left";
}

TEST(TrainGrasp, PrefersThePointsAndTheTurnsThatOpenDoorsItHasNotSeen) {
  const GraspSamples train = MakeGraspSamples(3, 48);
  TrainConfig config = GraspConfig();
  config.epochs = 5;
  config.batch_size = 8;
  config.sampled_points = 2;
  config.learning_rate = 2e-3;
  config.frame = ViewFrame::kWorld;
  config.near_points = 0;  // which half is the upper one, only the world's frame tells
  const StageNetworks networks = TrainStage(train.samples, {}, config, {}).networks;
  const auto policy = MakeGraspPolicy(networks, {.orientations = 32});
  const auto plain = MakeGraspPolicy(networks, {.orientations = 32, .centred = false});
  int opened = 0;
  double upper = 0;
  double lower = 0;
  constexpr int kWorlds = 8;
  for (std::uint64_t i = 0; i < kWorlds; ++i) {
    const GraspWorld world(900000 + i);
    const GraspObservation view{world.cloud, kApproach, [&](const Eigen::Vector3d& start, double) {
                                  return world.From(start);
                                }};
    const auto choice = policy->Choose(view);
    ASSERT_TRUE(choice.has_value());
    EXPECT_EQ(choice->explanation->affordance_rad.size(), std::size_t{kCloudPoints / 16});
    const Eigen::Map<const Eigen::Vector3f> rated(choice->cloud.xyz.data());
    EXPECT_LT(std::abs(choice->contact_m.y() - world.handle_y), 0.012) << "it stays on the bar";
    EXPECT_EQ(rated, plain->Choose(view)->contact_m.cast<float>()) << "where it is not centred";
    opened += world.Angle(choice->contact_m, choice->world_from_hand_rotation) > 0 ? 1 : 0;
    for (std::size_t k = 0; k < choice->explanation->affordance_rad.size(); ++k)
      (choice->explanation->point_xyz[3 * k + 2] > world.handle_z ? upper : lower) +=
          choice->explanation->affordance_rad[k];
    if (i < 2) ExpectOtherChoices(*policy, view, *choice, world);
  }
  // by chance a quarter would open, and both halves of the handles would score alike
  EXPECT_GE(opened, 7);
  EXPECT_GT(upper, 2 * lower);
}

// What the near points tell: the door opens if the fingers close along the bar, near its middle.
float AngleByNearPoints(const Eigen::Vector3d& contact, const Eigen::Matrix3d& rotation) {
  return std::abs(contact.z() - 1) < 0.05 && std::abs(rotation(2, 1)) > 0.7 ? 0.8F : 0.0F;
}

TEST(TrainGrasp, LearnsFromNearPointsWhichPlacesAndTurnsOpenDoorsItHasNotSeen) {
  GraspSamples train = MakeGraspSamples(3, 128);
  for (TrainingSample& sample : train.samples) {
    const Action tried = FromVector(sample.action);
    sample.angle_gain_rad =
        AngleByNearPoints(tried.position_delta_m, tried.world_from_hand_rotation);
  }
  TrainConfig config = GraspConfig();
  config.discriminator_epochs = 30;
  config.epochs = 1;
  config.batch_size = 8;
  const TrainerState state = TrainStage(train.samples, {}, config, {});
  EXPECT_EQ(state.epochs.size(), 31U);
  const auto policy = MakeGraspPolicy(state.networks, {.points = 32, .orientations = 32});
  int opened = 0;
  for (std::uint64_t i = 0; i < 8; ++i) {
    const GraspWorld world(900000 + i);
    const auto choice =
        policy->Choose({world.cloud, kApproach,
                        [&](const Eigen::Vector3d& start, double) { return world.From(start); }});
    ASSERT_TRUE(choice.has_value());
    opened += AngleByNearPoints(choice->contact_m, choice->world_from_hand_rotation) > 0 ? 1 : 0;
    EXPECT_LT((choice->world_from_hand_rotation.col(2) - kApproach).norm(), 1e-6)
        << "no leaning hand where none is asked for";
  }
  EXPECT_GE(opened, 7) << "by chance a quarter";
}

// All of it moved.
GraspWorld Moved(GraspWorld world, const Eigen::Vector3f& by) {
  for (std::size_t i = 0; i < world.cloud.xyz.size(); ++i)
    world.cloud.xyz[i] += by[static_cast<Eigen::Index>(i % 3)];
  return world;
}

TEST(GraspPolicy, InTheHandsFrameItChoosesAlikeWhereverTheDoorIsAndSeesNoFartherThanTheContext) {
  const GraspSamples train = MakeGraspSamples(6, 8);
  TrainConfig config = GraspConfig();
  config.epochs = 1;
  config.batch_size = 8;
  config.crop_radius_m = 0.3;
  const Eigen::Vector3f by(0.5F, -0.25F, -0.5F);
  for (const ViewFrame frame : {ViewFrame::kHand, ViewFrame::kWorld}) {
    config.frame = frame;
    const auto policy = MakeGraspPolicy(TrainStage(train.samples, {}, config, {}).networks);
    const auto choose = [&](const GraspWorld& world) {
      return *policy->Choose({world.cloud, kApproach, [&](const Eigen::Vector3d& start, double) {
                                return world.From(start);
                              }});
    };
    const GraspWorld here(17);
    const GraspAction a = choose(here);
    const GraspAction b = choose(Moved(here, by));
    ASSERT_EQ(a.explanation->affordance_rad.size(), b.explanation->affordance_rad.size());
    double difference = 0;
    for (std::size_t i = 0; i < a.explanation->affordance_rad.size(); ++i)
      difference = std::max<double>(difference, std::abs(a.explanation->affordance_rad[i] -
                                                         b.explanation->affordance_rad[i]));
    if (config.frame == ViewFrame::kWorld) {
      EXPECT_GT(difference, 1e-3);
      continue;
    }
    EXPECT_LT(difference, 1e-4);
    EXPECT_NEAR(a.explanation->expected_opening_rad, b.explanation->expected_opening_rad, 1e-4);
    GraspWorld other_leaf = here;
    for (std::size_t i = kCloudPoints / 16; i < kCloudPoints; ++i) {
      if ((here.Point(i) - Eigen::Vector3d(0.05, here.handle_y, here.handle_z)).norm() > 0.5)
        other_leaf.cloud.xyz[3 * i] += 0.4F;
    }
    const GraspAction c = choose(other_leaf);
    EXPECT_EQ(c.explanation->affordance_rad, a.explanation->affordance_rad);
    EXPECT_EQ(c.explanation->expected_opening_rad, a.explanation->expected_opening_rad);
  }
}

TEST(GraspPolicy, AsksForCloudsOfTheExtentThatItLearnedFrom) {
  GraspSamples train = MakeGraspSamples(6, 8);
  for (TrainingSample& sample : train.samples) sample.cloud_crop_radius_m = 0.5F;
  TrainConfig config = GraspConfig();
  config.epochs = 1;
  config.batch_size = 8;
  const auto policy = MakeGraspPolicy(TrainStage(train.samples, {}, config, {}).networks);
  const GraspWorld world(17);
  std::set<double> asked;
  policy->Choose({world.cloud, kApproach, [&](const Eigen::Vector3d& start, double crop_radius_m) {
                    asked.insert(crop_radius_m);
                    return world.From(start);
                  }});
  EXPECT_EQ(asked, std::set<double>{0.5});
  train.samples[3].cloud_crop_radius_m = 0.25F;
  EXPECT_THROW(TrainStage(train.samples, {}, config, {}), Error) << "two extents";
}

TEST(GraspPolicy, ChoosesNothingWithoutAHandleInView) {
  const GraspSamples train = MakeGraspSamples(5, 2);
  const auto policy = MakeGraspPolicy(
      InitialNetworks(MeasureNormalisation(train.samples), false, 1, NetworkFamily::kGrasp));
  GraspWorld world(1);
  std::fill(world.cloud.label.begin(), world.cloud.label.end(), std::uint8_t{0});
  const auto sample = [&](const Eigen::Vector3d& start, double) { return world.From(start); };
  EXPECT_FALSE(policy->Choose({world.cloud, kApproach, sample}).has_value());
  world.cloud.label.pop_back();
  EXPECT_THROW(policy->Choose({world.cloud, kApproach, sample}), Error);
  EXPECT_THROW(MakeGraspPolicy(InitialNetworks(MeasureNormalisation(train.samples), false, 1)),
               Error);
}

}  // namespace
}  // namespace doorforge
