// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/record_sight.h"

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/pinhole_view.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kJoints = 11;

std::string Number(double value, const char* format = "%.9g") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

template <class Values>
std::string List(const Values& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + Number(value);
  return text + "]";
}

std::string PoseText(const RigidTransform& pose) {
  const Eigen::Quaterniond turn(pose.linear());
  return "{position_m: " + List(pose.translation()) + ", quaternion_xyzw: " + List(turn.coeffs()) +
         "}";
}

std::string CameraText(const PinholeView& view) {
  return "width: " + std::to_string(view.width) + "\nheight: " + std::to_string(view.height) +
         "\nfx: " + Number(view.fx) + "\nfy: " + Number(view.fy) + "\ncx: " + Number(view.cx) +
         "\ncy: " + Number(view.cy) +
         "\npixel_centre: 0.5  # the first pixel's centre is (0.5, 0.5)\ndepth_unit_m: 0.001\n"
         "world_from_camera: " +
         PoseText(view.world_from_camera) + "\n";
}

std::string StateText(const Decision& decision, const Scene& scene, bool unlocked) {
  std::vector<double> positions;
  std::vector<double> velocities;
  for (std::size_t i = 0; i < kJoints; ++i) {
    positions.push_back(decision.state.at(i));
    velocities.push_back(static_cast<double>(decision.proprioception.at(kJoints + i)));
  }
  return "joint_positions: " + List(positions) + "\njoint_velocities: " + List(velocities) +
         "\nworld_from_base: " + PoseText(scene.world_from_robot_base) +
         "\nunlocked: " + (unlocked ? "true" : "false") + "\n";
}

// The door closed and the robot out of view, as an episode begins.
class Onlooker : public SnapshotGraspPolicy {
 public:
  Onlooker(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
      : camera_(scene, door, robot, {}, /*sees_robot=*/false) {}
  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    depth = camera_.Render(snapshot).depth;
    return std::nullopt;  // nothing more of this episode is wanted
  }

  DepthImage depth;

 private:
  CameraObserver camera_;
};

// Keeps the picture of every recorded decision.
class Photographer : public Observer {
 public:
  Photographer(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
      : camera_(scene, door, robot) {}
  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    CameraFrame frame = camera_.Render(snapshot);
    depths.push_back(std::move(frame.depth));
    return std::move(frame.sampled.cloud);
  }

  std::vector<DepthImage> depths;

 private:
  CameraObserver camera_;
};

PixelMask HandleOf(const DepthImage& depth) {
  PixelMask mask{depth.width, depth.height, {}};
  mask.set.reserve(depth.label.size());
  for (const std::uint8_t label : depth.label)
    mask.set.push_back(label == static_cast<std::uint8_t>(PointLabel::kHandle) ? 1 : 0);
  return mask;
}

std::string Numbered(const std::string& name, std::size_t i, const std::string& extension) {
  if (i == 0) return name + extension;
  return name + "_" + Number(static_cast<double>(i), "%03.0f") + extension;
}

/// One door, one episode, one folder.
class Recorder {
 public:
  Recorder(const IdentifiedDoor& door, const SightRequest& request, fs::path folder)
      : door_(*door),
        all_(request.all_decisions),
        folder_(std::move(folder)),
        robot_(LoadMobileFranka()),
        scene_(PlaceRobotBase(
            robot_, SampleScene(door, request.seed, request.episode, request.scene), *door)) {}

  void WriteGrasp() {
    const Scene close = SceneOf(GraspCameraConfig{}, scene_);
    Onlooker onlooker(close, door_, robot_);
    OpeningExpert opener;
    RunStages(scene_, door_, robot_, {.grasp = &onlooker, .open = &opener}, nullptr);
    const fs::path out = folder_ / "grasp";
    WriteDepthPng(out / "depth.png", onlooker.depth);
    CommitFile(out / "mask.png", EncodeMaskPng(HandleOf(onlooker.depth)));
    CommitFile(out / "camera.yaml", CameraText(ViewOf(close.camera)));
    AddLine({{"depth", (out / "depth.png").string()}, {"handle", (out / "mask.png").string()}});
  }

  int WriteStage(Stage stage) {
    Photographer photographer(scene_, door_, robot_);
    HandleExpert turner;
    OpeningExpert opener;
    const Episode episode =
        RunStages(scene_, door_, robot_, {.recorded = stage, .handle = &turner, .open = &opener},
                  &photographer);
    const fs::path out = folder_ / std::string(NameOf(stage));
    const std::size_t count =
        all_ ? episode.decisions.size() : std::min<std::size_t>(1, episode.decisions.size());
    if (count > 0) CommitFile(out / "camera.yaml", CameraText(ViewOf(scene_.camera)));
    for (std::size_t i = 0; i < count; ++i) {
      const fs::path depth = out / Numbered("depth", i, ".png");
      const fs::path state = out / Numbered("state", i, ".yaml");
      WriteDepthPng(depth, photographer.depths.at(i));
      CommitFile(state, StateText(episode.decisions[i], scene_, stage == Stage::kOpen));
      AddLine({{"depth", depth.string()}, {"state", state.string()}});
    }
    if (stage == Stage::kOpen && count == 0)
      throw Error(ErrorCode::kInvalidArgument,
                  "door \"" + door_.id + "\": the rules did not come to opening it (" +
                      episode.detail + "); take another --seed or --episode");
    return static_cast<int>(count);
  }

  void WriteLines() const {
    if (all_) CommitFile(folder_ / "lines", lines_);
  }

 private:
  void AddLine(const nlohmann::ordered_json& request) { lines_ += JsonText(request) + "\n"; }

  const DoorAsset& door_;
  bool all_;
  fs::path folder_;
  RobotModel robot_;
  Scene scene_;
  std::string lines_;
};

}  // namespace

RecordedSight RecordSight(const IdentifiedDoor& door, const SightRequest& request,
                          const fs::path& folder) {
  Recorder recorder(door, request, folder);
  RecordedSight recorded;
  recorder.WriteGrasp();
  recorded.handle_decisions = recorder.WriteStage(Stage::kHandle);
  recorded.open_decisions = recorder.WriteStage(Stage::kOpen);
  recorder.WriteLines();
  return recorded;
}

}  // namespace doorforge
