// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode_film.h"
#include "doorforge/schemas/policy.h"

#include "page_content.h"

namespace doorforge::internal {

/// Where everything is at an instant of an episode, in the world.
struct FilmFrame {
  double time_s = 0;
  std::string phase;  ///< A word for people; may be empty.
  double hinge_rad = 0;
  double handle_rad = 0;
  std::optional<double> bolt_m;       ///< How far it is drawn back; empty: the handle tells.
  std::vector<RigidTransform> poses;  ///< Door's base, leaf, handle; the robot's bodies; its base.
  Eigen::Vector3d hand_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> asked_m;  ///< Where the policy wants the hand next.
  LabelledCloud cloud;                     ///< May be empty.
  std::optional<double> force_n;           ///< FilmInstant::force_n, where it is known.
  std::optional<double> net_force_n;
};

struct Film {
  std::string title;
  bool opened = false;
  std::vector<std::pair<std::string, std::string>> facts;  ///< Rows of a table for people.
  std::vector<FilmFrame> frames;
  /// Shares of what was hidden from the camera, by name, one a frame; empty where none is recorded.
  std::vector<std::pair<std::string, std::vector<double>>> hidden = {};
};

/// The film of a record. Throws Error(kInvalidArgument) where the record is not of this robot.
Film FilmOf(const EpisodeFilm& record, const DoorAsset& door, const RobotModel& robot);

/// The poses of a frame: `door` in the world, and the robot.
std::vector<RigidTransform> PosesOf(const std::array<RigidTransform, 3>& door,
                                    const RobotPose& robot);

/// The robot: {"bodies", "pieces": [{"mesh", "color", "body"}]}; body numbers are those of the
/// poses behind the door's three.
PageContent::Json RobotForView(const RobotModel& robot, PageContent& content);

/// {"title", "opened", "facts", "times", "phases", "hinge", "handle", "bolt", "poses", "hands",
/// "asked", "cloud", "force", "net_force", "hidden"}; docs/design/view.md has their shapes. At most
/// `points` points of each cloud are kept, every n-th.
PageContent::Json FilmForView(const Film& film, int points, PageContent& content);

}  // namespace doorforge::internal
