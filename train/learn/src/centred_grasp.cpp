// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "centred_grasp.h"

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "handle_points.h"

namespace doorforge::internal {
namespace {

// What the pads close on, along the way in from the contact.
constexpr double kPadFrontM = -0.015;
constexpr double kPadTipM = 0.022;
constexpr double kStepM = 0.015;
constexpr double kSpanM = 0.07;

// As the hand sees them, 0 at the contact.
std::vector<Eigen::Vector2d> AtPads(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
                                    const Eigen::Matrix3d& world_from_hand) {
  std::vector<Eigen::Vector2d> places;
  for (const std::size_t i : HandlePointsOf(visible.label)) {
    const Eigen::Vector3f point(visible.xyz[3 * i], visible.xyz[3 * i + 1], visible.xyz[3 * i + 2]);
    const Eigen::Vector3d at = world_from_hand.transpose() * (point.cast<double>() - contact_m);
    if (at.z() >= kPadFrontM && at.z() <= kPadTipM) places.emplace_back(at.head<2>());
  }
  return places;
}

// Those that steps lead to from 0.
Eigen::AlignedBox2d LinkedToContact(std::vector<Eigen::Vector2d> places) {
  Eigen::AlignedBox2d box(Eigen::Vector2d::Zero().eval());
  std::vector<Eigen::Vector2d> open = {Eigen::Vector2d::Zero()};
  while (!open.empty()) {
    const Eigen::Vector2d from = open.back();
    open.pop_back();
    std::erase_if(places, [&](const Eigen::Vector2d& place) {
      if ((place - from).norm() > kStepM) return false;
      box.extend(place);
      open.push_back(place);
      return true;
    });
  }
  return box;
}

}  // namespace

Eigen::Vector3d CentredContact(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
                               const Eigen::Matrix3d& world_from_hand) {
  const Eigen::AlignedBox2d box = LinkedToContact(AtPads(visible, contact_m, world_from_hand));
  Eigen::Vector3d centred = contact_m;
  for (int k = 0; k < 2; ++k) {
    if (box.sizes()[k] <= kSpanM) centred += box.center()[k] * world_from_hand.col(k);
  }
  return centred;
}

}  // namespace doorforge::internal
