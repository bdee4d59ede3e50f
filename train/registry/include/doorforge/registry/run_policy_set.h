// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/grasp_from_policy.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy_set.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// An episode's door, robot and camera. The members must outlive what is made with them.
struct EpisodePlace {
  const Scene& scene;
  const DoorAsset& door;
  const RobotModel& robot;
  CloudConfig cloud = {};  ///< What of the camera's picture becomes clouds.
};

/// The set's grasp policy in an episode, which looks once through the scene's camera before the
/// robot comes into view; null where the expert's grasp is taken.
///
/// @throws as CameraObserver.
std::unique_ptr<GraspFromPolicy> GraspOf(const PolicySet& set, const EpisodePlace& place);

/// The camera of who opens and who turns, which remembers the closed door where that is on. The
/// place's door and robot must outlive it.
///
/// @param colors Its clouds have colours.
/// @throws as CameraObserver; Error(kInvalidArgument) as CameraObserver::ColorWith().
std::unique_ptr<CameraObserver> CameraOf(const EpisodePlace& place,
                                         const RememberedViewConfig& remembered, bool colors);

/// The camera that a set's policies are to be shown: with colours where one reads them, and as
/// whoever does all of an episode wants to look. Throws as the other CameraOf().
std::unique_ptr<CameraObserver> CameraOf(const EpisodePlace& place,
                                         const RememberedViewConfig& remembered,
                                         const PolicySet& set);

/// What policies that read colours are shown, wherever they act and learn.
ColorSources PolicyColors(const EpisodePlace& place);

/// Makes the set forget the last episode, and shows it the closed door where that is of use. Before
/// every episode that is not run by RunPolicySet().
///
/// @throws as CameraObserver.
void BeginEpisode(const PolicySet& set, const EpisodePlace& place);

/// Runs the three stages of an episode with the policies of a set and records the opening, as
/// RunStages(); where one does all of it, RunHandEpisode(), without decisions in the record. Where
/// a policy that is Fallible had no action, the outcome is kDiverged and the detail is
/// kPolicyFailed with the reason.
///
/// @param observer Gives the clouds of those who open and turn; may be null.
Episode RunPolicySet(const EpisodePlace& place, const PolicySet& set, Observer* observer);

/// Whether one of the set's policies is Fallible: nobody knows whether it acts alike twice.
bool IsFallible(const PolicySet& set);

/// Whether the set's opener or handler looks at the cloud, which an observer must give then.
bool UsesPointCloud(const PolicySet& set);

/// Whether the set's opener or handler reads the colours of the cloud.
bool UsesColors(const PolicySet& set);

}  // namespace doorforge
