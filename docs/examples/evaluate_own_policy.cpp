// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Evaluates policies of one's own as `doorforge eval` evaluates trained ones: the same doors,
// scenes, table with intervals and causes of failure, and the same report. A policy is a class and
// a row of the registry, whose name the options take:
//
//   evaluate_own_policy --doors run/doors --split full:test -n 50 --seeds 3 --out run/report
//   evaluate_own_policy --grasper middle_of_handle --opener expert --doors run/doors

#include "doorforge/core/rigid_transform.h"
#include "doorforge/verbs/eval_verb.h"

// Leads the hand on a circle about the hinge, a little ahead of where it is.
class CircleAboutHinge : public doorforge::Policy {
 public:
  doorforge::Action Act(const doorforge::Observation& seen) override {
    constexpr double kLeadRad = 0.08;
    const doorforge::PrivilegedState& state = seen.privileged;  // a trained policy reads seen.cloud
    const auto turn = doorforge::RotationAbout(state.hinge_axis_in_world, kLeadRad);
    const Eigen::Vector3d hand = state.world_from_hand.translation();
    const Eigen::Vector3d arm = hand - state.hinge_origin_in_world;
    return {turn.linear() * arm - arm, turn.linear() * state.world_from_hand.linear()};
  }
  bool UsesPointCloud() const override { return false; }  // it needs no picture
};

// Takes hold of the middle of what is seen of the handle, straight in and upright.
class MiddleOfHandle : public doorforge::GraspPolicy {
 public:
  std::optional<doorforge::GraspAction> Choose(const doorforge::GraspObservation& seen) override {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (std::size_t i = 0; i < seen.visible.label.size(); ++i) {
      if (seen.visible.label[i] != static_cast<std::uint8_t>(doorforge::PointLabel::kHandle))
        continue;
      for (int axis = 0; axis < 3; ++axis)
        sum[axis] += static_cast<double>(seen.visible.xyz[3 * i + static_cast<std::size_t>(axis)]);
      ++count;
    }
    if (count == 0) return std::nullopt;
    doorforge::GraspAction action;
    action.contact_m = sum / count;
    // the hand's z goes in, the fingers close along its y: here up and down, about a level lever
    action.world_from_hand_rotation.col(2) = seen.approach;
    action.world_from_hand_rotation.col(1) = Eigen::Vector3d::UnitZ();
    action.world_from_hand_rotation.col(0) = Eigen::Vector3d::UnitZ().cross(seen.approach);
    return action;
  }
};

int main(int argc, char** argv) {
  doorforge::EvalVerbSetup setup{.program = "evaluate_own_policy", .opener = "circle_about_hinge"};
  setup.registry.Add(
      doorforge::MotionPolicyRow{doorforge::Stage::kOpen, "circle_about_hinge",
                                 [](const auto&) { return std::make_unique<CircleAboutHinge>(); }});
  setup.registry.Add(doorforge::GraspPolicyRow{
      "middle_of_handle", [](const auto&) { return std::make_unique<MiddleOfHandle>(); }});
  return doorforge::RunEvalVerb(argc, argv, setup);
}
