// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "doorforge/networks/stage_networks.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// How a trained grasp is chosen.
struct GraspOptions {
  /// Points with the highest affordance at which orientations are tried; the best pair is taken. 1:
  /// the affordance alone decides about the point (UniDoorManip).
  int points = 8;
  int orientations = 100;  ///< Tried at each of them.
  /// As in OrientationSampling; 0: all in the plane normal to the handle's axis (UniDoorManip). A
  /// spread is there to learn from: the discriminator overrates the few that lean the most.
  double tilt_rad = 0;
  /// A hand's rating is the mean of all that were rated, each weighted by exp(-(angle between them
  /// / smoothing_rad)^2 - (distance of their contacts / smoothing_m)^2), alike fingers alike. The
  /// best of many ratings is the luckiest one; among neighbours luck evens out. 0 and 0: its own
  /// alone (UniDoorManip); smoothing_m 0: those of its point alone.
  double smoothing_rad = 0.25;
  double smoothing_m = 0.01;
  /// What the affordance of its point counts beside a hand's rating when the best is sought: two
  /// networks are seldom wrong alike. 0: the discriminator decides alone (UniDoorManip).
  double affordance_weight = 1;
  /// The hand is moved across the way in, to the middle of what is seen of the handle between its
  /// fingers. False: it closes about the contact (UniDoorManip).
  bool centred = true;
  /// Hands that do not fit, as GraspView::fits says, are left out, as long as there are others.
  bool clear = true;
  std::uint64_t seed = 1;  ///< Of the sampled orientations.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("points", self.points);
    visit("orientations", self.orientations);
    visit("tilt_rad", self.tilt_rad);
    visit("smoothing_rad", self.smoothing_rad);
    visit("smoothing_m", self.smoothing_m);
    visit("affordance_weight", self.affordance_weight);
    visit("centred", self.centred);
    visit("clear", self.clear);
    visit("seed", self.seed);
  }
};

/// What is known when a grasp is chosen: one look at the closed door, of which the handle's mask
/// and the direction into the leaf are privileged, as the handle's mask and axis are in
/// UniDoorManip.
struct GraspView {
  LabelledCloud visible;  ///< Every point in view; those labelled kHandle may be taken hold of.
  /// World: straight into the leaf, which for all handles but flaps is the handle's axis.
  Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
  /// The policy's cloud of 4096 points, beginning with the visible point nearest to a place in the
  /// world, of points within a distance of that one [m] (0: of all; farthest point sampling).
  std::function<LabelledCloud(const Eigen::Vector3d&, double)> sample;
  /// Whether the open gripper gets to a contact [m] with that rotation (world from hand) without
  /// passing through what is seen. Empty: it always does.
  std::function<bool(const Eigen::Vector3d&, const Eigen::Matrix3d&)> fits = nullptr;
};

struct GraspChoice {
  LabelledCloud cloud;  ///< 4096 points, point 0 is the one that was rated.
  /// World: that point, moved as GraspOptions::centred says.
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
  double score_rad = 0;  ///< Final door angle that the discriminator expects.
  /// The affordance of every handle point of the cloud that was looked at: a heat map.
  std::vector<float> point_xyz;       ///< [m], world, n x 3.
  std::vector<float> affordance_rad;  ///< n.
};

/// Chooses where and how to take hold, by a trained affordance and discriminator. Keeps nothing
/// between calls: equal views give equal choices. One instance serves one thread at a time.
class GraspPolicy {
 public:
  virtual ~GraspPolicy() = default;
  /// Nothing where no point of the handle is in view.
  /// @throws Error(kInvalidArgument) if the cloud's labels are missing or its numbers not finite,
  /// or
  ///     as SampleOrientations().
  virtual std::optional<GraspChoice> Choose(const GraspView& view) = 0;
};

/// Of the folder that `doorforge train grasp` wrote.
/// @throws Error(kMissing or kFormat) as ReadPolicy(), Error(kInvalidConfig) on bad options.
std::unique_ptr<GraspPolicy> LoadGraspPolicy(const std::filesystem::path& folder,
                                             const GraspOptions& options = {});
/// The same of networks of the family kGrasp in memory.
std::unique_ptr<GraspPolicy> MakeGraspPolicy(StageNetworks networks,
                                             const GraspOptions& options = {});

}  // namespace doorforge
