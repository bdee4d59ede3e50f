// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/handle_points.h"
#include "doorforge/schemas/cloud.h"

#include "grasp_augmentation.h"
#include "stage_task.h"

namespace doorforge::internal {
namespace {

constexpr int kPlacePhase = 1;
// In use a near look begins where the place was guessed to be: somewhere about the handle.
constexpr float kGuessM = 0.05F;
// What all points of a handle count together, afar, where those of the rest of the door count 1: a
// small handle is to be found as surely as a long one.
constexpr float kHandleShare = 0.1F;

// One look as a network is shown it on one step, and what it learns from it.
struct ShownLook {
  std::vector<float> xyz;
  CloudWindow window;
  std::vector<std::uint16_t> points;  // ascending
  std::vector<float> is_handle;
  std::vector<float> weights;
  Eigen::Matrix3d augmentation;
};

// The first `count` of a permutation, ascending.
std::vector<std::size_t> Some(std::vector<std::size_t> points, std::size_t count, Rng& rng) {
  count = std::min(count, points.size());
  for (std::size_t k = 0; k < count; ++k)
    std::swap(points[k], points[k + rng.Index(static_cast<std::uint32_t>(points.size() - k))]);
  points.resize(count);
  std::ranges::sort(points);
  return points;
}

float SquaredDistance(std::span<const float> xyz, std::size_t a, std::size_t b) {
  float squared = 0;
  for (std::size_t k = 0; k < 3; ++k)
    squared += (xyz[3 * a + k] - xyz[3 * b + k]) * (xyz[3 * a + k] - xyz[3 * b + k]);
  return squared;
}

class FindTask : public StageTask {
 public:
  explicit FindTask(const TaskInput& input) : input_(input) {
    for (const SampleSet set : {SampleSet::kTrain, SampleSet::kValidation}) {
      const std::span<const TrainingSample> samples = SamplesOf(set);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const int phase = samples[i].cloud_crop_radius_m > 0 ? 0 : kPlacePhase;
        LooksOf(set, phase).push_back(i);
      }
      Require(
          samples.empty() || (!LooksOf(set, 0).empty() && !LooksOf(set, kPlacePhase).empty()),
          ErrorCode::kInvalidArgument,
          "a finder learns from looks from near by (cloud_within_m above 0 in meta.json) and of "
          "the whole door (0), and there are only the ones or the others; give --data both data "
          "sets, and none so small that nothing of it is left for validation");
    }
  }

  std::vector<NetworkRole> NetworksOf(int phase) const override {
    return {phase == kPlacePhase ? NetworkRole::kActor : NetworkRole::kCritic};
  }

  int Interval(NetworkRole /*role*/) const override { return 1; }

  void Begin(int /*phase*/, const StageNetworks& /*networks*/) override {}

  bool ReadsClouds(int /*phase*/) const override { return true; }

  Geometries GeometriesOf(int phase, const Minibatch& batch) override {
    Geometries found(batch.indices.size());
    ParallelFor(found.size(), input_.threads, [&](std::size_t i) {
      const ShownLook look = Shown(phase, batch, batch.indices[i]);
      const auto geometry = std::make_shared<const CloudGeometry>(
          GeometryFor(*input_.config, batch.set, look.xyz, {look.window, look.points}));
      found[i] = Augmented(geometry, look.augmentation);
    });
    return found;
  }

  HeadResult Objective(NetworkRole role, const Minibatch& batch, std::vector<float> features,
                       std::span<float> gradient) override {
    const int phase = role == NetworkRole::kActor ? kPlacePhase : 0;
    HeadBatch head;
    for (const std::size_t index : batch.indices) {
      const ShownLook look = Shown(phase, batch, index);
      head.is_handle.insert(head.is_handle.end(), look.is_handle.begin(), look.is_handle.end());
      head.weights.insert(head.weights.end(), look.weights.begin(), look.weights.end());
    }
    head.size = static_cast<int>(head.is_handle.size());
    head.features = std::move(features);
    const StageNetworks& networks = *input_.networks;
    if (phase == kPlacePhase)
      return FinderObjective({networks.actor_layout(), networks.actor, &StageLosses::place}, head,
                             gradient);
    return FinderObjective({networks.critic_layout(), networks.critic, &StageLosses::mask}, head,
                           gradient);
  }

 private:
  std::span<const TrainingSample> SamplesOf(SampleSet set) const {
    return set == SampleSet::kTrain ? input_.train : input_.validation;
  }

  std::vector<std::size_t>& LooksOf(SampleSet set, int phase) {
    return looks_.at(static_cast<std::size_t>(set)).at(static_cast<std::size_t>(phase));
  }

