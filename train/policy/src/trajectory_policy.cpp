// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/trajectory_policy.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/networks/handle_points.h"

namespace doorforge {
namespace {

constexpr float kElsewhereM = 0.02F;

Eigen::Vector3f PointAt(const std::vector<float>& xyz, std::size_t i) {
  return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
}

// Handle points where no tried hand closed; all of them where there is no such point.
std::vector<std::size_t> Untried(const GraspObservation& seen) {
  const std::vector<std::size_t> handle = internal::HandlePointsOf(seen.visible.label);
  std::vector<std::size_t> left;
  std::ranges::copy_if(handle, std::back_inserter(left), [&](std::size_t point) {
    return std::ranges::none_of(seen.tried, [&](const TriedGrasp& grasp) {
      const Eigen::Vector3f contact = grasp.contact_m.cast<float>();
      return (PointAt(seen.visible.xyz, point) - contact).norm() < kElsewhereM;
    });
  });
  return left.empty() ? handle : left;
}

// The first numbers of a shuffle.
std::vector<std::size_t> Drawn(std::vector<std::size_t> from, int count, Rng& rng) {
  const std::size_t most = std::min(from.size(), static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < most; ++i)
    std::swap(from[i], from[i + rng.Index(static_cast<std::uint32_t>(from.size() - i))]);
  from.resize(most);
  return from;
}

HandWaypoint PlaceAlong(const std::vector<HandWaypoint>& waypoints, double steps) {
  const auto whole = static_cast<std::size_t>(steps);
  if (whole >= waypoints.size()) return waypoints.back();
  const HandWaypoint from = whole == 0 ? HandWaypoint{} : waypoints[whole - 1];
  const HandWaypoint& to = waypoints[whole];
  const double share = steps - static_cast<double>(whole);
  return {from.offset_m + share * (to.offset_m - from.offset_m),
          from.turn_rad + share * (to.turn_rad - from.turn_rad)};
}

Eigen::Matrix3d RotationBy(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return RotationAbout(turn_rad / angle, angle).linear();
}

class TrajectoryGrasp : public GraspPolicy {
 public:
  TrajectoryGrasp(const TrajectoryPolicyRecord& record, std::shared_ptr<TrajectoryReplay> replay)
      : rater_(record.networks),
        look_(record.look),
        choice_(record.choice),
        replay_(std::move(replay)) {}

  bool Explains() const override { return true; }

  std::optional<GraspAction> Choose(const GraspObservation& seen) override {
    std::optional<ChosenTrajectory> chosen = ChooseTrajectory(rater_, seen, look_, choice_);
    if (!chosen) return std::nullopt;
    GraspAction action;
    action.contact_m = chosen->target.contact_m.cast<double>();
    action.world_from_hand_rotation = chosen->trajectory.world_from_hand_rotation;
    GraspExplanation explanation;
    explanation.expected_opening_rad = chosen->probability * choice_.opening_rad;
    explanation.point_xyz = std::move(chosen->contact_xyz);
    for (const float probability : chosen->affordance)
      explanation.affordance_rad.push_back(probability * static_cast<float>(choice_.opening_rad));
    action.explanation = std::move(explanation);
    replay_->Begin(std::move(chosen->trajectory));
    return action;
  }

 private:
  TrajectoryRater rater_;
  TrajectoryLook look_;
  TrajectoryChoice choice_;
  std::shared_ptr<TrajectoryReplay> replay_;
};

/// One of the stages in which a replay goes on.
class ReplayStage : public Policy {
 public:
  explicit ReplayStage(std::shared_ptr<TrajectoryReplay> replay) : replay_(std::move(replay)) {}
  Action Act(const Observation& observation) override { return replay_->Act(observation); }
  bool UsesPointCloud() const override { return false; }

 private:
  std::shared_ptr<TrajectoryReplay> replay_;
};

}  // namespace

void CheckTrajectoryChoice(const TrajectoryChoice& choice, const std::string& path) {
  RequireRange(path, "contacts", choice.contacts, 1, 10000);
  RequireRange(path, "proposals", choice.proposals, 1, 10000);
  RequireRange(path, "opening_rad", choice.opening_rad, 0.01, 3.14);
  RequireRange(path, "actions", choice.actions, 1, 100);
}

std::optional<ChosenTrajectory> ChooseTrajectory(const TrajectoryRater& rater,
                                                 const GraspObservation& seen,
                                                 const TrajectoryLook& look,
                                                 const TrajectoryChoice& choice) {
  std::optional<DoorSight> sight = DoorSightOf(seen, look);
  if (!sight) return std::nullopt;
  Rng rng(seen.seed, "trajectory/" + seen.episode + "/" + std::to_string(seen.tried.size()));
  ChosenTrajectory chosen;
  chosen.sight = *std::move(sight);
  chosen.target.opening_rad = static_cast<float>(choice.opening_rad);
  float best = -1;
  for (const std::size_t point : Drawn(Untried(seen), choice.contacts, rng)) {
    TrajectoryTarget target = chosen.target;
    target.contact_m = PointAt(seen.visible.xyz, point);
    const float affordance = rater.Affordance(chosen.sight, target);
    chosen.contact_xyz.insert(chosen.contact_xyz.end(), target.contact_m.begin(),
                              target.contact_m.end());
    chosen.affordance.push_back(affordance);
    if (affordance <= best) continue;
    best = affordance;
    chosen.target = target;
  }
  const auto proposals = rater.Propose(chosen.sight, chosen.target, choice.proposals, rng);
  const auto most = std::ranges::max_element(proposals.probability);
  chosen.probability = *most;
  chosen.trajectory = TrajectoryFromNumbers(
      proposals.numbers[static_cast<std::size_t>(most - proposals.probability.begin())]);
  return chosen;
}

void TrajectoryReplay::Begin(HandTrajectory trajectory) {
  Require(!trajectory.waypoints.empty(), ErrorCode::kInvalidArgument,
          "trajectory: has no waypoints");
  trajectory_ = std::move(trajectory);
  start_.reset();
  acted_ = 0;
}

Action TrajectoryReplay::Act(const Observation& observation) {
  Require(!trajectory_.waypoints.empty(), ErrorCode::kInvalidArgument,
          "trajectory: nobody has chosen one");
  const Eigen::Vector3d hand_m = HandPositionOf(observation.proprioception).cast<double>();
  if (!start_) {
    start_ = Translation(hand_m);
    start_->linear() = HandRotationOf(observation.proprioception);
  }
  const HandWaypoint place =
      PlaceAlong(trajectory_.waypoints, static_cast<double>(++acted_) / actions_);
  return {start_->translation() + place.offset_m - hand_m,
          RotationBy(place.turn_rad) * start_->linear()};
}

TrajectoryPolicies MakeTrajectoryPolicies(const TrajectoryPolicyRecord& record) {
  const auto replay = std::make_shared<TrajectoryReplay>(record.choice.actions);
  return {std::make_unique<TrajectoryGrasp>(record, replay), std::make_unique<ReplayStage>(replay),
          std::make_unique<ReplayStage>(replay), record.look.finer};
}

}  // namespace doorforge
