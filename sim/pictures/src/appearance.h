// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "doorforge/pictures/take_pictures.h"
#include "doorforge/sensor/scene_geometry.h"

#include "finish.h"
#include "picture_room.h"

namespace doorforge {

/// A round lamp that hangs in the room and shines to all sides.
struct Lamp {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();
  float radius_m = 0.2F;
  LinearColor power{1, 1, 1};  ///< Light that arrives at 1 m, head on.
};
inline constexpr std::size_t kMostLamps = 3;

/// What a camera makes of light.
struct Exposure {
  LinearColor gain{1, 1, 1};  ///< With the white balance.
  float blur_px = 0;          ///< Spread of a point.
  float noise = 0;            ///< Spread at full light, as a share of it.
};

/// How everything looks in the pictures of an episode.
struct Appearance {
  std::vector<Finish> meshes;  ///< Each mesh of the scene has one.
  Finish pane;                 ///< A window's leaf has it where it is thin.
  std::array<Finish, kRoomPartCount> room;
  std::vector<Lamp> lamps;  ///< 1 to kMostLamps before the door's wall.
  Lamp lamp_behind;         ///< In the room behind it.
  LinearColor ambient{0.3F, 0.3F, 0.3F};
  Exposure exposure;
};

/// It is what the scene's appearance asks for, drawn from the stream "scene/<door
/// id>/<episode>/appearance" of its seed.
Appearance DrawAppearance(const PictureScene& scene, const std::vector<VisibleMesh>& meshes,
                          const PictureRoom& room);

}  // namespace doorforge
