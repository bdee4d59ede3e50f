// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/handle_points.h"
#include "doorforge/networks/near_points.h"
#include "doorforge/policy/grasp_rating.h"
#include "doorforge/policy/orientation_sampling.h"

#include "color_augmentation.h"
#include "grasp_augmentation.h"
#include "stage_task.h"

namespace doorforge::internal {
namespace {

constexpr int kAffordancePhase = 1;

// What the affordance learns from one cloud.
struct RatedPoints {
  std::size_t first = 0;              // of the cloud that the affordance reads
  std::vector<std::uint16_t> points;  // ascending, in that cloud
  std::vector<float> targets;         // [rad]
};

class GraspTask : public StageTask {
 public:
  explicit GraspTask(const TaskInput& input)
      : input_(input),
        contacts_{CacheOf(SampleSet::kTrain, 0), CacheOf(SampleSet::kValidation, 0)},
        candidates_{CacheOf(SampleSet::kTrain, kAffordancePhase),
                    CacheOf(SampleSet::kValidation, kAffordancePhase)} {}

  std::vector<NetworkRole> NetworksOf(int phase) const override {
    if (phase == kAffordancePhase) return {NetworkRole::kActor};
    return {NetworkRole::kCritic};
  }

  int Interval(NetworkRole /*role*/) const override { return 1; }

  // The discriminator does not change any more: its ratings are found once.
  void Begin(int phase, const StageNetworks& networks) override {
    if (phase != kAffordancePhase) return;
    const GraspRater rater(networks);
    for (const SampleSet set : {SampleSet::kTrain, SampleSet::kValidation}) {
      std::vector<RatedPoints>& rated = rated_.at(static_cast<std::size_t>(set));
      rated.resize(SamplesOf(set).size());
      ParallelFor(rated.size(), input_.threads,
                  [&](std::size_t i) { rated[i] = Rated(rater, set, i); });
    }
  }

  bool ReadsClouds(int phase) const override {
    return phase == kAffordancePhase || input_.networks->normalisation.view.near_points == 0;
  }

  Geometries GeometriesOf(int phase, const Minibatch& batch) override {
    auto& caches = phase == kAffordancePhase ? candidates_ : contacts_;
    Geometries found =
        caches.at(static_cast<std::size_t>(batch.set)).Get(batch.indices, input_.threads);
    ParallelFor(found.size(), input_.threads, [&](std::size_t i) {
      found[i] = Augmented(found[i], AugmentationOf(batch, batch.indices[i]));
    });
    Recolor(*input_.config, batch, input_.threads, found);
    return found;
  }

  HeadResult Objective(NetworkRole role, const Minibatch& batch, std::vector<float> features,
                       std::span<float> gradient) override {
    const StageNetworks& networks = *input_.networks;
    HeadBatch head = role == NetworkRole::kCritic ? TriedGrasps(batch) : Candidates(batch);
    head.features = std::move(features);
    if (role == NetworkRole::kActor) return AffordanceObjective(networks, head, gradient);
    return DiscriminatorObjective(networks, head, *input_.config, gradient);
  }

 private:
  std::span<const TrainingSample> SamplesOf(SampleSet set) const {
    return set == SampleSet::kTrain ? input_.train : input_.validation;
  }

  GeometryCache CacheOf(SampleSet set, int phase) const {
    // the two phases share the memory, and validation has a quarter of what training has
    const std::size_t bytes = input_.cache_bytes / (set == SampleSet::kTrain ? 2 : 8);
    const auto points =
        phase == kAffordancePhase ? static_cast<std::size_t>(input_.config->sampled_points) : 1;
    return {SamplesOf(set).size(), points, bytes,
            [this, set, phase](std::size_t i) { return GeometryOf(set, phase, i); }};
  }

  CloudGeometry GeometryOf(SampleSet set, int phase, std::size_t i) const {
    const StageNormalisation& normalisation = input_.networks->normalisation;
    const TrainingSample& sample = SamplesOf(set)[i];
    if (phase != kAffordancePhase)
      return GeometryFor(*input_.config, set, {sample.cloud, sample.rgb},
                         {GraspWindow(normalisation, sample.cloud), {0}});
    const RatedPoints& rated = rated_.at(static_cast<std::size_t>(set))[i];
    const std::vector<float> begun = BeginningAt(sample.cloud, rated.first);
    const std::vector<std::uint8_t> rgb = BeginningAt(sample.rgb, rated.first);
    return GeometryFor(*input_.config, set, {begun, rgb},
                       {GraspWindow(normalisation, begun), rated.points});
  }

  // It depends on sample and step, not on which part of the batch a process has.
  Eigen::Matrix3d AugmentationOf(const Minibatch& batch, std::size_t index) const {
    if (batch.set != SampleSet::kTrain) return Eigen::Matrix3d::Identity();
    Rng rng(input_.config->seed,
            "train/augmentation/" + std::to_string(batch.step) + "/" + std::to_string(index));
    const std::array<float, 3>& approach = input_.train[index].approach;
    return DrawAugmentation(*input_.config, {approach[0], approach[1], approach[2]}, rng);
  }

