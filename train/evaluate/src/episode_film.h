// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/physics/robot_model.h"
#include "doorforge/report/report_page.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/scene.h"

namespace doorforge::internal {

/// Remembers where everything was during an episode, for pictures afterwards, and hands on what
/// another observer sees.
class EpisodeFilm : public Observer {
 public:
  /// `camera` may be null: then the policy sees an empty cloud.
  explicit EpisodeFilm(std::unique_ptr<Observer> camera) : camera_(std::move(camera)) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override;
  void Watch(const SceneSnapshot& snapshot) override;

  /// Place and name of an instant.
  struct Frame {
    SceneSnapshot snapshot;
    std::string caption;  ///< "grasped, 1.5 s"
  };
  /// At most five: start, grasped, unlocked, half way through the opening, end; fewer if the
  /// episode ended early.
  std::vector<Frame> Frames() const;

  bool HasDecision() const { return !first_decision_.empty(); }
  /// When the policy looked for the first time; only if HasDecision().
  const SceneSnapshot& FirstDecision() const { return first_decision_.front(); }

 private:
  std::unique_ptr<Observer> camera_;
  std::vector<SceneSnapshot> watched_;
  std::vector<SceneSnapshot> first_decision_;  ///< None or one.
};

/// The frames as PNG with their captions, seen from the hinge's side of the robot.
std::vector<ReportPicture> RenderFrames(const std::vector<EpisodeFilm::Frame>& frames,
                                        const Scene& scene, const DoorAsset& door,
                                        const RobotModel& robot);

}  // namespace doorforge::internal
