// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/hand_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// Puts numbers one after the other, in their units.
class FeatureWriter {
 public:
  void Put(double value, double unit = 1) {
    features_.at(at_++) = static_cast<float>(std::clamp(value / unit, -5.0, 5.0));
  }
  void Put(const Eigen::Vector3d& value, double unit = 1) {
    for (const double x : value) Put(x, unit);
  }
  const HandFeatures& features() const { return features_; }

 private:
  HandFeatures features_{};
  std::size_t at_ = 0;
};

// From an axis to a point, square to the axis.
Eigen::Vector3d OffAxis(const Eigen::Vector3d& point, const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& axis) {
  const Eigen::Vector3d arm = point - origin;
  return arm - arm.dot(axis) * axis;
}

}  // namespace

Eigen::Vector3d TurnToGrasp(const HandState& state) {
  const Eigen::Matrix3d grasp = state.world_from_grasp.linear();
  const Eigen::Matrix3d half =
      grasp * RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi).linear();
  const Eigen::Matrix3d back = state.world_from_tcp.linear().transpose();
  const Eigen::Vector3d one = RotationVector(grasp * back);
  const Eigen::Vector3d other = RotationVector(half * back);
  return one.squaredNorm() <= other.squaredNorm() ? one : other;
}

HandFeatures HandFeaturesOf(const HandState& state) {
  const Eigen::Vector3d tool = state.world_from_tcp.translation();
  FeatureWriter writer;
  writer.Put(state.world_from_grasp.translation() - tool, 0.1);
  writer.Put(TurnToGrasp(state), 0.5);
  writer.Put(state.tcp_m_s, 0.2);
  writer.Put(state.tcp_rad_s);
  writer.Put(state.finger_m[0], 0.04);
  writer.Put(state.finger_m[1], 0.04);
  writer.Put((state.finger_m_s[0] + state.finger_m_s[1]) / 2, 0.1);
  writer.Put(state.closes_fingers ? 1 : -1);
  writer.Put(state.hinge_rad, 0.5);
  writer.Put(state.hinge_rad_s, 0.5);
  writer.Put(state.handle_rad, 0.5);
  writer.Put(state.handle_rad_s, 0.5);
  writer.Put(std::max(state.handle_done_rad - state.handle_rad, 0.0), 0.5);
  writer.Put(state.locked ? 1 : 0);
  writer.Put(OffAxis(tool, state.hinge_origin_m, state.hinge_axis), 0.5);
  writer.Put(state.hinge_axis);
  writer.Put(OffAxis(tool, state.handle_origin_m, state.handle_axis), 0.1);
  writer.Put(state.handle_axis);
  writer.Put(Eigen::Vector3d(state.world_from_tcp.linear().col(2)));
  writer.Put(Eigen::Vector3d(state.world_from_tcp.linear().col(1)));
  return writer.features();
}

HandCommand HandCommandOf(std::span<const float> action, const HandState& state,
                          const HandTaskConfig& task) {
  Require(action.size() == kHandActions, ErrorCode::kInvalidArgument,
          "action: " + std::to_string(action.size()) + " numbers, expected " +
              std::to_string(kHandActions));
  const auto clipped = [&](std::size_t i) {
    return std::clamp(static_cast<double>(action[i]), -1.0, 1.0);
  };
  HandCommand command;
  command.move_m = task.move_m * Eigen::Vector3d(clipped(0), clipped(1), clipped(2));
  command.turn_rad = task.turn_rad * Eigen::Vector3d(clipped(3), clipped(4), clipped(5));
  command.close_fingers = state.closes_fingers ? action[6] >= -0.5F : action[6] > 0.5F;
  return command;
}

HandNetworkPolicy::HandNetworkPolicy(const HandPolicyRecord& record)
    : task_(record.task), network_(record.shape, record.parameters) {}

HandCommand HandNetworkPolicy::Act(const HandState& state, const LabelledCloud& /*cloud*/) {
  return HandCommandOf(ActionOf(state), state, task_);
}

std::vector<float> HandNetworkPolicy::ActionOf(const HandState& state) const {
  return network_(HandFeaturesOf(state));
}

}  // namespace doorforge
