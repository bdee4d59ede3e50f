// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/robot_observation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/deploy/depth_picture.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/rollout/proprioception.h"
#include "doorforge/rollout/remembered_view.h"

#include "named_numbers.h"

namespace doorforge {
namespace {

using internal::Format;
using internal::NamedNumbers;

constexpr int kFinest = 8;             // times the camera's pixels along each side
constexpr double kBeyondLimit = 0.05;  // of a joint's range
constexpr double kHandApart = 0.02;    // [m]
constexpr double kHandTurned = 5 * std::numbers::pi / 180;

JointVector JointsOf(const NamedNumbers& file, const std::string& key, int count) {
  const auto exactly = static_cast<std::size_t>(count);
  const std::vector<double> numbers = file.Numbers(key, exactly, exactly);
  JointVector joints(count);
  for (int i = 0; i < count; ++i) joints[i] = numbers[static_cast<std::size_t>(i)];
  return joints;
}

void RequireWithinLimits(const NamedNumbers& file, const RobotModel& robot,
                         const JointVector& position) {
  for (int i = 0; i < robot.joint_count(); ++i) {
    const RobotJoint& joint = robot.joint(i);
    const double margin = kBeyondLimit * (joint.upper - joint.lower);
    if (position[i] >= joint.lower - margin && position[i] <= joint.upper + margin) continue;
    file.Fail("joint_positions: " + joint.name +
              Format(" at %g, allowed %.4g to %.4g", position[i], joint.lower, joint.upper) +
              (joint.prismatic ? " m" : " rad") +
              "; positions are in metres and radians, in the order slider x, slider y, seven arm "
              "joints, two fingers");
  }
}

void RequireSameHand(const NamedNumbers& file, const RigidTransform& by_joints) {
  const RigidTransform given = file.Pose("world_from_hand");
  const double apart = (given.translation() - by_joints.translation()).norm();
  const double turned = RotationVector(given.linear().transpose() * by_joints.linear()).norm();
  if (apart <= kHandApart && turned <= kHandTurned) return;
  file.Fail("world_from_hand: " +
            Format("%.0f mm and %.0f degrees", 1000 * apart, turned * 180 / std::numbers::pi) +
            " from where the joints put the hand; allowed 20 mm and 5 degrees. Look at "
            "world_from_base, at the order of the joints, and whether it is the frame panda_hand");
}

// Why a picture gives so few points.
std::string FewPoints(const DepthImage& depth, std::size_t found, const CloudConfig& config) {
  const std::string head = "the depth picture gives " + std::to_string(found) +
                           " points, needed are " + std::to_string(config.point_count) + ": ";
  const auto has_depth = [](float metres) { return metres > 0 && std::isfinite(metres); };
  const auto with_depth = std::ranges::count_if(depth.depth_m, has_depth);
  if (with_depth == 0)
    return head + "each of its " + std::to_string(depth.depth_m.size()) +
           " pixels is 0, which means no depth; the camera sent no picture, or one of another kind";
  const auto near = std::ranges::count_if(depth.depth_m, [&](float metres) {
    return has_depth(metres) && static_cast<double>(metres) < config.max_depth_m;
  });
  float nearest = std::numeric_limits<float>::infinity();
  for (const float metres : depth.depth_m)
    if (has_depth(metres)) nearest = std::min(nearest, metres);
  return head + std::to_string(with_depth) + " of " + std::to_string(depth.depth_m.size()) +
         " pixels have a depth, " + std::to_string(near) +
         Format(" of them are nearer than %.2f m (the nearest is at %.2f m), and ",
                config.max_depth_m, static_cast<double>(nearest)) +
         std::to_string(found) + Format(" of these higher than %.2f m", config.min_height_m) +
         Format("; their median is %.2f m", MedianDepth(depth).value_or(0)) +
         "; look at depth_unit_m and world_from_camera (its z forward, y down) in the camera file";
}

// Every point inside the crop, of which there must be enough.
LabelledCloud VisiblePoints(const DepthImage& depth, const CalibratedCamera& camera,
                            const CloudConfig& config) {
  if (depth.width != camera.view.width || depth.height != camera.view.height)
    throw Error(ErrorCode::kInvalidArgument,
                "the depth picture has " + std::to_string(depth.width) + " x " +
                    std::to_string(depth.height) + " pixels, the camera file says " +
                    std::to_string(camera.view.width) + " x " + std::to_string(camera.view.height));
  RequirePlausibleDepths(depth, "in metres");
  LabelledCloud visible = CropCloud(depth, camera, config);
  const std::size_t found = visible.label.size();
  if (found < static_cast<std::size_t>(config.point_count))
    throw Error(ErrorCode::kInvalidArgument, FewPoints(depth, found, config));
  return visible;
}

// A grasper sees these points, whatever their labels.
HandleObservation ViewOfAll(LabelledCloud visible, const Eigen::Vector3d& approach,
                            const CloudConfig& config) {
  HandleObservation seen;
  seen.visible_count = static_cast<int>(visible.label.size());
  seen.handle_count = static_cast<int>(
      std::ranges::count(visible.label, static_cast<std::uint8_t>(PointLabel::kHandle)));
  seen.view.visible = visible;
  seen.view.approach = approach;
  seen.view.sample = [visible = std::move(visible), count = config.point_count](
                         const Eigen::Vector3d& start, double crop_radius_m) {
    return SampleCloud(visible, start, {count, crop_radius_m}).cloud;
  };
  return seen;
}

}  // namespace

RobotState ReadRobotState(const std::filesystem::path& path, const RobotModel& robot) {
  const NamedNumbers file(path.string(), internal::ReadNamed(path));
  file.RequireKnown(
      {"joint_positions", "joint_velocities", "world_from_base", "world_from_hand", "unlocked"});
  WorldState world;
  world.robot_position = JointsOf(file, "joint_positions", robot.joint_count());
  world.robot_velocity = JointsOf(file, "joint_velocities", robot.joint_count());
  RequireWithinLimits(file, robot, world.robot_position);
  const RigidTransform world_from_base = file.Pose("world_from_base");
  const RobotPose pose = robot.PoseAt(world.robot_position, world_from_base);
  if (file.Has("world_from_hand")) RequireSameHand(file, pose.world_from_hand);
  RobotState state;
  state.proprioception = ProprioceptionOf(robot, world, world_from_base);
  state.world_from_hand = pose.world_from_hand;
  state.tcp_in_world_m = pose.world_from_tcp.translation();
  if (file.Has("unlocked")) state.unlocked = file.Flag("unlocked");
  return state;
}

RobotObservation ObserveDepth(const DepthImage& depth, const CalibratedCamera& camera,
                              const RobotState& state, const CloudConfig& config) {
  const LabelledCloud visible = VisiblePoints(depth, camera, config);
  SampledCloud sampled = SampleCloud(visible, state.tcp_in_world_m, {config.point_count});
  RobotObservation seen;
  seen.observation.cloud = std::move(sampled.cloud);
  seen.observation.proprioception = state.proprioception;
  seen.visible_count = sampled.visible_count;
  return seen;
}

LabelledCloud ObserveBefore(const DepthImage& depth, const CalibratedCamera& camera,
                            const CloudConfig& config) {
  const PinholeView& view = camera.view;
  const int finer = depth.width / view.width;
  const bool fits = depth.width == finer * view.width && depth.height == finer * view.height;
  if (!fits || finer <= 1 || finer > kFinest) return VisiblePoints(depth, camera, config);
  return VisiblePoints(depth, WithFinerPixels(camera, finer), config);
}

RobotObservation ObserveDepth(const DepthImage& depth, const CalibratedCamera& camera,
                              const RobotState& state, const RememberedPoints& before,
                              const CloudConfig& config) {
  LabelledCloud visible = VisiblePoints(depth, camera, config);
  RobotObservation seen;
  seen.visible_count = static_cast<int>(visible.label.size());
  seen.observation.cloud = JoinedCloud(std::move(visible), before.visible, state.tcp_in_world_m,
                                       {config.point_count, before.crop_radius_m});
  seen.observation.proprioception = state.proprioception;
  return seen;
}

HandleObservation ObserveHandle(DepthImage depth, const PixelMask& handle,
                                const CalibratedCamera& camera, const Eigen::Vector3d& approach,
                                const CloudConfig& config) {
  if (handle.width != depth.width || handle.height != depth.height)
    throw Error(ErrorCode::kInvalidArgument,
                "the handle's mask has " + std::to_string(handle.width) + " x " +
                    std::to_string(handle.height) + " pixels, the depth picture " +
                    std::to_string(depth.width) + " x " + std::to_string(depth.height));
  constexpr auto kHandle = static_cast<std::uint8_t>(PointLabel::kHandle);
  if (std::ranges::count(handle.set, 1) == 0)
    throw Error(ErrorCode::kInvalidArgument,
                "the handle's mask is empty: 0 pixels of the mask are set, so there is nothing to "
                "take hold of; pixels that show the handle are to be other than 0");
  for (std::size_t i = 0; i < depth.label.size(); ++i)
    depth.label[i] = handle.set[i] != 0 ? kHandle : static_cast<std::uint8_t>(PointLabel::kOther);
  HandleObservation seen = ViewOfAll(VisiblePoints(depth, camera, config), approach, config);
  if (seen.handle_count == 0)
    throw Error(ErrorCode::kInvalidArgument,
                "no point to take hold of is in view: " +
                    std::to_string(std::ranges::count(handle.set, 1)) +
                    " pixels of the mask are set, and none of them has a depth inside the crop " +
                    Format("(nearer than %.2f m, higher than %.2f m)", config.max_depth_m,
                           config.min_height_m));
  return seen;
}

HandleObservation ObserveClosedDoor(const DepthImage& depth, const CalibratedCamera& camera,
                                    const CloudConfig& config) {
  LabelledCloud visible = VisiblePoints(depth, camera, config);
  std::ranges::fill(visible.label, static_cast<std::uint8_t>(PointLabel::kOther));
  return ViewOfAll(std::move(visible), -Eigen::Vector3d::UnitX(), config);
}

}  // namespace doorforge
