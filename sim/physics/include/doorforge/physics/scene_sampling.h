// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/door_identity.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Where the camera stands in the world. The default is UniDoorManip's.
struct CameraConfig {
  std::vector<double> position_m = {1.8, 0, 1.8};
  std::vector<double> target_m = {0.01, 0, 1.5};  ///< Point in the middle of the image.
  int width = 256;
  int height = 256;
  double horizontal_fov_rad = 1.5707963267948966;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("position_m", self.position_m);
    visit("target_m", self.target_m);
    visit("width", self.width);
    visit("height", self.height);
    visit("horizontal_fov_rad", self.horizontal_fov_rad);
  }
};

/// Throws Error(kInvalidConfig) unless position and target are two different points of three
/// numbers, neither above the other, the image has a size, and the view is within (0, pi) wide.
CameraModel CameraOf(const CameraConfig& config);

/// What varies from one episode of a door to the next, see docs/design/simulation.md for the ranges
/// and their sources.
enum class Randomisation {
  kOff,     ///< Every episode of a door is the same, but for the policies' own noise.
  kPaper,   ///< The robot's place and the grasp vary, as in UniDoorManip's released code.
  kStrong,  ///< Friction, masses, damping, springs, unlock angle, camera and start pose vary too.
};
inline constexpr NamedValue<Randomisation> kRandomisations[] = {{Randomisation::kOff, "off"},
                                                                {Randomisation::kPaper, "paper"},
                                                                {Randomisation::kStrong, "strong"}};
constexpr std::span<const NamedValue<Randomisation>> ValuesOf(Randomisation) {
  return kRandomisations;
}

/// What holds a scene's door shut.
enum class SceneLatch {
  kOfDoor,  ///< The door's own latch.
  kNone,    ///< Nothing does, and no handle need be turned.
};
inline constexpr NamedValue<SceneLatch> kSceneLatches[] = {{SceneLatch::kOfDoor, "door"},
                                                           {SceneLatch::kNone, "none"}};
constexpr std::span<const NamedValue<SceneLatch>> ValuesOf(SceneLatch) { return kSceneLatches; }

struct SceneConfig {
  PhysicsConfig physics;
  EpisodeLimits episode;  ///< Written into files only where they are not the defaults.
  CameraConfig camera;
  /// URDF of the robot; empty: the built-in one. Programs load it by LoadRobot(); SampleScene()
  /// does not look at it.
  std::string robot = {};
  Randomisation randomisation = Randomisation::kPaper;
  /// The door stands higher or lower by up to this, drawn for each episode: robots are not all as
  /// tall, and handles that one category has low, another has high. Camera and robot stay.
  double height_jitter_m = 0;
  double base_jitter = 1;  ///< Scales the spread of the robot's place; 0: always the same.
  double grasp_noise = 1;  ///< Scales the offset of the expert's grasp; 0: the nominal grasp.
  SceneLatch latch = SceneLatch::kOfDoor;
  /// How everything looks in pictures, drawn for each episode from the stream
  /// "scene/<door id>/<episode>/appearance". No other draw depends on it.
  SceneAppearance appearance = SceneAppearance::kOff;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("physics", self.physics);
    // Configurations are recorded with the data: those from before there was a choice stay as they
    // are, byte by byte. A configuration that is read is not const.
    if (!std::is_const_v<Self> || self.episode != EpisodeLimits{}) visit("episode", self.episode);
    visit("camera", self.camera);
    visit("robot", self.robot);
    visit("randomisation", self.randomisation);
    visit("height_jitter_m", self.height_jitter_m);
    visit("base_jitter", self.base_jitter);
    visit("grasp_noise", self.grasp_noise);
    if (!std::is_const_v<Self> || self.latch != SceneLatch::kOfDoor) visit("latch", self.latch);
    if (!std::is_const_v<Self> || self.appearance != SceneAppearance::kOff)
      visit("appearance", self.appearance);
  }
};

/// Whether the door is pushed by a handle that stands upright, as windows have: the wide hand then
/// comes across it, past the jamb, and leans about it.
bool IsPushedUpright(const DoorAsset& door);

/// Draws episode number `episode` of a door, as DoorCache gives it. A pure function of its
/// arguments: the random streams are named "scene/<door id>/<episode>/<purpose>".
///
/// The door stands axis-parallel, 0.1 m or more over the floor, so that the closed door's grasp
/// point lies where UniDoorManip's objects of this category have it (its range of heights, sideways
/// positions and distances, measured on the released objects); a door that is in the range at
/// height 0.1 m is not moved; then it is moved by up to height_jitter_m up or down, also into the
/// floor, which is nothing that anything could touch. Robot: facing the door at the category's
/// distance, x and y jittered independently by clip(N(0, 0.5), -1, 1) times 0.08 to 0.15 m. Grasp:
/// turned about the approach by the same kind of number times 10 degrees; on levers and flaps also
/// shifted along the handle by up to grasp_half_extent_m. A door hinged right stands where the
/// mirror image of one hinged left would, the robot likewise; a door that is pushed stands as one
/// that is pulled, with the robot on the handle's side, and the grasp of whoever pushes leans 20
/// degrees away from the jamb (about an upright handle, as windows have, 0.9 rad) and, on a knob,
/// is rolled back by half its turn. Throws as RequireSimulatable(); Error(kInvalidArgument) where
/// the frame of a pushed door stands between robot and handle, as the back of a cupboard does;
/// Error(kInvalidConfig) on a height_jitter_m out of 0..0.5, as CheckEpisodeLimits() and as
/// CameraOf(). A stronger randomisation leaves the draws of a weaker one as they are.
Scene SampleScene(const IdentifiedDoor& door, std::uint64_t seed, std::uint64_t episode,
                  const SceneConfig& config = {});
/// This one takes a door that was made or changed in memory. It writes all meshes as text to hash
/// them.
Scene SampleScene(const DoorAsset& door, std::uint64_t seed, std::uint64_t episode,
                  const SceneConfig& config = {});

}  // namespace doorforge
