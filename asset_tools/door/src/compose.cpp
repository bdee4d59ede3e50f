// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/door/compose.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>

#include "doorforge/core/error.h"
#include "doorforge/door/mechanism.h"

#include "placed_mesh.h"
#include "seat.h"

namespace doorforge {
namespace {

constexpr double kHingeEffort = 300;    // [N m] above the latch's 150 and a strong closer
constexpr double kHingeVelocity = 6;    // [rad/s] a slammed door
constexpr double kHandleEffort = 30;    // [N m] a person's strong twist
constexpr double kHandleVelocity = 12;  // [rad/s]
// A base without a frame never moves, but programs drop links without mass.
const MassProperties kFixedBase{1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity() * 0.01};

void CheckPair(const Part& body, const Part& handle) {
  const auto fail = [](const std::string& why) {
    throw Error(ErrorCode::kInvalidArgument, "compose: " + why);
  };
  if (body.role != PartRole::kBody) fail("\"" + body.id + "\" is not a body but a handle");
  if (handle.role != PartRole::kHandle) fail("\"" + handle.id + "\" is not a handle but a body");
  if (body.category != handle.category)
    fail("body \"" + body.id + "\" is of category " + std::string(NameOf(body.category)) +
         ", handle \"" + handle.id + "\" of " + std::string(NameOf(handle.category)) +
         "; both must be of one category");
  if (!FindPiece(body, "leaf")) fail("body \"" + body.id + "\" has no piece \"leaf\"");
  if (!FindPiece(handle, "grip")) fail("handle \"" + handle.id + "\" has no piece \"grip\"");
}

void CheckConfig(const ComposeConfig& config) {
  const auto check = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1000))
      throw Error(ErrorCode::kInvalidConfig, std::string("config.") + name + ": " +
                                                 std::to_string(value) +
                                                 " is outside the allowed 0 to 1000");
  };
  check("handle_height_m", config.handle_height_m);
  check("backset_m", config.backset_m);
  check("lock_effort_nm", config.lock_effort_nm);
  check("hinge_spring_nm_per_rad", config.hinge_spring_nm_per_rad);
  check("handle_spring_nm_per_rad", config.handle_spring_nm_per_rad);
  check("hinge_damping_nm_s", config.hinge_damping_nm_s);
  check("handle_damping_nm_s", config.handle_damping_nm_s);
}

Eigen::Vector3d WantedMount(const Part& body, const ComposeConfig& config) {
  Eigen::Vector3d mount = body.part_from_mount.translation();
  if (config.handle_height_m > 0) mount.z() = config.handle_height_m;
  if (config.backset_m > 0) {
    const double edge = internal::BoundsOf(FindPiece(body, "leaf")->mesh).max().y();
    mount.y() = edge - config.backset_m;
  }
  return mount;
}

RigidTransform SeatedMount(const Part& body, const Part& handle, const ComposeConfig& config) {
  std::vector<TriangleMesh> pieces;
  for (const PartPiece& piece : handle.pieces) pieces.push_back(piece.mesh);
  RigidTransform body_from_handle = body.part_from_mount;
  body_from_handle.translation().setZero();
  const internal::BackOutline back =
      internal::BackOutlineOf(internal::Placed(internal::JoinedMeshes(pieces), body_from_handle));
  const std::optional<Eigen::Vector3d> seat =
      internal::SeatOn(FindPiece(body, "leaf")->mesh, back, WantedMount(body, config));
  if (!seat)
    throw Error(ErrorCode::kInvalidArgument,
                "compose: the leaf of \"" + body.id + "\" has no surface for the back of \"" +
                    handle.id + "\" at the mount; set handle_height_m or backset_m");
  body_from_handle.translation() = *seat;
  return body_from_handle;
}

// adds `piece` of a part to a link whose frame lies at link_from_part
void AddPiece(const PartPiece& piece, const RigidTransform& link_from_part, PointLabel label,
              DoorLink& link) {
  DoorGeometry geometry{
      .name = piece.name,
      .mesh = internal::RoundedToFloat(internal::Placed(piece.mesh, link_from_part)),
      .hulls = {},
      .color_rgba = piece.color_rgba,
      .label = label};
  for (const TriangleMesh& hull : piece.hulls)
    geometry.hulls.push_back(internal::RoundedToFloat(internal::Placed(hull, link_from_part)));
  link.geometry.push_back(std::move(geometry));
  const std::array<MassProperties, 2> masses = {link.mass, Transformed(piece.mass, link_from_part)};
  link.mass = Combined(masses);
}

