// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/run_policy_set.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/pictures/scene_colors.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/hand_stepper.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/fallible.h"

namespace doorforge {
namespace {

// In the order of their stages, so that the first that failed is the one that is told.
std::vector<Fallible*> FallibleOf(const PolicySet& set) {
  std::vector<Fallible*> found = {dynamic_cast<Fallible*>(set.grasp.get()),
                                  dynamic_cast<Fallible*>(set.handle.get()),
                                  dynamic_cast<Fallible*>(set.open.get())};
  std::erase(found, nullptr);
  return found;
}

// Why a policy of the set had no action in the last episode; empty: all had.
std::string FailureOf(const PolicySet& set) {
  for (Fallible* policy : FallibleOf(set)) {
    if (!policy->Failure().empty()) return policy->Failure();
  }
  return "";
}

// A point's colour is that of the pixel's middle: rays to the pixel's corners would add nothing.
constexpr int kPolicyColorSamples = 1;

}  // namespace

std::unique_ptr<GraspFromPolicy> GraspOf(const PolicySet& set, const EpisodePlace& place) {
  if (!set.grasp) return nullptr;
  Scene scene = place.scene;
  if (set.grasp_resolution_scale != 1)
    scene = SceneOf({.resolution_scale = set.grasp_resolution_scale}, scene);
  const auto camera = std::make_shared<CameraObserver>(scene, place.door, place.robot, place.cloud,
                                                       /*sees_robot=*/false);
  if (set.grasp->UsesColors()) camera->ColorWith(PolicyColors(place)(scene, /*sees_robot=*/false));
  return std::make_unique<GraspFromPolicy>(
      *set.grasp, scene, place.door, place.robot,
      [camera](const SceneSnapshot& snapshot) { return camera->Render(snapshot).visible; });
}

std::unique_ptr<CameraObserver> CameraOf(const EpisodePlace& place,
                                         const RememberedViewConfig& remembered, bool colors) {
  auto camera = std::make_unique<CameraObserver>(place.scene, place.door, place.robot, place.cloud);
  std::optional<RememberedView> before;
  if (remembered.IsOn())
    before.emplace(place.scene, place.door, place.robot, place.cloud, remembered);
  if (colors) {
    camera->ColorWith(PolicyColors(place)(place.scene, place.cloud.robot));
    if (before) before->ColorWith(PolicyColors(place));
  }
  if (before) camera->Remember(*std::move(before));
  return camera;
}

std::unique_ptr<CameraObserver> CameraOf(const EpisodePlace& place,
                                         const RememberedViewConfig& remembered,
                                         const PolicySet& set) {
  auto camera = CameraOf(place, remembered, UsesColors(set));
  if (const auto look = set.whole ? set.whole->look() : std::nullopt)
    camera->SampleAs({look->points, look->crop_radius_m});
  return camera;
}

ColorSources PolicyColors(const EpisodePlace& place) {
  return SceneColors(place.door, place.robot, kPolicyColorSamples);
}

void BeginEpisode(const PolicySet& set, const EpisodePlace& place) {
  if (!set.memory) return;
  std::optional<LabelledCloud> before;
  if (set.memory->WantsPicture())
    before = ClosedDoorCloud(place.scene, place.door, place.robot, place.cloud);
  set.memory->Begin(std::move(before));
}

Episode RunPolicySet(const EpisodePlace& place, const PolicySet& set, Observer* observer) {
  if (set.whole) return RunHandEpisode(place.scene, place.door, place.robot, *set.whole, observer);
  BeginEpisode(set, place);
  const std::unique_ptr<GraspFromPolicy> grasp = GraspOf(set, place);
  EpisodePolicies roles{.grasp = grasp.get(), .handle = set.handle.get(), .open = set.open.get()};
  roles.grasps = set.grasps;
  if (set.handle_turned != nullptr)
    roles.handle_turned = [turned = set.handle_turned] {
      return turned->Says() ? std::optional(turned->Turned()) : std::nullopt;
    };
  if (set.memory) roles.gives_up = [memory = set.memory] { return memory->GivesUp(); };
  for (Fallible* policy : FallibleOf(set)) policy->ForgetFailure();
  Episode episode = RunStages(place.scene, place.door, place.robot, roles, observer);
  if (const std::string failure = FailureOf(set); !failure.empty()) {
    episode.outcome = EpisodeOutcome::kDiverged;
    episode.detail = std::string(kPolicyFailed) + failure;
  }
  return episode;
}

bool IsFallible(const PolicySet& set) { return !FallibleOf(set).empty(); }

bool UsesPointCloud(const PolicySet& set) {
  return (set.whole && set.whole->look()) || (set.open && set.open->UsesPointCloud()) ||
         (set.handle && set.handle->UsesPointCloud());
}

bool UsesColors(const PolicySet& set) {
  return (set.open && set.open->UsesColors()) || (set.handle && set.handle->UsesColors());
}

}  // namespace doorforge
