// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/episode_strip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "doorforge/core/error.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/sensor/scene_picture.h"

#include "text_format.h"

namespace doorforge {
namespace {

struct Moment {
  SceneSnapshot snapshot;
  StripFrame frame;
};

double TurnOf(const DoorJoint& joint, const RigidTransform& parent, const RigidTransform& child) {
  const Eigen::Matrix3d turned = joint.parent_from_child_at_zero.linear().transpose() *
                                 parent.linear().transpose() * child.linear();
  return joint.axis.dot(RotationVector(turned));
}

// Keeps where everything was whenever the episode shows itself.
class Recorder final : public Observer {
 public:
  explicit Recorder(const DoorAsset& door) : door_(door) {}

  LabelledCloud Observe(const SceneSnapshot&) override { return {}; }
  void Watch(const SceneSnapshot& snapshot) override {
    const auto& links = snapshot.door;
    moments.push_back({snapshot,
                       {std::string(NameOf(snapshot.phase)), snapshot.time_s,
                        TurnOf(door_.hinge, links[kBaseLink], links[kLeafLink]),
                        TurnOf(door_.handle_joint, links[kLeafLink], links[kHandleLink])}});
  }

  std::vector<Moment> moments;

 private:
  const DoorAsset& door_;
};

// All stages before the opening, then the moments of it that are nearest to equal steps.
std::vector<Moment> ChooseFrames(const std::vector<Moment>& moments, int frames) {
  std::vector<Moment> chosen;
  std::vector<Moment> opening;
  for (const Moment& moment : moments) {
    const EpisodePhase phase = moment.snapshot.phase;
    const bool opens = phase == EpisodePhase::kOpen || phase == EpisodePhase::kEnd;
    (opens ? opening : chosen).push_back(moment);
  }
  if (!chosen.empty()) chosen.erase(chosen.begin());  // the start says little
  const int left = std::max(frames - static_cast<int>(chosen.size()), 1);
  // the first moment of the opening is the last of the stage before
  for (int i = 1; i <= left && !opening.empty(); ++i) {
    const double angle = opening.back().frame.hinge_rad * i / left;
    const auto nearest =
        std::min_element(opening.begin(), opening.end(), [&](const Moment& a, const Moment& b) {
          return std::abs(a.frame.hinge_rad - angle) < std::abs(b.frame.hinge_rad - angle);
        });
    if (chosen.empty() || chosen.back().snapshot.time_s < nearest->snapshot.time_s)
      chosen.push_back(*nearest);
  }
  return chosen;
}

int Degrees(double radians) { return static_cast<int>(std::lround(radians / internal::kDegree)); }

std::string CaptionOf(const StripFrame& frame) {
  char text[96];
  std::snprintf(text, sizeof text, "%s %.1f s, hinge %d, handle %d deg", frame.stage.c_str(),
                frame.time_s, Degrees(frame.hinge_rad), Degrees(frame.handle_rad));
  return text;
}

std::string ShortCaptionOf(const StripFrame& frame) {
  return frame.stage + " " + std::to_string(Degrees(frame.hinge_rad)) + " / " +
         std::to_string(Degrees(frame.handle_rad)) + " deg";
}

CameraModel Tile(int width) {
  CameraModel view;
  view.width = width;
  view.height = width * 5 / 6;
  return view;
}

// 1 where the hinge is on the side of negative y of the grasp, which is where most are.
double HingeSide(const DoorAsset& door) {
  const double grasp =
      (DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp).translation().y();
  return door.hinge.parent_from_child_at_zero.translation().y() < grasp ? 1 : -1;
}

CameraModel SideView(const Scene& scene, const DoorAsset& door, int width) {
  const Eigen::Vector3d grasp = scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
                                door.handle_from_grasp.translation();
  CameraModel view = Tile(width);
  const double side = HingeSide(door);
  view.horizontal_fov_rad = 0.9;
  view.target_m = grasp + Eigen::Vector3d(0.25, -0.1 * side, -0.1);
  view.position_m = view.target_m + Eigen::Vector3d(1.0, -1.6 * side, 0.75);
  return view;
}

// From above the lever, on the hinge's side, so that pads and handle are both in view.
CameraModel HandleView(const Moment& moment, const DoorAsset& door, int width) {
  const Eigen::Vector3d grasp =
      moment.snapshot.door[kHandleLink] * door.handle_from_grasp.translation();
  CameraModel view = Tile(width);
  view.horizontal_fov_rad = 0.6;
  view.target_m = grasp;
  view.position_m = grasp + moment.snapshot.door[kLeafLink].linear() *
                                Eigen::Vector3d(0.30, -0.35 * HingeSide(door), 0.35);
  return view;
}

CameraModel SceneView(const Scene& scene, int width) {
  CameraModel view = scene.camera;
  const CameraModel tile = Tile(width);
  view.width = tile.width;
  view.height = tile.height;
  return view;
}

Picture StandsFor(std::size_t index, const std::vector<Picture>& pictures) {
  if (index < pictures.size()) return pictures[index];
  Picture blank;
  blank.width = blank.height = 1;
  blank.rgb.assign(3, 255);
  return blank;
}

// Held and, where it turns, turned: the last frame before the leaf moves.
std::size_t HeldFrame(const EpisodeStrip& strip) {
  std::size_t held = 0;
  for (std::size_t i = 0; i < strip.frames.size(); ++i) {
    if (strip.frames[i].stage == "grasp" || strip.frames[i].stage == "unlock") held = i;
  }
  return held;
}

}  // namespace

EpisodeStrip DrawEpisode(const DoorAsset& door, const RobotModel& robot,
                         const EpisodeStripConfig& config) {
  Require(
      config.frames >= 2 && config.frames <= 40 && config.tile_px >= 64 && config.tile_px <= 2048,
      ErrorCode::kInvalidArgument,
      "film strip: frames must lie in 2..40 and the width of a picture in 64..2048");
  const Scene scene = SampleScene(door, config.seed, config.episode, config.scene);
  Recorder recorder(door);
  OpeningExpert expert;
  EpisodeStrip strip;
  strip.episode = RunEpisode(scene, door, robot, expert, &recorder);

  SceneGeometry geometry(VisibleMeshesOf(door, robot));
  const CameraModel side = SideView(scene, door, config.tile_px);
  const CameraModel camera = SceneView(scene, config.tile_px);
  for (const Moment& moment : ChooseFrames(recorder.moments, config.frames)) {
    geometry.MoveLinks(LinkPosesOf(moment.snapshot));
    strip.frames.push_back(moment.frame);
    strip.camera.push_back(RenderPicture(geometry, camera));
    strip.side.push_back(RenderPicture(geometry, side));
    strip.handle.push_back(RenderPicture(geometry, HandleView(moment, door, config.tile_px)));
  }
  return strip;
}

Picture StripPicture(const EpisodeStrip& strip) {
  Require(!strip.side.empty(), ErrorCode::kInvalidArgument, "film strip: no pictures");
  std::vector<Picture> pictures;
  std::vector<std::string> captions;
  for (const auto* view : {&strip.camera, &strip.side, &strip.handle}) {
    pictures.insert(pictures.end(), view->begin(), view->end());
    for (const StripFrame& frame : strip.frames) captions.push_back(CaptionOf(frame));
  }
  const Picture& tile = strip.side.front();
  return ContactSheet(pictures, captions,
                      {static_cast<int>(strip.frames.size()), tile.width, tile.height});
}

Picture StripSheet(std::span<const EpisodeStrip> strips, std::span<const std::string> titles) {
  Require(!strips.empty() && strips.size() == titles.size() && !strips[0].side.empty(),
          ErrorCode::kInvalidArgument, "film strip: no pictures, or not one title each");
  std::size_t frames = 0;
  for (const EpisodeStrip& strip : strips) frames = std::max(frames, strip.side.size());
  std::vector<Picture> pictures;
  std::vector<std::string> captions;
  for (std::size_t row = 0; row < strips.size(); ++row) {
    const EpisodeStrip& strip = strips[row];
    pictures.push_back(StandsFor(HeldFrame(strip), strip.handle));
    captions.push_back(titles[row]);
    for (std::size_t i = 0; i < frames; ++i) {
      pictures.push_back(StandsFor(i, strip.side));
      captions.push_back(i < strip.frames.size() ? ShortCaptionOf(strip.frames[i]) : "");
    }
  }
  const Picture& tile = strips[0].side.front();
  return ContactSheet(pictures, captions, {static_cast<int>(frames) + 1, tile.width, tile.height});
}

}  // namespace doorforge