void RaiseInertia(MassProperties& mass) {
  // the smallest eigenvalue bounds the inertia about any axis
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mass.inertia_kg_m2).eigenvalues()[0];
  if (smallest < kMinimumHandleInertia)
    mass.inertia_kg_m2 += (kMinimumHandleInertia - smallest) * Eigen::Matrix3d::Identity();
}

DoorJoint MakeJoint(const std::string& name, const PartJoint& joint,
                    const Eigen::Vector3d& origin) {
  DoorJoint made;
  made.name = name;
  made.parent_from_child_at_zero = Translation(origin);
  made.axis = joint.axis.normalized();
  made.lower_rad = joint.lower_rad;
  made.upper_rad = joint.upper_rad;
  return made;
}

void AddJoints(const Part& body, const Part& handle, const RigidTransform& body_from_handle,
               const ComposeConfig& config, DoorAsset& door) {
  door.hinge = MakeJoint("hinge", body.joint, body.joint.origin_m);
  door.hinge.effort_limit_nm = kHingeEffort;
  door.hinge.velocity_limit_rad_s = kHingeVelocity;
  door.hinge.damping_nm_s = config.hinge_damping_nm_s;
  door.handle_joint = MakeJoint("handle_joint", handle.joint,
                                body_from_handle * handle.joint.origin_m - body.joint.origin_m);
  door.handle_joint.axis = body_from_handle.linear() * door.handle_joint.axis;
  door.handle_joint.effort_limit_nm = kHandleEffort;
  door.handle_joint.velocity_limit_rad_s = kHandleVelocity;
  door.handle_joint.damping_nm_s = config.handle_damping_nm_s;
}

void AddLinks(const Part& body, const Part& handle, const RigidTransform& body_from_handle,
              DoorAsset& door) {
  door.links[kBaseLink].name = "base";
  door.links[kLeafLink].name = "leaf";
  door.links[kHandleLink].name = "handle";
  const RigidTransform leaf_from_body = door.hinge.parent_from_child_at_zero.inverse();
  const RigidTransform handle_from_leaf = door.handle_joint.parent_from_child_at_zero.inverse();
  if (const PartPiece* frame = FindPiece(body, "frame"))
    AddPiece(*frame, RigidTransform::Identity(), PointLabel::kFrame, door.links[kBaseLink]);
  else
    door.links[kBaseLink].mass = kFixedBase;
  AddPiece(*FindPiece(body, "leaf"), leaf_from_body, PointLabel::kBody, door.links[kLeafLink]);
  if (const PartPiece* rose = FindPiece(handle, "rose"))
    AddPiece(*rose, leaf_from_body * body_from_handle, PointLabel::kHandle, door.links[kLeafLink]);
  const RigidTransform link_from_handle = handle_from_leaf * leaf_from_body * body_from_handle;
  AddPiece(*FindPiece(handle, "grip"), link_from_handle, PointLabel::kHandle,
           door.links[kHandleLink]);
  RaiseInertia(door.links[kHandleLink].mass);
  door.handle_from_grasp = link_from_handle * handle.part_from_grasp;
}

Latch MakeLatch(const DoorAsset& door, const ComposeConfig& config) {
  const bool turns = door.handle_joint.upper_rad > door.handle_joint.lower_rad;
  const Mechanism mechanism = config.latch && turns ? door.mechanism : Mechanism::kNone;
  Latch latch = LatchOf(door.category, mechanism, door.handle_joint.upper_rad);
  latch.hinge_spring_nm_per_rad = config.hinge_spring_nm_per_rad;
  if (turns) latch.handle_spring_nm_per_rad = config.handle_spring_nm_per_rad;
  if (latch.type == LatchType::kNone) return latch;
  latch.lock_effort_nm = config.lock_effort_nm;
  latch.relatch = config.relatch;
  return latch;
}

std::string JoinedLicense(const std::string& a, const std::string& b) {
  return a == b ? a : a + " AND " + b;
}

}  // namespace

DoorAsset ComposeDoor(const Part& body, const Part& handle, const ComposeConfig& config) {
  CheckConfig(config);
  CheckPair(body, handle);
  DoorAsset door;
  door.id = config.id.empty() ? body.id + "__" + handle.id : config.id;
  door.category = body.category;
  door.mechanism = handle.mechanism;
  const RigidTransform body_from_handle = SeatedMount(body, handle, config);
  AddJoints(body, handle, body_from_handle, config, door);
  AddLinks(body, handle, body_from_handle, door);
  door.latch = MakeLatch(door, config);
  door.grasp_half_extent_m = handle.grasp_half_extent_m;
  door.body_id = body.id;
  door.body_sha256 = ContentHash(body);
  door.handle_id = handle.id;
  door.handle_sha256 = ContentHash(handle);
  door.license = JoinedLicense(body.license, handle.license);
  return door;
}

}  // namespace doorforge
