// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/run_policy_set.h"

#include <string>
#include <vector>

#include "doorforge/rollout/grasp_look.h"
#include "doorforge/schemas/fallible.h"

namespace doorforge {
namespace {

std::vector<const Fallible*> FallibleOf(const PolicySet& set) {
  std::vector<const Fallible*> found;
  for (const Policy* policy : {set.handle.get(), set.open.get()}) {
    const auto* fallible = dynamic_cast<const Fallible*>(policy);
    if (fallible != nullptr) found.push_back(fallible);
  }
  return found;
}

// Why a policy of the set had no action in the last episode; empty: all had.
std::string FailureOf(const PolicySet& set) {
  for (const Fallible* policy : FallibleOf(set)) {
    if (!policy->Failure().empty()) return policy->Failure();
  }
  return "";
}

}  // namespace

std::unique_ptr<GraspFromPolicy> GraspOf(const PolicySet& set, const EpisodePlace& place) {
  if (!set.grasp) return nullptr;
  Scene scene = place.scene;
  if (set.grasp_resolution_scale != 1)
    scene = SceneOf({.resolution_scale = set.grasp_resolution_scale}, scene);
  const auto camera = std::make_shared<CameraObserver>(scene, place.door, place.robot, place.cloud,
                                                       /*sees_robot=*/false);
  return std::make_unique<GraspFromPolicy>(
      *set.grasp, scene, place.door, place.robot,
      [camera](const SceneSnapshot& snapshot) { return camera->Look(snapshot).visible; });
}

std::unique_ptr<CameraObserver> CameraOf(const EpisodePlace& place,
                                         const RememberedViewConfig& remembered) {
  auto camera = std::make_unique<CameraObserver>(place.scene, place.door, place.robot, place.cloud);
  if (remembered.IsOn())
    camera->Remember({place.scene, place.door, place.robot, place.cloud, remembered});
  return camera;
}

Episode RunPolicySet(const EpisodePlace& place, const PolicySet& set, Observer* observer) {
  const std::unique_ptr<GraspFromPolicy> grasp = GraspOf(set, place);
  EpisodeRoles roles{.grasp = grasp.get(), .handle = set.handle.get(), .open = set.open.get()};
  if (set.handle_turned != nullptr)
    roles.predicted_turned = [turned = set.handle_turned] { return turned->Turned(); };
  Episode episode = RunStages(place.scene, place.door, place.robot, roles, observer);
  if (const std::string failure = FailureOf(set); !failure.empty()) {
    episode.outcome = EpisodeOutcome::kDiverged;
    episode.detail = std::string(kPolicyFailed) + failure;
  }
  return episode;
}

bool IsFallible(const PolicySet& set) { return !FallibleOf(set).empty(); }

bool UsesPointCloud(const PolicySet& set) {
  return (set.open && set.open->UsesPointCloud()) || (set.handle && set.handle->UsesPointCloud());
}

}  // namespace doorforge