  // The grasps of the record. On every step each is held one way round or the other, by chance.
  HeadBatch TriedGrasps(const Minibatch& batch) const {
    const StageNormalisation& normalisation = input_.networks->normalisation;
    std::vector<TrainingSample> tried;
    for (const std::size_t index : batch.indices) tried.push_back(SamplesOf(batch.set)[index]);
    HeadBatch head = MakeHeadBatch(tried, normalisation);
    const bool training = batch.set == SampleSet::kTrain;
    Rng rng(input_.config->seed, "train/half_turns/" + std::to_string(batch.step));
    for (std::size_t i = 0; i < batch.indices.size(); ++i) {
      const std::size_t index = batch.indices[i];
      const TrainingSample& sample = SamplesOf(batch.set)[index];
      const Eigen::Matrix3d augmentation = AugmentationOf(batch, index);
      ActionVector grasp = Augmented(sample.action, augmentation);
      if (training && rng.Uniform() >= 0.5) grasp = HalfTurned(grasp);
      AppendInHandFrame(
          augmentation.cast<float>() * NearestToFirst(sample.cloud, normalisation.view.near_points),
          FromVector(grasp).world_from_hand_rotation, head.near);
      const auto numbers = normalisation.action.Apply(grasp);
      std::copy(numbers.begin(), numbers.end(),
                head.actions.begin() + static_cast<std::ptrdiff_t>(9 * i));
    }
    return head;
  }

  HeadBatch Candidates(const Minibatch& batch) const {
    HeadBatch head;
    for (const std::size_t index : batch.indices) {
      const RatedPoints& rated = rated_.at(static_cast<std::size_t>(batch.set))[index];
      const std::vector<float> cloud = BeginningAt(SamplesOf(batch.set)[index].cloud, rated.first);
      const Eigen::Matrix3d augmentation = AugmentationOf(batch, index);
      for (const std::uint16_t point : rated.points)
        AppendPoint(cloud, point, augmentation, head.points);
      head.angle_gains_rad.insert(head.angle_gains_rad.end(), rated.targets.begin(),
                                  rated.targets.end());
    }
    head.size = static_cast<int>(head.angle_gains_rad.size());
    return head;
  }

  void AppendPoint(const std::vector<float>& xyz, std::size_t point,
                   const Eigen::Matrix3d& augmentation, std::vector<float>& points) const {
    const StageNormalisation& normalisation = input_.networks->normalisation;
    const std::array<float, 3> origin = GraspOrigin(normalisation, xyz);
    const Normaliser<9>& action = normalisation.action;
    Eigen::Vector3f from_origin;
    for (std::size_t k = 0; k < 3; ++k)
      from_origin[static_cast<Eigen::Index>(k)] = xyz[3 * point + k] - origin.at(k);
    const Eigen::Vector3f shown = augmentation.cast<float>() * from_origin;
    for (std::size_t k = 0; k < 3; ++k)
      points.push_back((shown[static_cast<Eigen::Index>(k)] - action.mean.at(k)) /
                       action.deviation.at(k));
  }

  // Some of the cloud's handle points; the contact that was tried where it shows no handle.
  RatedPoints Rated(const GraspRater& rater, SampleSet set, std::size_t i) const {
    const TrainingSample& sample = SamplesOf(set)[i];
    std::vector<std::size_t> handle = HandlePointsOf(sample.label);
    if (handle.empty()) handle = {0};
    RatedPoints rated;
    rated.first = MiddlePoint(sample.cloud, handle);
    const std::vector<float> cloud = BeginningAt(sample.cloud, rated.first);
    const std::vector<std::uint8_t> rgb = BeginningAt(sample.rgb, rated.first);
    for (std::size_t& point : handle) {  // places after the exchange of two points
      if (point == rated.first || point == 0) point = point == 0 ? rated.first : 0;
    }
    handle = PointsInWindow(cloud, GraspWindow(input_.networks->normalisation, cloud), handle);
    Rng rng(input_.config->seed,
            (set == SampleSet::kTrain ? "train/ratings/" : "val/ratings/") + std::to_string(i));
    for (std::size_t k = 0; k < handle.size(); ++k)
      std::swap(handle[k], handle[k + rng.Index(static_cast<std::uint32_t>(handle.size() - k))]);
    handle.resize(std::min(handle.size(), static_cast<std::size_t>(input_.config->sampled_points)));
    std::sort(handle.begin(), handle.end());
    for (const std::size_t point : handle) {
      rated.points.push_back(static_cast<std::uint16_t>(point));
      const std::vector<float> begun = BeginningAt(cloud, point);
      const std::vector<std::uint8_t> colors = BeginningAt(rgb, point);
      rated.targets.push_back(Target(rater, {begun, colors}, sample.approach, rng));
    }
    return rated;
  }

  float Target(const GraspRater& rater, const CloudView& cloud,
               const std::array<float, 3>& approach, Rng& rng) const {
    const TrainConfig& config = *input_.config;
    const std::vector<Eigen::Matrix3d> orientations =
        SampleOrientations(Eigen::Vector3d(approach[0], approach[1], approach[2]),
                           {config.sampled_orientations, config.tilt_rad}, rng);
    return MeanOfBest(rater.Rate(cloud, orientations),
                      static_cast<std::size_t>(config.best_orientations));
  }

  TaskInput input_;
  std::array<std::vector<RatedPoints>, 2> rated_;  // by SampleSet
  std::array<GeometryCache, 2> contacts_;
  std::array<GeometryCache, 2> candidates_;
};

}  // namespace

std::unique_ptr<StageTask> MakeGraspTask(const TaskInput& input) {
  return std::make_unique<GraspTask>(input);
}

}  // namespace doorforge::internal
