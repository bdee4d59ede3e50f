// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program with networks: doorforge-datagen-trained.

#include <utility>

#include "doorforge/learn/grasp_policy.h"
#include "doorforge/learn/instruction_set.h"
#include "doorforge/learn/stage_policy.h"

#include "trained_policy.h"

namespace doorforge {
namespace {

class TrainedLearnedGrasp : public LearnedGrasp {
 public:
  explicit TrainedLearnedGrasp(std::unique_ptr<GraspPolicy> policy) : policy_(std::move(policy)) {}

  std::optional<ChosenGrasp> Choose(const ClosedDoor& door, const CloudExtent& extent) override {
    GraspView view;
    view.visible = door.visible;
    view.approach = door.approach;
    view.sample = [&](const Eigen::Vector3d& start, double within_m) {
      return SampleCloud(door.visible, start, {extent.point_count, within_m}).cloud;
    };
    view.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
      return door.clearance.Fits(door.visible, contact_m, rotation);
    };
    const std::optional<GraspChoice> choice = policy_->Choose(view);
    if (!choice) return std::nullopt;
    return ChosenGrasp{SampleCloud(door.visible, choice->contact_m, extent).cloud,
                       choice->contact_m, choice->world_from_hand_rotation};
  }

 private:
  std::unique_ptr<GraspPolicy> policy_;
};

}  // namespace

bool RunsTrainedPolicies() { return true; }

std::unique_ptr<Policy> LoadTrainedPolicy(const TrainedPolicy& policy) {
  return LoadPolicy(policy.folder, {}, NameOf(policy.stage));
}

std::unique_ptr<LearnedGrasp> LoadLearnedGrasp(const TrainedPolicy& policy) {
  return std::make_unique<TrainedLearnedGrasp>(LoadGraspPolicy(policy.folder));
}

std::string PolicyArithmetic() { return std::string(NameOf(BestInstructionSet())); }

}  // namespace doorforge
