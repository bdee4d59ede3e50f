// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/run_policy_set.h"

#include "doorforge/rollout/grasp_look.h"

namespace doorforge {

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
  return RunStages(place.scene, place.door, place.robot, roles, observer);
}

bool UsesPointCloud(const PolicySet& set) {
  return (set.open && set.open->UsesPointCloud()) || (set.handle && set.handle->UsesPointCloud());
}

}  // namespace doorforge
