// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_episodes.h"

#include <memory>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/rollout/proprioception.h"

namespace doorforge {
namespace {

// The policies' camera, with somebody who looks on.
class WatchedCamera : public Observer {
 public:
  WatchedCamera(CameraObserver& camera, Observer* watcher) : camera_(camera), watcher_(watcher) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    if (watcher_ != nullptr) watcher_->Observe(snapshot);
    return camera_.Observe(snapshot);
  }
  void Watch(const SceneSnapshot& snapshot) override {
    if (watcher_ != nullptr) watcher_->Watch(snapshot);
  }
  bool Follows() const override { return watcher_ != nullptr && watcher_->Follows(); }
  void Follow(const SceneSnapshot& snapshot) override { watcher_->Follow(snapshot); }

 private:
  CameraObserver& camera_;
  Observer* watcher_;
};

}  // namespace

PolicyEpisodes::PolicyEpisodes(PolicySetFactory factory)
    : factory_(std::move(factory)),
      remembered_(factory_.Remembered()),
      sets_([this] { return factory_.Make(); }) {
  sets_.Take();  // what cannot be read is refused here, not in the first episode
}

Episode PolicyEpisodes::Run(const EpisodePlace& place, Observer* watcher) {
  Require(factory_.IsExpertAlone() || HasProprioception(place.robot), ErrorCode::kInvalidArgument,
          "policies know robots with two sliders or a fixed base, seven arm joints and two "
          "fingers, and flying hands; others are for the expert alone");
  const auto set = sets_.Take();
  if (!UsesPointCloud(*set)) return RunPolicySet(place, *set, watcher);
  const auto camera = CameraOf(place, remembered_, *set);
  WatchedCamera watched(*camera, watcher);
  return RunPolicySet(place, *set, &watched);
}

std::vector<SimulatedEpisode> SimulateDoorsWith(const PolicyWords& words,
                                                const PolicySimulateConfig& config,
                                                SimulationRun run) {
  run.config = config;
  PolicyEpisodes episodes(PolicySetFactory(BuiltInPolicies(), words, config.Policies()));
  run.run_episode = [&episodes, cloud = run.config.cloud](const Scene& scene, const DoorAsset& door,
                                                          const RobotModel& robot,
                                                          Observer* watcher) {
    return episodes.Run({scene, door, robot, cloud}, watcher);
  };
  return SimulateDoors(run);
}

}  // namespace doorforge
