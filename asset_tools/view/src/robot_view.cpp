// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot_view.h"

#include <algorithm>

#include "doorforge/core/mesh_transform.h"

namespace doorforge::internal {

using Json = PageContent::Json;

Json GripperForView(const RobotModel& robot, const Eigen::Vector3d& half_extent_m,
                    PageContent& content) {
  JointVector position = robot.InitialPosition();
  for (const int finger : {robot.left_finger(), robot.right_finger()})
    position[finger] =
        std::clamp(half_extent_m.y(), robot.joint(finger).lower, robot.joint(finger).upper);
  const RobotPose pose = robot.PoseAt(position, RigidTransform::Identity());
  const RigidTransform tcp_from_world = pose.world_from_tcp.inverse();
  Json pieces = Json::array();
  for (const RobotPiece& piece : robot.visuals()) {
    if (piece.name != "hand" && piece.joint != robot.left_finger() &&
        piece.joint != robot.right_finger())
      continue;
    const RigidTransform& world_from_body =
        pose.world_from_body[static_cast<std::size_t>(piece.joint)];
    pieces.push_back(
        {{"mesh", content.AddMesh(Transformed(piece.mesh, tcp_from_world * world_from_body))},
         {"color",
          {piece.color_rgba[0], piece.color_rgba[1], piece.color_rgba[2], piece.color_rgba[3]}}});
  }
  return {{"pieces", std::move(pieces)}};
}

}  // namespace doorforge::internal
