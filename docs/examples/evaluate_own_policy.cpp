// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Evaluates a policy of one's own as `doorforge eval` evaluates a trained one: the same doors,
// scenes, table with intervals and causes of failure, and the same report. One command:
//
//   evaluate_own_policy --doors run/doors --split full:test -n 50 --seeds 3 --out run/report

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
  bool Looks() const override { return false; }  // it needs no picture
};

int main(int argc, char** argv) {
  return doorforge::RunEvalVerb(argc, argv, {.name = "circle_about_hinge", .make_open = [] {
                                               return std::make_unique<CircleAboutHinge>();
                                             }});
}
