// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/hand_sight.h"

#include <algorithm>
#include <utility>

namespace doorforge {
namespace {

constexpr float kSightUnit = 0.1F;  // [m]
constexpr std::array kSightParts = {PointLabel::kHandle, PointLabel::kBody, PointLabel::kFrame,
                                    PointLabel::kRobot};
static_assert(kSightPoint == 3 + static_cast<int>(kSightParts.size()));

// Puts numbers one after the other, in their units.
class OwnWriter {
 public:
  explicit OwnWriter(std::array<float, kSightOwn>& own) : own_(own) {}
  void Put(double value, double unit = 1) {
    own_.at(at_++) = static_cast<float>(std::clamp(value / unit, -5.0, 5.0));
  }
  void Put(const Eigen::Vector3d& value, double unit = 1) {
    for (const double x : value) Put(x, unit);
  }

 private:
  std::array<float, kSightOwn>& own_;
  std::size_t at_ = 0;
};

}  // namespace

HandSight HandSightOf(const HandState& state, const LabelledCloud& cloud) {
  HandSight sight;
  const Eigen::Vector3f tool = state.world_from_tcp.translation().cast<float>();
  sight.xyz.reserve(cloud.xyz.size());
  for (std::size_t i = 0; i < cloud.xyz.size(); ++i)
    sight.xyz.push_back((cloud.xyz[i] - tool[static_cast<Eigen::Index>(i % 3)]) / kSightUnit);
  sight.label = cloud.label;
  if (sight.label.empty()) {
    sight.xyz.assign(3, 0);
    sight.label.assign(1, static_cast<std::uint8_t>(PointLabel::kOther));
  }
  OwnWriter writer(sight.own);
  writer.Put(Eigen::Vector3d(state.world_from_tcp.translation()));
  writer.Put(state.tcp_m_s, 0.2);
  writer.Put(state.tcp_rad_s);
  writer.Put(state.finger_m[0], 0.04);
  writer.Put(state.finger_m[1], 0.04);
  writer.Put((state.finger_m_s[0] + state.finger_m_s[1]) / 2, 0.1);
  writer.Put(state.closes_fingers ? 1 : -1);
  writer.Put(Eigen::Vector3d(state.world_from_tcp.linear().col(2)));
  writer.Put(Eigen::Vector3d(state.world_from_tcp.linear().col(1)));
  return sight;
}

void AppendSightPoints(std::span<const float> xyz, std::span<const std::uint8_t> label,
                       std::vector<float>& numbers) {
  for (std::size_t i = 0; i < label.size(); ++i) {
    numbers.insert(numbers.end(), xyz.begin() + static_cast<std::ptrdiff_t>(3 * i),
                   xyz.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    for (const PointLabel part : kSightParts)
      numbers.push_back(label[i] == static_cast<std::uint8_t>(part) ? 1.0F : 0.0F);
  }
}

PointNetShape SightShape(PointNetShape layers) {
  layers.point = kSightPoint;
  layers.own = kSightOwn;
  layers.outputs = kHandActions;
  return layers;
}

HandSightPolicy::HandSightPolicy(const SightPolicyRecord& record)
    : task_(record.task), look_(record.look), network_(record.shape, record.parameters) {}

HandCommand HandSightPolicy::Act(const HandState& state, const LabelledCloud& cloud) {
  const HandSight sight = HandSightOf(state, cloud);
  std::vector<float> points;
  points.reserve(sight.label.size() * kSightPoint);
  AppendSightPoints(sight.xyz, sight.label, points);
  return HandCommandOf(network_(points, sight.own), state, task_);
}

}  // namespace doorforge
