// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>

#include "doorforge/networks/stage_networks.h"
#include "doorforge/schemas/grasp_policy.h"

namespace doorforge {

/// How a trained grasp is chosen.
struct GraspOptions {
  /// Points with the highest affordance at which orientations are tried; the best pair is taken. 1:
  /// the affordance alone decides about the point (UniDoorManip).
  int points = 8;
  int orientations = 100;  ///< Tried at each of them.
  /// See OrientationSampling; 0: all lie in the plane normal to the handle's axis (UniDoorManip). A
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
  /// Hands that do not fit, as GraspObservation::fits says, are left out, as long as there are
  /// others.
  bool clear = true;
  std::uint64_t seed = 1;  ///< The sampled orientations are drawn from it.
  /// A folder that `doorforge train find` wrote: which points are the handle and the way into the
  /// leaf are found by it (FindingGrasp) where a policy is loaded. Empty: they are told. Written
  /// into files only where there is one.
  std::string finder = {};

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
    if (!std::is_const_v<Self> || !self.finder.empty()) visit("finder", self.finder);
  }
};

/// A trained affordance and discriminator choose where and how to take hold; they look at clouds of
/// the extent that they were trained on and explain their actions.
///
/// Loads it from the folder that `doorforge train grasp` wrote, with GraspOptions::finder.
/// @throws Error(kMissing or kFormat) as ReadPolicy(), Error(kInvalidConfig) on bad options.
std::unique_ptr<GraspPolicy> LoadGraspPolicy(const std::filesystem::path& folder,
                                             const GraspOptions& options = {});
/// Makes it of networks of the family kGrasp in memory, with GraspOptions::finder.
std::unique_ptr<GraspPolicy> MakeGraspPolicy(StageNetworks networks,
                                             const GraspOptions& options = {});

}  // namespace doorforge
