// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/grasp_policy.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/handle_points.h"
#include "doorforge/networks/heads.h"
#include "doorforge/policy/grasp_rating.h"
#include "doorforge/policy/handle_finder.h"
#include "doorforge/policy/orientation_sampling.h"
#include "doorforge/policy/policy_file.h"

#include "centred_grasp.h"

namespace doorforge {
namespace {

Eigen::Vector3d PointOf(const std::vector<float>& xyz, std::size_t i) {
  return Eigen::Vector3f(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]).cast<double>();
}

constexpr double kAnotherPlace = 0.02;  // [m]
constexpr double kAnotherTurn = 0.4;    // [rad]
constexpr double kElsewhere = 0.03;     // [m]

// Half a turn about the approach is the same grip of a parallel gripper.
double GripAngle(const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
  const Eigen::Matrix3d round = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  return std::min(RotationVector(one.transpose() * other).norm(),
                  RotationVector(one.transpose() * other * round).norm());
}

bool IsAnother(const std::vector<TriedGrasp>& tried, const Eigen::Vector3d& contact_m,
               const Eigen::Matrix3d& rotation) {
  return std::ranges::none_of(tried, [&](const TriedGrasp& grasp) {
    return (grasp.contact_m - contact_m).norm() < kAnotherPlace &&
           GripAngle(grasp.world_from_hand_rotation, rotation) < kAnotherTurn;
  });
}

// Leaves out the points where a tried hand closed, since a hand turned about the place where one
// has failed mostly fails alike; keeps all where the handle is too small to have another place.
std::vector<std::size_t> Elsewhere(const std::vector<TriedGrasp>& tried,
                                   const std::vector<float>& point_xyz,
                                   const std::vector<std::size_t>& order) {
  std::vector<std::size_t> away;
  std::ranges::copy_if(order, std::back_inserter(away), [&](std::size_t point) {
    return std::ranges::none_of(tried, [&](const TriedGrasp& grasp) {
      return (grasp.contact_m - PointOf(point_xyz, point)).norm() < kElsewhere;
    });
  });
  return away.empty() ? order : away;
}

class NetworkGraspPolicy : public GraspPolicy {
 public:
  NetworkGraspPolicy(StageNetworks networks, const GraspOptions& options)
      : networks_(std::move(networks)),
        options_(options),
        affordance_(networks_.actor_layout(), "encoder.", networks_.actor, BestInstructionSet()),
        head_(networks_),
        rater_(networks_) {}

  bool Explains() const override { return true; }
  bool UsesColors() const override { return networks_.normalisation.view.colors; }

  std::optional<GraspAction> Choose(const GraspObservation& seen) override {
    const LabelledCloud& visible = seen.visible;
    Require(visible.xyz.size() == 3 * visible.label.size(), ErrorCode::kInvalidArgument,
            "grasp: the cloud has " + std::to_string(visible.xyz.size() / 3) + " points and " +
                std::to_string(visible.label.size()) + " labels");
    const std::vector<std::size_t> handle = internal::HandlePointsOf(visible.label);
    if (handle.empty()) return std::nullopt;
    const std::size_t middle = internal::MiddlePoint(visible.xyz, handle);
    GraspExplanation explanation = ScoredPoints(Sample(seen, PointOf(visible.xyz, middle)));
    GraspAction action = BestOf(seen, explanation);
    action.explanation = std::move(explanation);
    return action;
  }

 private:
  // Samples as the clouds were that the networks learned from.
  LabelledCloud Sample(const GraspObservation& seen, const Eigen::Vector3d& start) const {
    return seen.sample(start,
                       static_cast<double>(networks_.normalisation.view.cloud_crop_radius_m));
  }

  // The affordance of the cloud's handle points.
  GraspExplanation ScoredPoints(const LabelledCloud& cloud) const {
    const StageNormalisation& normalisation = networks_.normalisation;
    const CloudWindow window = internal::GraspWindow(normalisation, cloud.xyz);
    const std::array<float, 3> origin = internal::GraspOrigin(normalisation, cloud.xyz);
    const std::vector<std::size_t> handle =
        internal::PointsInWindow(cloud.xyz, window, internal::HandlePointsOf(cloud.label));
    const std::vector<std::uint16_t> outputs(handle.begin(), handle.end());
    GraspExplanation explanation;
    internal::HeadInputs batch;
    batch.size = static_cast<int>(outputs.size());
    batch.features =
        affordance_.Forward(BuildGeometry(cloud, window, outputs, BestInstructionSet())).features;
    for (const std::size_t point : handle) {
      for (std::size_t k = 0; k < 3; ++k) {
        const float coordinate = cloud.xyz[3 * point + k];
        explanation.point_xyz.push_back(coordinate);
        batch.points.push_back((coordinate - origin.at(k) - normalisation.action.mean.at(k)) /
                               normalisation.action.deviation.at(k));
      }
    }
    explanation.affordance_rad = head_.Score(batch);
    return explanation;
  }

  // Points by falling affordance, the first of equals first.
  static std::vector<std::size_t> Ranked(const std::vector<float>& affordance) {
    std::vector<std::size_t> order(affordance.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return affordance[a] > affordance[b]; });
    return order;
  }

  struct Candidate {
    double preference_rad;
    double rating_rad;
    std::size_t point;  // Which of the tried ones.
    Eigen::Matrix3d world_from_hand_rotation;
  };

