// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Finders on a world of our own: a leaf with one bar of a handle, and a wall beside it.
#include "doorforge/policy/handle_finder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/training/train_stage.h"

namespace doorforge {
namespace {

constexpr std::size_t kSeenOfDoor = 12000;
constexpr double kNearLookM = 0.4;

// A closed door, turned a little about the vertical.
struct ClosedDoorWorld {
  explicit ClosedDoorWorld(std::uint64_t seed, double yaw_rad = 0)
      : rotation(RotationAbout(Eigen::Vector3d::UnitZ(), yaw_rad).linear()) {
    Rng rng(seed, "test/finder_world");
    const double y = rng.Uniform(-0.35, 0.35);
    const double z = rng.Uniform(0.8, 1.2);
    for (std::size_t i = 0; i < kSeenOfDoor; ++i) {
      const double part = rng.Uniform();
      Eigen::Vector3d point(0, rng.Uniform(-0.5, 0.5), rng.Uniform(0.2, 1.9));
      if (part < 0.03)
        point = {0.05, y + rng.Uniform(-0.06, 0.06), z + rng.Uniform(-0.012, 0.012)};
      else if (part < 0.4)
        point.y() += 1;
      point = rotation * point;
      for (const double v : point)
        visible.xyz.push_back(static_cast<float>(v + 0.001 * rng.Normal()));
      visible.label.push_back(part < 0.03 ? 1 : 0);
    }
  }

  Eigen::Vector3d Point(std::size_t i) const {
    return Eigen::Vector3f(visible.xyz[3 * i], visible.xyz[3 * i + 1], visible.xyz[3 * i + 2])
        .cast<double>();
  }

  // The point nearest to `start` and, around it, the first of the others; all over again where they
  // are too few.
  LabelledCloud Sample(const Eigen::Vector3d& start, double crop_radius_m) const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < kSeenOfDoor; ++i)
      if ((Point(i) - start).norm() < (Point(nearest) - start).norm()) nearest = i;
    std::vector<std::size_t> chosen = {nearest};
    for (std::size_t i = 0; i < kSeenOfDoor && chosen.size() < kCloudPoints; ++i)
      if (crop_radius_m == 0 || (Point(i) - Point(nearest)).norm() <= crop_radius_m)
        chosen.push_back(i);
    LabelledCloud cloud;
    for (std::size_t k = 0; k < kCloudPoints; ++k) {
      const std::size_t i = chosen[k % chosen.size()];
      for (std::size_t c = 0; c < 3; ++c) cloud.xyz.push_back(visible.xyz[3 * i + c]);
      cloud.label.push_back(visible.label[i]);
    }
    return cloud;
  }

  SampleAbout sample() const {
    return [this](const Eigen::Vector3d& start, double crop_radius_m) {
      return Sample(start, crop_radius_m);
    };
  }

  Eigen::Vector3d approach() const { return -rotation.col(0); }

  double IntersectionOverUnion(const std::vector<bool>& found) const {
    double both = 0;
    double any = 0;
    for (std::size_t i = 0; i < kSeenOfDoor; ++i) {
      both += visible.label[i] == 1 && found[i] ? 1 : 0;
      any += visible.label[i] == 1 || found[i] ? 1 : 0;
    }
    return both / any;
  }

  Eigen::Matrix3d rotation;
  LabelledCloud visible;
};

struct RecordedLooks {
  std::vector<LabelledCloud> clouds;
  std::vector<TrainingSample> samples;
};

