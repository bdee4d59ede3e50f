// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "centred_grasp.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/networks/handle_points.h"

namespace doorforge::internal {
namespace {

// What the pads close on, along the way in from the contact.
constexpr double kPadFrontM = -0.015;
constexpr double kPadTipM = 0.022;
constexpr double kPadHalfWidthM = 0.012;
constexpr double kStepM = 0.015;
constexpr double kSpanM = 0.07;

// The hand sees them so, with 0 at the contact.
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

// Those that steps lead to from 0, which is one of them.
std::vector<Eigen::Vector2d> LinkedToContact(std::vector<Eigen::Vector2d> places) {
  std::vector<Eigen::Vector2d> linked = {Eigen::Vector2d::Zero()};
  for (std::size_t i = 0; i < linked.size(); ++i) {
    const Eigen::Vector2d from = linked[i];
    std::erase_if(places, [&](const Eigen::Vector2d& place) {
      const bool near = (place - from).norm() <= kStepM;
      if (near) linked.push_back(place);
      return near;
    });
  }
  return linked;
}

Eigen::AlignedBox2d BoxOf(const std::vector<Eigen::Vector2d>& places) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& place : places) box.extend(place);
  return box;
}

}  // namespace

Eigen::Vector3d CentredContact(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
                               const Eigen::Matrix3d& world_from_hand) {
  std::vector<Eigen::Vector2d> linked =
      LinkedToContact(AtPads(visible, contact_m, world_from_hand));
  const Eigen::AlignedBox2d whole = BoxOf(linked);
  const double sideways = whole.sizes().maxCoeff() <= kSpanM ? whole.center().x() : 0;
  std::erase_if(linked, [&](const Eigen::Vector2d& place) {
    return std::abs(place.x() - sideways) > kPadHalfWidthM;
  });
  const Eigen::AlignedBox2d met = BoxOf(linked);
  const bool spanned = !linked.empty() && met.sizes().y() <= kSpanM;
  const Eigen::Vector2d by(sideways, spanned ? met.center().y() : 0);
  return contact_m + world_from_hand.leftCols<2>() * by;
}

}  // namespace doorforge::internal