  // There is one for every orientation at every tried point, `clouds[i]` beginning with the i-th;
  // best first.
  std::vector<Candidate> Candidates(const GraspObservation& seen,
                                    const std::vector<LabelledCloud>& clouds,
                                    const std::vector<double>& affordance_rad) const {
    std::vector<internal::RatedHand> hands;
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      Rng rng(options_.seed, "grasp/orientations/" + std::to_string(i));
      const std::vector<Eigen::Matrix3d> orientations =
          SampleOrientations(seen.approach, {options_.orientations, options_.tilt_rad}, rng);
      const std::vector<float> ratings = rater_.Rate(clouds[i], orientations);
      for (std::size_t k = 0; k < orientations.size(); ++k) {
        hands.push_back(
            {PointOf(clouds[i].xyz, 0), orientations[k], static_cast<double>(ratings[k])});
        points.push_back(i);
      }
    }
    const std::vector<double> smoothed =
        internal::Smoothed(hands, options_.smoothing_rad, options_.smoothing_m);
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k < hands.size(); ++k)
      candidates.push_back({smoothed[k] + options_.affordance_weight * affordance_rad[points[k]],
                            smoothed[k], points[k], hands[k].world_from_hand_rotation});
    std::ranges::stable_sort(candidates, std::greater{}, &Candidate::preference_rad);
    return candidates;
  }

  // Fills in what the explanation has to say of the best.
  GraspAction BestOf(const GraspObservation& seen, GraspExplanation& explanation) const {
    const std::vector<std::size_t> order =
        Elsewhere(seen.tried, explanation.point_xyz, Ranked(explanation.affordance_rad));
    const std::size_t tried = std::min(order.size(), static_cast<std::size_t>(options_.points));
    std::vector<LabelledCloud> clouds;
    std::vector<double> affordance_rad;
    for (std::size_t i = 0; i < tried; ++i) {
      clouds.push_back(Sample(seen, PointOf(explanation.point_xyz, order[i])));
      affordance_rad.push_back(static_cast<double>(explanation.affordance_rad[order[i]]));
    }
    const std::vector<Candidate> candidates = Candidates(seen, clouds, affordance_rad);
    const auto fitting = std::ranges::find_if(candidates, [&](const Candidate& candidate) {
      const Eigen::Vector3d contact_m = ContactOf(seen, clouds[candidate.point], candidate);
      return IsAnother(seen.tried, contact_m, candidate.world_from_hand_rotation) &&
             Fits(seen, contact_m, candidate);
    });
    const Candidate& best = fitting == candidates.end() ? candidates.front() : *fitting;
    explanation.expected_opening_rad = best.rating_rad;
    GraspAction action;
    action.contact_m = ContactOf(seen, clouds[best.point], best);
    action.world_from_hand_rotation = best.world_from_hand_rotation;
    action.cloud = std::move(clouds[best.point]);
    return action;
  }

  bool Fits(const GraspObservation& seen, const Eigen::Vector3d& contact_m,
            const Candidate& candidate) const {
    return !options_.clear || !seen.fits ||
           seen.fits(contact_m, candidate.world_from_hand_rotation);
  }

  Eigen::Vector3d ContactOf(const GraspObservation& seen, const LabelledCloud& cloud,
                            const Candidate& candidate) const {
    const Eigen::Vector3d rated = PointOf(cloud.xyz, 0);
    if (!options_.centred) return rated;
    return internal::CentredContact(seen.visible, rated, candidate.world_from_hand_rotation);
  }

  StageNetworks networks_;
  GraspOptions options_;
  PointEncoder affordance_;
  internal::AffordanceHead head_;
  internal::GraspRater rater_;
};

}  // namespace

std::unique_ptr<GraspPolicy> MakeGraspPolicy(StageNetworks networks, const GraspOptions& options) {
  const auto require = [](bool condition, const char* problem) {
    Require(condition, ErrorCode::kInvalidConfig, std::string("grasp.") + problem);
  };
  require(options.points >= 1 && options.points <= 1000, "points: must be 1 to 1000");
  require(options.orientations >= 1 && options.orientations <= 10000,
          "orientations: must be 1 to 10000");
  require(options.tilt_rad >= 0 && options.tilt_rad < 1, "tilt_rad: must be in [0, 1)");
  require(options.smoothing_rad >= 0 && options.smoothing_rad < 10,
          "smoothing_rad: must be in [0, 10)");
  require(options.smoothing_m >= 0 && options.smoothing_m < 10, "smoothing_m: must be in [0, 10)");
  require(options.affordance_weight >= 0 && options.affordance_weight < 1000,
          "affordance_weight: must be in [0, 1000)");
  Require(networks.family == NetworkFamily::kGrasp, ErrorCode::kInvalidArgument,
          "grasp: the networks are those of another stage");
  auto policy = std::make_unique<NetworkGraspPolicy>(std::move(networks), options);
  if (options.finder.empty()) return policy;
  return std::make_unique<FindingGrasp>(std::move(policy), LoadHandleFinder(options.finder));
}

std::unique_ptr<GraspPolicy> LoadGraspPolicy(const std::filesystem::path& folder,
                                             const GraspOptions& options) {
  return MakeGraspPolicy(ReadPolicy(folder, "grasp").networks, options);
}

}  // namespace doorforge
