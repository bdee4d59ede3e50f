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
#include "doorforge/schemas/grasp_policy.h"

namespace doorforge {

/// Where the handle of a door is, told from what is seen of it.
struct FoundHandle {
  std::vector<bool> is_handle;                         ///< One for each visible point.
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< World: the mean of its points.
  /// World, unit: straight into the leaf, the normal of the plane that most of the points about the
  /// handle lie in, away from the robot (its x is not above 0).
  Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
};

/// Samples the cloud that a handle is sought in, as GraspObservation::sample.
using SampleAbout = std::function<LabelledCloud(const Eigen::Vector3d&, double)>;

/// Finds the handle of a closed door in the cloud of one camera, before the robot is in view: a
/// network that sees the whole door says where it is, another one that sees what is near says which
/// points are its. Reads positions alone: no label, no colour, nothing of the door. Immutable;
/// equal clouds give equal answers.
class HandleFinder {
 public:
  /// @throws Error(kInvalidArgument) for networks of another family than kFind.
  explicit HandleFinder(StageNetworks networks);
  ~HandleFinder();
  HandleFinder(HandleFinder&&) noexcept;
  HandleFinder& operator=(HandleFinder&&) noexcept;

  /// Nothing where no point looks like a handle's.
  ///
  /// @param visible Every point in view; its labels are not read.
  /// @param sample Gives 4096 of them.
  std::optional<FoundHandle> Find(const LabelledCloud& visible, const SampleAbout& sample) const;

 private:
  struct Networks;
  std::unique_ptr<const Networks> networks_;
};

/// Loads it from the folder that `doorforge train find` wrote.
/// @throws Error(kMissing or kFormat) as ReadPolicy().
HandleFinder LoadHandleFinder(const std::filesystem::path& folder);

/// Unit normal of the plane that most of the points lie in, to within 6 mm: the best of a fixed
/// number of planes through three of them (RANSAC, Fischler and Bolles 1981), then of least squares
/// through those that lie in it. Its x is not above 0. Deterministic.
///
/// @param points Three and more, not all on a line; [m], world.
/// @returns -x where no three of them span a plane.
Eigen::Vector3d DominantNormal(const std::vector<Eigen::Vector3f>& points);

/// Lets a grasp policy act on what a finder finds: labels and approach are not what it was told but
/// what is found; nothing is taken hold of where no handle is found. The policy is shown no other
/// label than kHandle and kOther.
class FindingGrasp : public GraspPolicy {
 public:
  /// @param policy Not null.
  FindingGrasp(std::unique_ptr<GraspPolicy> policy, HandleFinder finder)
      : policy_(std::move(policy)), finder_(std::move(finder)) {}

  std::optional<GraspAction> Choose(const GraspObservation& seen) override;
  bool Explains() const override { return policy_->Explains(); }
  bool UsesColors() const override { return policy_->UsesColors(); }

 private:
  std::unique_ptr<GraspPolicy> policy_;
  HandleFinder finder_;
};

}  // namespace doorforge