// Each door is looked at from near by and as a whole, as `datagen grasp` records it.
RecordedLooks MakeRecordedLooks(std::uint64_t seed, std::size_t doors, bool near = true,
                                bool whole = true) {
  RecordedLooks looks;
  for (std::size_t i = 0; i < doors; ++i) {
    const ClosedDoorWorld world(1000 * seed + i);
    const auto handle = static_cast<std::size_t>(
        std::distance(world.visible.label.begin(), std::ranges::find(world.visible.label, 1)));
    for (const double extent_m : {near ? kNearLookM : -1, whole ? 0.0 : -1}) {
      if (extent_m < 0) continue;
      looks.clouds.push_back(world.Sample(world.Point(handle), extent_m));
      TrainingSample sample;
      sample.approach = {-1, 0, 0};
      sample.action = ToVector({world.Point(handle), Eigen::Matrix3d::Identity()});
      sample.cloud_crop_radius_m = static_cast<float>(extent_m);
      looks.samples.push_back(sample);
    }
  }
  for (std::size_t i = 0; i < looks.samples.size(); ++i) {
    looks.samples[i].cloud = looks.clouds[i].xyz;
    looks.samples[i].label = looks.clouds[i].label;
  }
  return looks;
}

TrainConfig FinderConfig() {
  TrainConfig config = TrainDefaultsOf("find");
  config.discriminator_epochs = 0;  // the mask learns as long as the place
  config.batch_size = 8;
  config.warmup_steps = 5;
  config.sampled_points = 256;
  return config;
}

// Trained once, of 24 doors.
HandleFinder TrainedFinder() {
  static const StageNetworks networks = [] {
    TrainConfig config = FinderConfig();
    config.epochs = 30;
    config.learning_rate = 3e-3;
    return TrainStage(MakeRecordedLooks(1, 24).samples, {}, config, {}).networks;
  }();
  return HandleFinder(networks);
}

TEST(TrainFind, GivesTheSameBitsForAnyNumberOfThreadsAndInterruptionsInBothPhases) {
  const RecordedLooks train = MakeRecordedLooks(1, 8);
  const RecordedLooks validation = MakeRecordedLooks(2, 1);
  TrainConfig config = FinderConfig();
  config.epochs = 1;
  TrainHooks hooks;
  hooks.threads = 1;
  const TrainerState whole = TrainStage(train.samples, validation.samples, config, hooks);
  EXPECT_EQ(whole.step, 4U);
  ASSERT_EQ(whole.epochs.size(), 2U);
  EXPECT_FALSE(whole.epochs[0].validation.place.has_value());
  EXPECT_TRUE(whole.epochs[1].validation.place.has_value());
  EXPECT_EQ(whole.epochs[1].validation.mask, whole.epochs[0].validation.mask);
  EXPECT_EQ(whole.best.epochs, (BestEpochs{2, 1}));
  for (const int stop_after : {1, 3}) {
    TrainHooks stopped;
    stopped.threads = 2;
    stopped.stop = [stop_after, count = 0]() mutable { return ++count == stop_after; };
    TrainHooks resumed;
    resumed.threads = 2;
    resumed.resume = TrainStage(train.samples, validation.samples, config, stopped);
    const TrainerState state = TrainStage(train.samples, validation.samples, config, resumed);
    EXPECT_EQ(state.networks.actor, whole.networks.actor) << stop_after;
    EXPECT_EQ(state.networks.critic, whole.networks.critic) << stop_after;
    EXPECT_EQ(state.epochs[1].validation.place, whole.epochs[1].validation.place);
  }
}

TEST(TrainFind, RefusesLooksOfOneExtentAlone) {
  const RecordedLooks near = MakeRecordedLooks(1, 2, true, false);
  const RecordedLooks whole = MakeRecordedLooks(1, 2, false, true);
  EXPECT_THROW(TrainStage(near.samples, {}, FinderConfig(), {}), Error);
  EXPECT_THROW(TrainStage(whole.samples, {}, FinderConfig(), {}), Error);
  std::vector<TrainingSample> of_two_extents = MakeRecordedLooks(1, 2).samples;
  of_two_extents.back().cloud_crop_radius_m = 0.2F;
  EXPECT_THROW(TrainStage(of_two_extents, {}, FinderConfig(), {}), Error);
}

/// What a policy was shown, which takes hold of the first handle point.
class GraspWitness : public GraspPolicy {
 public:
  explicit GraspWitness(GraspObservation& shown) : shown_(&shown) {}
  std::optional<GraspAction> Choose(const GraspObservation& seen) override {
    *shown_ = seen;
    sampled_ = seen.sample(Eigen::Vector3d::Zero(), 0);
    shown_->visible = seen.visible;
    shown_->sample = [sampled = sampled_](const Eigen::Vector3d&, double) { return sampled; };
    return GraspAction{};
  }

