// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/stage_policy.h"

#include <algorithm>
#include <filesystem>
#include <memory>
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
#include "doorforge/policy/mirroring_policy.h"
#include "doorforge/policy/policy_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::HeadInputs;

constexpr const char* kPushedFolder = "pushed";

void AppendCopies(const std::vector<float>& values, int copies, std::vector<float>& out) {
  for (int i = 0; i < copies; ++i) out.insert(out.end(), values.begin(), values.end());
}

class StagePolicy : public TwoWayPolicy {
 public:
  StagePolicy(StageNetworks networks, const PolicyOptions& options)
      : networks_(std::move(networks)),
        options_(options),
        actor_(networks_.actor_layout(), "encoder.", networks_.actor, BestInstructionSet()),
        actor_head_(networks_) {
    if (options_.candidates > 1) {
      critic_.emplace(networks_.critic_layout(), "encoder.", networks_.critic,
                      BestInstructionSet());
      critic_head_.emplace(networks_);
    }
  }

  void Reset() override { decision_ = 0; }
  bool UsesColors() const override { return networks_.normalisation.view.colors; }

  Action Act(const Observation& observation, MotionWay way) override {
    const Eigen::Vector3f hand_m = HandPositionOf(observation.proprioception);
    const CloudGeometry geometry = BuildGeometry(
        observation.cloud, WindowOf(networks_.normalisation, {hand_m.x(), hand_m.y(), hand_m.z()}));
    HeadInputs batch =
        RobotInputs({observation.proprioception, WayThatIsKnown(networks_.normalisation, way)});
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

// Two openers, of doors that are pulled and of doors that are pushed.
class PullAndPush : public TwoWayPolicy {
 public:
  PullAndPush(std::unique_ptr<TwoWayPolicy> pull, std::unique_ptr<TwoWayPolicy> push)
      : pull_(std::move(pull)), push_(std::move(push)) {}

  void Reset() override {
    pull_->Reset();
    push_->Reset();
  }
  Action Act(const Observation& observation, MotionWay way) override {
    return (way == MotionWay::kUsual ? pull_ : push_)->Act(observation, way);
  }
  bool UsesColors() const override { return pull_->UsesColors() || push_->UsesColors(); }

 private:
  std::unique_ptr<TwoWayPolicy> pull_;
  std::unique_ptr<TwoWayPolicy> push_;
};

// The mirror image of an arm is another arm, see mirror.h.
bool HasMirrorImage(const StageNetworks& networks) {
  return networks.normalisation.view.state != StateKind::kJoints;
}

std::unique_ptr<TwoWayPolicy> MakeTwoWay(MotionNetworks learned, const PolicyOptions& options) {
  auto policy = std::make_unique<StagePolicy>(std::move(learned.networks), options);
  if (!learned.pushed) return policy;
  return std::make_unique<PullAndPush>(
      std::move(policy), std::make_unique<StagePolicy>(std::move(*learned.pushed), options));
}

}  // namespace

bool MotionNetworks::KnowsBothWays() const {
  return pushed || doorforge::KnowsBothWays(networks.normalisation);
}

std::optional<fs::path> PushedPolicyIn(const fs::path& opener) {
  fs::path pushed = opener / kPushedFolder;
  if (!fs::exists(pushed)) return std::nullopt;
  return pushed;
}

MotionNetworks ReadMotionNetworks(const fs::path& folder, Stage stage) {
  MotionNetworks learned(ReadPolicy(folder, NameOf(stage)).networks, stage);
  if (stage != Stage::kOpen) return learned;
  if (const auto pushed = PushedPolicyIn(folder))
    learned.pushed = ReadPolicy(*pushed, NameOf(stage)).networks;
  return learned;
}

std::unique_ptr<Policy> MakePolicy(MotionNetworks learned, const PolicyOptions& options,
                                   std::shared_ptr<DoorBelief> belief) {
  Require(options.candidates >= 1 && options.candidates <= 1000, ErrorCode::kInvalidConfig,
          "policy.candidates: must be 1 to 1000");
  const bool has_mirror_image = HasMirrorImage(learned.networks);
  Require(has_mirror_image || (options.told.side != SideChoice::kRight &&
                               options.told.turning != TurningChoice::kReversed),
          ErrorCode::kInvalidConfig,
          "policy.side, policy.turning: a policy that reads the arm's joints knows doors hinged "
          "left and usual handles alone");
  if (!has_mirror_image) belief.reset();
  if (has_mirror_image && !belief)
    belief = std::make_shared<DoorBelief>(options.told, DoorKnowledge{});
  MirroringRole role{learned.stage, learned.KnowsBothWays(), std::move(belief)};
  return std::make_unique<MirroringPolicy>(MakeTwoWay(std::move(learned), options), std::move(role),
                                           options.feel);
}

std::unique_ptr<Policy> LoadPolicy(const fs::path& folder, const PolicyOptions& options,
                                   Stage stage, std::shared_ptr<DoorBelief> belief) {
  return MakePolicy(ReadMotionNetworks(folder, stage), options, std::move(belief));
}

std::shared_ptr<DoorBelief> LoadDoorBelief(const fs::path& opener, const PolicyOptions& options) {
  ToldOfDoor told = options.told;
  DoorKnowledge knowledge;
  bool can_push = false;
  if (!opener.empty()) {
    knowledge.side = ReadSideClassifier(opener);
    knowledge.pushed = ReadHeights(opener / kPushedFolder);
    can_push = ReadMotionNetworks(opener, Stage::kOpen).KnowsBothWays();
  }
  Require(can_push || told.opening != OpeningChoice::kPush || opener.empty(),
          ErrorCode::kInvalidConfig,
          "policy.opening: " + opener.string() +
              " has not learned doors that are pushed; it would lie in its folder \"" +
              kPushedFolder + '"');
  if (!can_push && told.opening == OpeningChoice::kAuto) told.opening = OpeningChoice::kPull;
  return std::make_shared<DoorBelief>(told, knowledge);
}

}  // namespace doorforge
