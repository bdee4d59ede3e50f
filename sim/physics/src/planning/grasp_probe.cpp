// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/grasp_probe.h"

#include <algorithm>
#include <array>
#include <vector>

#include "collision/convex_probe.h"

namespace doorforge {
namespace {

using internal::Separate;
using internal::Separation;
using Hull = internal::ProbeHull;

constexpr double kMargin = 0.001;

Hull MakeProbeHull(const TriangleMesh& mesh, const RigidTransform& owner_from_mesh) {
  return internal::MakeProbeHull(mesh, owner_from_mesh, kMargin);
}

}  // namespace

class GraspProbe::Runtime {
 public:
  Runtime(const DoorAsset& door, const RobotModel& robot);

  Separation NearestOfHandle(const Hull& finger, const RigidTransform& door_from_finger) const;
  double Clearance(const std::vector<Hull>& gripper, const RigidTransform& door_from_gripper,
                   double cutoff) const;

  std::vector<Hull> hand;                   ///< In the tool centre's frame.
  std::array<std::vector<Hull>, 2> finger;  ///< They stand at finger position 0.
  std::array<Eigen::Vector3d, 2> opening;   ///< Direction in which each finger opens.
  double most_open;
  int left_finger;

 private:
  std::vector<Hull> door_;  ///< All of the closed door, in its frame.
  std::size_t handle_begin_ = 0;
};

GraspProbe::Runtime::Runtime(const DoorAsset& door, const RobotModel& robot) {
  const RigidTransform tcp_from_body = robot.tcp().body_from_frame.inverse();
  left_finger = robot.left_finger();
  most_open = robot.joint(left_finger).upper;
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint == left_finger - 1) hand.push_back(MakeProbeHull(piece.mesh, tcp_from_body));
    if (piece.joint < left_finger) continue;
    const RobotJoint& joint = robot.joints()[static_cast<std::size_t>(piece.joint)];
    const auto side = static_cast<std::size_t>(piece.joint - left_finger);
    const RigidTransform tcp_from_joint = tcp_from_body * joint.parent_from_joint;
    opening.at(side) = tcp_from_joint.linear() * joint.axis;
    finger.at(side).push_back(MakeProbeHull(piece.mesh, tcp_from_joint));
  }
  const auto poses = DoorFromLinks(door, 0, 0);
  for (const int link : {kBaseLink, kLeafLink, kHandleLink}) {
    const auto index = static_cast<std::size_t>(link);
    if (link == kHandleLink) handle_begin_ = door_.size();
    for (const DoorGeometry& geometry : door.links[index].geometry) {
      for (const TriangleMesh& hull : geometry.hulls)
        door_.push_back(MakeProbeHull(hull, poses[index]));
    }
  }
}

Separation GraspProbe::Runtime::NearestOfHandle(const Hull& moving,
                                                const RigidTransform& door_from_finger) const {
  Separation nearest;
  for (std::size_t i = handle_begin_; i < door_.size(); ++i) {
    const Separation found = Separate(moving, door_from_finger, door_[i]);
    if (found.distance < nearest.distance) nearest = found;
  }
  return nearest;
}

double GraspProbe::Runtime::Clearance(const std::vector<Hull>& gripper,
                                      const RigidTransform& door_from_gripper,
                                      double cutoff) const {
  double clearance = cutoff;
  for (const Hull& piece : gripper) {
    const Eigen::AlignedBox3d box = piece.box.transformed(door_from_gripper);
    for (const Hull& other : door_) {
      if (box.exteriorDistance(other.box) >= clearance) continue;
      clearance = std::min(clearance, Separate(piece, door_from_gripper, other).distance);
    }
  }
  return clearance;
}

GraspProbe::GraspProbe(const DoorAsset& door, const RobotModel& robot)
    : runtime_(std::make_unique<Runtime>(door, robot)) {}
GraspProbe::~GraspProbe() = default;
GraspProbe::GraspProbe(GraspProbe&&) noexcept = default;
GraspProbe& GraspProbe::operator=(GraspProbe&&) noexcept = default;

double GraspProbe::Clearance(const RigidTransform& door_from_tcp, double finger_position_m,
                             double cutoff_m) const {
  double clearance = runtime_->Clearance(runtime_->hand, door_from_tcp, cutoff_m);
  for (const std::size_t side : {0U, 1U}) {
    const RigidTransform door_from_finger =
        door_from_tcp * Translation(runtime_->opening.at(side) * finger_position_m);
    clearance = std::min(
        clearance, runtime_->Clearance(runtime_->finger.at(side), door_from_finger, clearance));
  }
  return clearance;
}

std::optional<PadContact> GraspProbe::Close(const RigidTransform& door_from_tcp, int finger) const {
  const auto side = static_cast<std::size_t>(finger - runtime_->left_finger);
  double position = runtime_->most_open;
  // conservative advancement: a hull cannot be reached before the distance is travelled
  for (int i = 0; i < 40 && position > 0; ++i) {
    const RigidTransform door_from_finger =
        door_from_tcp * Translation(runtime_->opening.at(side) * position);
    Separation nearest;
    for (const Hull& piece : runtime_->finger.at(side)) {
      const Separation found = runtime_->NearestOfHandle(piece, door_from_finger);
      if (found.distance < nearest.distance) nearest = found;
    }
    if (nearest.distance < 2e-4) {
      const RigidTransform tcp_from_door = door_from_tcp.inverse();
      return PadContact{position, tcp_from_door * nearest.point,
                        tcp_from_door.linear() * nearest.normal};
    }
    position -= nearest.distance;
  }
  return std::nullopt;
}

}  // namespace doorforge