 private:
  GraspObservation* shown_;
  LabelledCloud sampled_;
};

TEST(HandleFinder, FindsHandlesOfDoorsThatItHasNotSeen) {
  const HandleFinder finder = TrainedFinder();
  for (std::uint64_t seed = 9001; seed <= 9006; ++seed) {
    SCOPED_TRACE(seed);
    const ClosedDoorWorld world(seed, 0.05 * static_cast<double>(seed % 3) - 0.05);
    const auto found = finder.Find(world.visible, world.sample());
    ASSERT_TRUE(found.has_value());
    EXPECT_GT(world.IntersectionOverUnion(found->is_handle), 0.8);
    EXPECT_GT(found->approach.dot(world.approach()), std::cos(0.01));
  }
}

TEST(HandleFinder, ReadsNoLabelAndLetsTheGraspSeeWhatItFinds) {
  ClosedDoorWorld world(9101);
  const std::vector<std::uint8_t> truth = world.visible.label;
  std::ranges::fill(world.visible.label, std::uint8_t{0});
  GraspObservation seen;
  seen.visible = world.visible;
  seen.sample = world.sample();
  seen.approach = Eigen::Vector3d::UnitY();
  GraspObservation shown;
  FindingGrasp policy(std::make_unique<GraspWitness>(shown), TrainedFinder());
  ASSERT_TRUE(policy.Choose(seen).has_value());
  EXPECT_GT(shown.approach.dot(world.approach()), std::cos(0.01));
  double agree = 0;
  for (std::size_t i = 0; i < kSeenOfDoor; ++i) {
    const bool of_handle = shown.visible.label[i] == static_cast<std::uint8_t>(PointLabel::kHandle);
    agree += of_handle == (truth[i] == 1) ? 1 : 0;
  }
  EXPECT_GT(agree, 0.98 * kSeenOfDoor);
  // what is sampled has the labels of the same points
  const LabelledCloud sampled = shown.sample({}, 0);
  const LabelledCloud again = world.Sample(Eigen::Vector3d::Zero(), 0);
  ASSERT_EQ(sampled.xyz, again.xyz);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(sampled.label, 1)), 0.03 * kCloudPoints,
              0.01 * kCloudPoints);
}

TEST(HandleFinder, IsNoGraspersPolicy) {
  EXPECT_THROW(HandleFinder(InitialNetworks({}, false, 1, NetworkFamily::kGrasp)), Error);
}

TEST(DominantNormal, IsThatOfTheLeafWhateverLiesAboutIt) {
  Rng rng(1, "test/normals");
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Matrix3d rotation =
        RotationAbout(Eigen::Vector3d::UnitZ(), rng.Uniform(-0.8, 0.8)).linear() *
        RotationAbout(Eigen::Vector3d::UnitY(), rng.Uniform(-0.3, 0.3)).linear();
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 3000; ++i) {
      Eigen::Vector3d point(0.002 * rng.Normal(), rng.Uniform(-0.3, 0.3), rng.Uniform(-0.3, 0.3));
      if (i % 5 == 0) point.x() = rng.Uniform(-0.1, 0.2);   // anything
      if (i % 5 == 1) point = {point.y(), 0.3, point.z()};  // a jamb
      points.push_back((rotation * point + Eigen::Vector3d(0, 1, 1)).cast<float>());
    }
    const double cosine = -DominantNormal(points).dot(rotation.col(0));
    EXPECT_LT(std::acos(std::min(cosine, 1.0)), 0.5 * std::numbers::pi / 180) << trial;
  }
}

TEST(DominantNormal, IsTheWorldsWhereNothingSpansAPlane) {
  const Eigen::Vector3d against_x = -Eigen::Vector3d::UnitX();
  EXPECT_EQ(DominantNormal({}), against_x);
  EXPECT_EQ(DominantNormal({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}), against_x);
}

}  // namespace
}  // namespace doorforge
