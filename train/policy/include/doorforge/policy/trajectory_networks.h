// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "doorforge/core/rng.h"
#include "doorforge/networks/point_net.h"
#include "doorforge/policy/hand_trajectory.h"
#include "doorforge/schemas/grasp_policy.h"

namespace doorforge {

/// What of one look at a closed door is read: points near the handle, and points of all of it.
struct TrajectoryLook {
  int near_points = 256;  ///< Farthest points first, within near_m of the handle's middle.
  int far_points = 256;   ///< Farthest points first, of all that is seen.
  double near_m = 0.2;
  int finer = 2;  ///< See GraspCameraConfig::resolution_scale.

  int points() const { return near_points + far_points; }
  bool operator==(const TrajectoryLook&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("near_points", self.near_points);
    visit("far_points", self.far_points);
    visit("near_m", self.near_m);
    visit("finer", self.finer);
  }
};

/// Throws Error(kInvalidConfig) that names the first field of `path` that is out of its range.
void CheckTrajectoryLook(const TrajectoryLook& look, const std::string& path);

/// What was seen of a closed door, TrajectoryLook::points() points.
struct DoorSight {
  std::vector<float> xyz;           ///< N x 3 [m], world.
  std::vector<std::uint8_t> label;  ///< PointLabel of each.
};

/// Nothing where no point of the handle is in view. Throws Error(kInvalidArgument) on a cloud
/// without labels.
std::optional<DoorSight> DoorSightOf(const GraspObservation& seen, const TrajectoryLook& look);

/// Numbers of a point that the networks read: from the contact along the world's axes [0.05 m],
/// clipped to [-3, 3], and again [0.5 m]; 1 for the part among handle, leaf and frame that it is
/// of, else 0.
inline constexpr int kDoorPoint = 9;
void AppendDoorPoints(const DoorSight& sight, const Eigen::Vector3f& contact_m,
                      std::vector<float>& numbers);

/// What is asked for: to take hold about a point and open the door by an angle. Four numbers: the
/// contact [m] in the world, the angle [rad].
struct TrajectoryTarget {
  Eigen::Vector3f contact_m = Eigen::Vector3f::Zero();  ///< A point that is seen.
  float opening_rad = 0;
};
inline constexpr int kTargetNumbers = 4;
void AppendTarget(const TrajectoryTarget& target, std::vector<float>& numbers);

/// Sizes of the networks of one training.
struct TrajectoryShape {
  int waypoints = 12;
  int latent = 32;
  int point_hidden = 64;  ///< These as in PointNetShape, of all three networks.
  int point_features = 256;
  int cloud_hidden = 256;
  int cloud_features = 128;
  int hidden = 256;
  int last_hidden = 128;

  bool operator==(const TrajectoryShape&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("waypoints", self.waypoints);
    visit("latent", self.latent);
    visit("point_hidden", self.point_hidden);
    visit("point_features", self.point_features);
    visit("cloud_hidden", self.cloud_hidden);
    visit("cloud_features", self.cloud_features);
    visit("hidden", self.hidden);
    visit("last_hidden", self.last_hidden);
  }
};

/// Throws as CheckTrajectoryLook().
void CheckTrajectoryShape(const TrajectoryShape& shape, const std::string& path);

/// Says a trajectory: the decoder of a conditional variational autoencoder. It reads a cloud, a
/// target and `latent` numbers, drawn from N(0, 1).
PointNetShape ProposerShape(const TrajectoryShape& shape);
/// Says how likely a trajectory is to do what is asked for, as a logit. It reads a cloud, a target
/// and a trajectory's numbers.
PointNetShape CriticShape(const TrajectoryShape& shape);
/// Says how likely the best proposals at a contact are to do it, as a logit. It reads a cloud and a
/// target.
PointNetShape AffordanceShape(const TrajectoryShape& shape);
/// The autoencoder's encoder, which training alone reads: "posterior.0" and "posterior.1" with ELU,
/// "posterior.2": of the proposer's features of a cloud, a target and a trajectory's numbers the
/// means and log variances of the latent numbers.
ParameterLayout PosteriorLayout(const TrajectoryShape& shape);

/// Flat vectors of these layouts.
struct TrajectoryNetworks {
  TrajectoryShape shape;
  std::vector<float> proposer;
  std::vector<float> posterior;  ///< Empty in a policy.
  std::vector<float> critic;
  std::vector<float> affordance;
};

TrajectoryNetworks InitialTrajectoryNetworks(const TrajectoryShape& shape, std::uint64_t seed);

/// Runs them by this library's own kernels. Immutable; serves several threads.
class TrajectoryRater {
 public:
  /// @throws Error(kInvalidArgument) unless there are as many parameters as the layouts have.
  explicit TrajectoryRater(const TrajectoryNetworks& networks);

  /// A probability.
  float Affordance(const DoorSight& sight, const TrajectoryTarget& target) const;

  struct Proposals {
    std::vector<std::vector<float>> numbers;  ///< Of each trajectory.
    std::vector<float> probability;           ///< That it does what is asked for, by the critic.
  };
  /// @param rng The latent numbers are drawn from it.
  Proposals Propose(const DoorSight& sight, const TrajectoryTarget& target, int count,
                    Rng& rng) const;

 private:
  TrajectoryShape shape_;
  PointNet proposer_;
  PointNet critic_;
  PointNet affordance_;
};

/// What the affordance learns of a contact: the mean of the five greatest probabilities, or of all
/// where there are fewer (VAT-MART). Not empty.
float MeanOfBest(std::vector<float> probability);

}  // namespace doorforge
