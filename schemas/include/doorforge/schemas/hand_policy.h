// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// How a flying hand is led by somebody who does all of an episode: where it begins, how often it
/// is told what to do, and how far it goes each time.
struct HandTaskConfig {
  int steps_per_action = 19;       ///< Steps of the physics: 79 ms at 1/240 s (DoorGym: 80 ms).
  int max_actions = 128;           ///< The episode's budget: 10 s.
  double start_distance_m = 0.15;  ///< The tool centre begins so far before the grasp,
  double start_spread_m = 0.03;    ///< off by up to this along each axis,
  double start_turn_rad = 0.2;     ///< and turned by up to this about each.
  double move_m = 0.025;           ///< Most that one action moves the hand along each axis.
  double turn_rad = 0.15;          ///< Most that one action turns the hand about each axis.

  bool operator==(const HandTaskConfig&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("steps_per_action", self.steps_per_action);
    visit("max_actions", self.max_actions);
    visit("start_distance_m", self.start_distance_m);
    visit("start_spread_m", self.start_spread_m);
    visit("start_turn_rad", self.start_turn_rad);
    visit("move_m", self.move_m);
    visit("turn_rad", self.turn_rad);
  }
};

/// Throws Error(kInvalidConfig) that names the first field of `path` that is out of its range.
void CheckHandTask(const HandTaskConfig& config, const std::string& path);

/// All that one who acts on true states is told; a robot would know none of the door's part.
struct HandState {
  RigidTransform world_from_tcp = RigidTransform::Identity();  ///< Tool centre, see RobotPose.
  Eigen::Vector3d tcp_m_s = Eigen::Vector3d::Zero();           ///< Its velocity in the world.
  Eigen::Vector3d tcp_rad_s = Eigen::Vector3d::Zero();
  std::array<double, 2> finger_m{};  ///< Openings, left and right.
  std::array<double, 2> finger_m_s{};
  bool closes_fingers = false;  ///< They are told to close.
  /// Where a tool centre would hold the handle (DoorAsset::handle_from_grasp); moves with it.
  RigidTransform world_from_grasp = RigidTransform::Identity();
  double hinge_rad = 0;
  double hinge_rad_s = 0;
  double handle_rad = 0;
  double handle_rad_s = 0;
  double handle_done_rad = 0;  ///< Latch::handle_done_angle_rad; 0 on a door without a latch.
  bool locked = false;         ///< The latch holds the leaf.
  Eigen::Vector3d hinge_origin_m = Eigen::Vector3d::Zero();  ///< In the world.
  Eigen::Vector3d hinge_axis = Eigen::Vector3d::UnitZ();     ///< In the world; positive opens.
  Eigen::Vector3d handle_origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d handle_axis = Eigen::Vector3d::UnitX();  ///< In the world; positive unlocks.
};

/// What a hand is told for the next HandTaskConfig::steps_per_action steps, from where it is.
struct HandCommand {
  Eigen::Vector3d move_m = Eigen::Vector3d::Zero();    ///< Of the tool centre, in the world.
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  ///< Axis times angle, in the world.
  bool close_fingers = false;
};

/// What one who looks is given of the points that the camera has of an instant.
struct HandLook {
  int points = 512;            ///< Farthest points first; filled up by repeating them.
  double crop_radius_m = 0.3;  ///< About the visible point nearest to the tool centre; 0: all.

  bool operator==(const HandLook&) const = default;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("points", self.points);
    visit("crop_radius_m", self.crop_radius_m);
  }
};

/// Throws Error(kInvalidConfig) as CheckHandTask().
void CheckHandLook(const HandLook& look, const std::string& path);

/// Does a whole episode: reaches, takes hold, turns and pulls. One instance serves one episode at a
/// time.
class HandPolicy {
 public:
  virtual ~HandPolicy() = default;
  /// @param cloud What look() asks for, the nearest visible point first; empty where it asks for
  ///     nothing, or where nothing is in sight.
  virtual HandCommand Act(const HandState& state, const LabelledCloud& cloud) = 0;
  /// Nothing: Act() reads no cloud.
  virtual std::optional<HandLook> look() const { return std::nullopt; }
  /// The task that it was made for.
  virtual const HandTaskConfig& task() const = 0;
};

}  // namespace doorforge