  // The phase's own looks, over and over: an epoch shows as many as there are of both extents.
  const TrainingSample& LookAt(int phase, SampleSet set, std::size_t index) const {
    const auto& looks =
        looks_.at(static_cast<std::size_t>(set)).at(static_cast<std::size_t>(phase));
    return SamplesOf(set)[looks[index % looks.size()]];
  }

  // It depends on phase, sample and step, not on which part of the batch a process has.
  ShownLook Shown(int phase, const Minibatch& batch, std::size_t index) const {
    const TrainingSample& sample = LookAt(phase, batch.set, index);
    const bool trains = batch.set == SampleSet::kTrain;
    Rng rng(input_.config->seed,
            (trains ? "train/look/" + std::to_string(batch.step) : "val/look") + "/" +
                std::to_string(index));
    ShownLook look = phase == kPlacePhase ? FromAfar(sample, rng) : FromNearBy(sample, rng);
    const std::array<float, 3>& approach = sample.approach;
    look.augmentation = Eigen::Matrix3d::Identity();
    if (trains)
      look.augmentation =
          DrawAugmentation(*input_.config, {approach[0], approach[1], approach[2]}, rng);
    return look;
  }

  std::size_t PointsOfLook() const {
    return static_cast<std::size_t>(input_.config->sampled_points);
  }

  static ShownLook Begun(const TrainingSample& sample, std::size_t first,
                         std::vector<std::uint8_t>& label) {
    label.assign(sample.label.begin(), sample.label.end());
    std::swap(label[0], label[first]);
    ShownLook look;
    look.xyz = BeginningAt(sample.cloud, first);
    return look;
  }

  static void Learn(std::span<const std::size_t> points, float of_handle, float weight,
                    ShownLook& look) {
    for (const std::size_t point : points) {
      look.points.push_back(static_cast<std::uint16_t>(point));
      look.is_handle.push_back(of_handle);
      look.weights.push_back(weight);
    }
  }

  // Begins at some place about the contact, as a guess of the place does.
  ShownLook FromNearBy(const TrainingSample& sample, Rng& rng) const {
    std::vector<std::size_t> about;
    for (std::size_t i = 0; i < sample.label.size(); ++i)
      if (SquaredDistance(sample.cloud, 0, i) < kGuessM * kGuessM) about.push_back(i);
    const std::size_t first = about[rng.Index(static_cast<std::uint32_t>(about.size()))];
    std::vector<std::uint8_t> label;
    ShownLook look = Begun(sample, first, label);
    look.window = GraspWindow(input_.networks->normalisation, look.xyz);
    std::vector<std::size_t> all(label.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const std::vector<std::size_t> inside = PointsInWindow(look.xyz, look.window, all);
    for (const std::size_t point : Some(inside, PointsOfLook(), rng)) {
      const bool of_handle = label[point] == static_cast<std::uint8_t>(PointLabel::kHandle);
      Learn(std::array{point}, of_handle ? 1.0F : 0.0F, 1.0F, look);
    }
    return look;
  }

  // Begins anywhere, so that where sampling began says nothing of the handle.
  ShownLook FromAfar(const TrainingSample& sample, Rng& rng) const {
    const std::size_t first = rng.Index(static_cast<std::uint32_t>(sample.label.size()));
    std::vector<std::uint8_t> label;
    ShownLook look = Begun(sample, first, label);
    look.window = PlaceWindow(look.xyz);
    std::vector<std::size_t> handle;
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < label.size(); ++i) {
      const bool of_handle = label[i] == static_cast<std::uint8_t>(PointLabel::kHandle);
      (of_handle ? handle : others).push_back(i);
    }
    handle = Some(std::move(handle), PointsOfLook() / 4, rng);
    others = Some(std::move(others), PointsOfLook() - handle.size(), rng);
    std::vector<std::size_t> chosen = handle;
    chosen.insert(chosen.end(), others.begin(), others.end());
    std::ranges::sort(chosen);
    for (const std::size_t point : chosen) {
      const bool of_handle = label[point] == static_cast<std::uint8_t>(PointLabel::kHandle);
      const float weight = of_handle ? kHandleShare / static_cast<float>(handle.size())
                                     : 1.0F / static_cast<float>(others.size());
      Learn(std::array{point}, of_handle ? 1.0F : 0.0F, weight, look);
    }
    return look;
  }

  TaskInput input_;
  std::array<std::array<std::vector<std::size_t>, 2>, 2> looks_;  // by SampleSet and phase
};

}  // namespace

std::unique_ptr<StageTask> MakeFindTask(const TaskInput& input) {
  return std::make_unique<FindTask>(input);
}

}  // namespace doorforge::internal
