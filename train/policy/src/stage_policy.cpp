// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/stage_policy.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/hand_frame.h"
#include "doorforge/networks/heads.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/trying_policy.h"

namespace doorforge {
namespace {

using internal::HeadInputs;

void AppendCopies(const std::vector<float>& values, int copies, std::vector<float>& out) {
  for (int i = 0; i < copies; ++i) out.insert(out.end(), values.begin(), values.end());
}

class StagePolicy : public TwoWayPolicy {
 public:
  StagePolicy(StageNetworks networks, const PolicyOptions& options)
      : networks_(std::move(networks)),
        options_(options),
        actor_(ActorLayout(), "encoder.", networks_.actor, BestInstructionSet()),
        actor_head_(networks_) {
    if (options_.candidates > 1) {
      critic_.emplace(CriticLayout(), "encoder.", networks_.critic, BestInstructionSet());
      critic_head_.emplace(networks_);
    }
  }

  void Reset() override { decision_ = 0; }

  Action Act(const Observation& observation, MotionWay way) override {
    const Eigen::Vector3f hand_m = HandPositionOf(observation.proprioception);
    const CloudGeometry geometry =
        BuildGeometry(observation.cloud.xyz,
                      WindowOf(networks_.normalisation, {hand_m.x(), hand_m.y(), hand_m.z()}));
    HeadInputs batch = RobotInputs({observation.proprioception, way});
    AppendCopies(actor_.Forward(geometry).features, batch.size, batch.features);
    const std::vector<float> actions = actor_head_.Decode(batch, Latents());
    const std::size_t best = critic_ ? Best(geometry, actions, batch) : 0;
    ++decision_;
    ActionVector chosen{};
    std::copy_n(actions.begin() + static_cast<std::ptrdiff_t>(9 * best), 9, chosen.begin());
    return FromVector(InWorld(chosen, observation.proprioception));
  }

 private:
  ActionVector InWorld(const ActionVector& action, const Proprioception& proprioception) const {
    if (networks_.normalisation.view.frame == ViewFrame::kWorld) return action;
    return internal::TargetOf(action, HandRotationOf(proprioception));
  }

  HeadInputs RobotInputs(const internal::RobotCondition& robot) const {
    HeadInputs batch;
    batch.size = options_.candidates;
    for (int i = 0; i < batch.size; ++i)
      internal::AppendRobotState(networks_.normalisation, robot, batch);
    return batch;
  }

  std::vector<float> Latents() const {
    std::vector<float> latents(static_cast<std::size_t>(options_.candidates) * kLatentSize);
    Rng rng(options_.seed, "policy/" + std::to_string(decision_));
    for (std::size_t i = kLatentSize; i < latents.size(); ++i)
      latents[i] = static_cast<float>(rng.Normal());
    return latents;
  }

  std::size_t Best(const CloudGeometry& geometry, const std::vector<float>& actions,
                   HeadInputs& batch) const {
    batch.features.clear();
    AppendCopies(critic_->Forward(geometry).features, batch.size, batch.features);
    for (std::size_t i = 0; i < actions.size(); i += 9) {
      ActionVector action{};
      std::copy_n(actions.begin() + static_cast<std::ptrdiff_t>(i), 9, action.begin());
      const ActionVector numbers = networks_.normalisation.action.Apply(action);
      batch.actions.insert(batch.actions.end(), numbers.begin(), numbers.end());
    }
    const std::vector<float> scores = critic_head_->Score(batch);
    return static_cast<std::size_t>(
        std::distance(scores.begin(), std::max_element(scores.begin(), scores.end())));
  }

  StageNetworks networks_;
  PolicyOptions options_;
  PointEncoder actor_;
  std::optional<PointEncoder> critic_;
  internal::ActorHead actor_head_;
  std::optional<internal::CriticHead> critic_head_;
  std::uint64_t decision_ = 0;
};

}  // namespace

std::unique_ptr<Policy> MakePolicy(StageNetworks networks, const PolicyOptions& options,
                                   std::shared_ptr<SideFinder> finder) {
  Require(options.candidates >= 1 && options.candidates <= 1000, ErrorCode::kInvalidConfig,
          "policy.candidates: must be 1 to 1000");
  const StageNormalisation& normalisation = networks.normalisation;
  std::vector<MotionWay> ways = {MotionWay::kUsual};
  if (KnowsBothWays(normalisation)) ways.push_back(MotionWay::kOther);
  // the mirror image of an arm is another arm, see mirror.h
  const bool has_mirror_image = normalisation.view.state != StateKind::kJoints;
  Require(has_mirror_image || options.side != SideChoice::kRight, ErrorCode::kInvalidConfig,
          "policy.side: a policy that reads the arm's joints knows doors hinged left alone");
  if (!has_mirror_image) finder.reset();
  if (has_mirror_image && !finder && options.side != SideChoice::kAuto)
    finder = std::make_shared<SideFinder>(options.side, std::nullopt);
  return std::make_unique<TryingPolicy>(std::make_unique<StagePolicy>(std::move(networks), options),
                                        options.stall, std::move(ways), std::move(finder));
}

std::unique_ptr<Policy> LoadPolicy(const std::filesystem::path& folder,
                                   const PolicyOptions& options, std::string_view stage,
                                   std::shared_ptr<SideFinder> finder) {
  return MakePolicy(ReadPolicy(folder, stage).networks, options, std::move(finder));
}

std::shared_ptr<SideFinder> LoadSideFinder(const std::filesystem::path& opener,
                                           const PolicyOptions& options) {
  std::optional<SideClassifier> classifier;
  if (!opener.empty()) classifier = ReadSideClassifier(opener);
  return std::make_shared<SideFinder>(options.side, std::move(classifier));
}

}  // namespace doorforge
