// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "experts/grasp_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "doorforge/rollout/grasp_plan.h"

namespace doorforge::internal {
namespace {

constexpr double kMissCost = 10;  // a pad that meets nothing
constexpr double kGoodEnough = 0.3;

struct Variation {
  double depth_m = 0;
  double along_m = 0;
  double roll_rad = 0;
};

RigidTransform OffsetGrasp(const RigidTransform& grasp, const Variation& variation) {
  return grasp * Translation({variation.along_m, 0, variation.depth_m}) *
         RotationAbout(Eigen::Vector3d::UnitZ(), variation.roll_rad);
}

// 0 for a flat contact between the middle of the pad and its root.
double ContactCost(const PadContact& contact) {
  const double tilt = 1 - std::abs(contact.normal_in_tcp.y());
  const double beyond_middle = std::max(0.0, contact.point_in_tcp_m.z() - 0.003);
  return 4 * std::max(0.0, tilt - 0.03) + beyond_middle / 0.005 +
         0.1 * std::abs(contact.point_in_tcp_m.x()) / 0.0105;
}

// The gripper, opened that far, at the grasp and on its way there.
double PassageCost(const GraspProbe& probe, const RigidTransform& door_from_tcp,
                   double finger_position_m) {
  constexpr double kGap = 0.002;
  double cost = 0;
  for (int i = 0; i <= 4; ++i) {
    const RigidTransform back = door_from_tcp * Translation({0, 0, -kPregraspDistance * i / 4});
    const double missing = kGap - probe.Clearance(back, finger_position_m, kGap);
    cost = std::max(cost, std::min(missing / 0.001, 5.0));
  }
  return cost;
}

void JudgePassage(const GraspProbe& probe, double widest_m, FingerOpening opening,
                  JudgedGrasp& judged) {
  constexpr double kRoom = 0.006;  // [m] to either side of the handle
  const double wide = PassageCost(probe, judged.door_from_tcp, widest_m);
  const double enough = judged.finger_position_m + kRoom;
  if (opening == FingerOpening::kWide || wide <= 0 || enough >= widest_m) {
    judged.cost += wide;
    return;
  }
  const double narrow = PassageCost(probe, judged.door_from_tcp, enough);
  if (narrow < wide) judged.fingers_open_m = enough;
  judged.cost += std::min(narrow, wide);
}

JudgedGrasp Judge(const GraspProbe& probe, const RobotModel& robot,
                  const RigidTransform& door_from_grasp, const Variation& variation,
                  FingerOpening opening) {
  JudgedGrasp judged;
  judged.door_from_tcp = OffsetGrasp(door_from_grasp, variation);
  const auto left = probe.Close(judged.door_from_tcp, robot.left_finger());
  const auto right = probe.Close(judged.door_from_tcp, robot.right_finger());
  judged.cost = std::abs(variation.depth_m) / 0.1 + std::abs(variation.along_m) / 0.1 +
                std::abs(variation.roll_rad) / 1.75;
  if (!left || !right) {
    judged.cost += kMissCost * ((left ? 0 : 1) + (right ? 0 : 1));
    return judged;
  }
  const double widest = robot.joint(robot.left_finger()).upper;
  const double off_center = (left->finger_position_m - right->finger_position_m) / 2;
  judged.finger_position_m = (left->finger_position_m + right->finger_position_m) / 2;
  judged.door_from_tcp.translate(Eigen::Vector3d(0, off_center, 0));
  judged.cost += ContactCost(*left) + ContactCost(*right) +
                 std::max(0.0, judged.finger_position_m - (widest - 0.004)) / 0.001;
  JudgePassage(probe, widest, opening, judged);
  return judged;
}

std::vector<Variation> Variations(Mechanism mechanism) {
  std::vector<Variation> variations;
  const double roll_step = mechanism == Mechanism::kRound ? 0.26 : 0.17;
  for (const double roll : {0.0, roll_step, -roll_step, 2 * roll_step, -2 * roll_step}) {
    for (const double along : {0.0, 0.008, -0.008, 0.02, -0.02}) {
      for (const double depth : {0.0, -0.006, 0.006, -0.012, 0.012})
        variations.push_back({depth, along, roll});
    }
  }
  return variations;
}

}  // namespace

JudgedGrasp SearchGrasp(const GraspProbe& probe, const DoorAsset& door, const RobotModel& robot,
                        const RigidTransform& door_from_grasp, FingerOpening opening) {
  JudgedGrasp best;
  for (const Variation& variation : Variations(door.mechanism)) {
    const JudgedGrasp judged = Judge(probe, robot, door_from_grasp, variation, opening);
    if (judged.cost < best.cost) best = judged;
    if (best.cost < kGoodEnough) break;
  }
  return best;
}

}  // namespace doorforge::internal
