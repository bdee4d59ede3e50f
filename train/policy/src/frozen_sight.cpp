// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/frozen_sight.h"

namespace doorforge {

FrozenSight::FrozenSight(const PointNetShape& shape, std::span<const float> parameters,
                         const HandLook& look)
    : look_(look), network_(shape, parameters) {}

std::vector<float> FrozenSight::NumbersOf(const HandState& state,
                                          const LabelledCloud& cloud) const {
  const HandSight sight = HandSightOf(state, cloud);
  std::vector<float> points;
  points.reserve(sight.label.size() * kSightPoint);
  AppendSightPoints(sight.xyz, sight.label, points);
  std::vector<float> numbers = network_.CloudFeatures(points);
  numbers.insert(numbers.end(), sight.own.begin(), sight.own.end());
  return numbers;
}

FrozenSightPolicy::FrozenSightPolicy(const FrozenPolicyRecord& record)
    : task_(record.task),
      sight_(record.sight_shape, record.sight, record.look),
      network_(record.shape, record.parameters) {}

HandCommand FrozenSightPolicy::Act(const HandState& state, const LabelledCloud& cloud) {
  return HandCommandOf(network_(sight_.NumbersOf(state, cloud)), state, task_);
}

}  // namespace doorforge
