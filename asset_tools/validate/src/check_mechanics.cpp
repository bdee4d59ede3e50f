// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "doorforge/core/mesh_transform.h"

#include "findings.h"

namespace doorforge::internal {
namespace {

struct JointNumbers {
  std::string where;
  Eigen::Vector3d axis;
  double lower_rad;
  double upper_rad;
};

Findings CheckJoint(const JointNumbers& joint) {
  Findings findings;
  if (!(std::abs(joint.axis.norm() - 1) <= LimitOf("MEC001")))
    findings.push_back(Found("MEC001", joint.where, "length " + Number(joint.axis.norm())));
  const double largest = LimitOf("MEC002");
  const bool ordered = joint.lower_rad <= 0 && joint.upper_rad >= 0 &&
                       joint.lower_rad >= -largest && joint.upper_rad <= largest;
  if (!ordered)
    findings.push_back(Found("MEC002", joint.where,
                             Number(joint.lower_rad) + " to " + Number(joint.upper_rad) + " rad"));
  return findings;
}

Findings CheckOpening(const JointNumbers& hinge) {
  if (hinge.upper_rad >= LimitOf("MEC003")) return {};
  return {Found("MEC003", hinge.where, Number(hinge.upper_rad) + " rad")};
}

// Along x: how a point at `arm` from the hinge line starts to move at positive hinge rates.
Findings CheckDirection(const JointNumbers& hinge, const Eigen::Vector3d& arm, Opening opening) {
  const Eigen::Vector3d motion = hinge.axis.cross(arm);
  const double sense = opening == Opening::kPull ? 1 : -1;
  const double along_x = motion.norm() > 1e-9 ? sense * motion.normalized().x() : 0;
  if (along_x >= LimitOf("MEC004")) return {};
  return {Found("MEC004", hinge.where, Number(along_x))};
}

Findings CheckLimits(const DoorJoint& joint) {
  if (joint.effort_limit_nm > 0 && joint.velocity_limit_rad_s > 0) return {};
  return {Found("MEC005", "door.json: " + joint.name,
                "effort " + Number(joint.effort_limit_nm) + " N m, velocity " +
                    Number(joint.velocity_limit_rad_s) + " rad/s")};
}

Findings CheckLatch(const DoorAsset& door) {
  const Latch& latch = door.latch;
  const std::string where = "door.json: latch";
  Findings findings;
  const double upper = door.handle_joint.upper_rad;
  const bool locks = latch.type != LatchType::kNone;
  if (locks && !(upper > 0)) {
    findings.push_back(Found("MEC007", where, "handle's upper limit " + Number(upper) + " rad"));
  } else if (locks && !(0 < latch.unlock_angle_rad &&
                        latch.unlock_angle_rad <= latch.handle_done_angle_rad &&
                        latch.handle_done_angle_rad <= upper)) {
    findings.push_back(Found("MEC006", where,
                             "unlock " + Number(latch.unlock_angle_rad) + ", done " +
                                 Number(latch.handle_done_angle_rad) + ", upper limit " +
                                 Number(upper) + " rad"));
  }
  const bool holds = latch.type == LatchType::kBolt ? latch.bolt_throw_m > 0
                     : locks                        ? latch.lock_effort_nm > 0
                                                    : latch.lock_effort_nm >= 0;
  const bool numbers_hold = holds && latch.hinge_spring_nm_per_rad >= 0 &&
                            latch.handle_spring_nm_per_rad >= 0 && door.hinge.damping_nm_s >= 0 &&
                            door.handle_joint.damping_nm_s >= 0;
  if (!numbers_hold)
    findings.push_back(Found(
        "MEC008", where,
        "lock effort " + Number(latch.lock_effort_nm) + ", bolt throw " +
            Number(latch.bolt_throw_m) + ", springs " + Number(latch.hinge_spring_nm_per_rad) +
            " and " + Number(latch.handle_spring_nm_per_rad) + ", damping " +
            Number(door.hinge.damping_nm_s) + " and " + Number(door.handle_joint.damping_nm_s)));
  return findings;
}

// Distance of the hinge line, at the height of the leaf's middle, from the leaf's bounds.
Findings CheckHingeLine(const DoorAsset& door) {
  Eigen::AlignedBox3d bounds;
  for (const DoorGeometry& geometry : door.links[kLeafLink].geometry) {
    if (geometry.mesh.triangles.empty()) return {};  // MSH has said so
    bounds.extend(BoundsOf(geometry.mesh));
  }
  if (bounds.isEmpty() || door.hinge.axis.norm() < 1e-9) return {};
  const Eigen::Vector3d axis = door.hinge.axis.normalized();
  const double distance = bounds.exteriorDistance(axis * axis.dot(bounds.center()));
  if (distance <= LimitOf("MEC009")) return {};
  return {Found("MEC009", "door.json: hinge", Number(distance) + " m")};
}

void Append(Findings& findings, const Findings& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

}  // namespace

Findings CheckMechanics(const DoorAsset& door) {
  const auto numbers = [](const DoorJoint& joint) {
    return JointNumbers{"door.json: " + joint.name, joint.axis, joint.lower_rad, joint.upper_rad};
  };
  const JointNumbers hinge = numbers(door.hinge);
  Findings findings = CheckJoint(hinge);
  Append(findings, CheckJoint(numbers(door.handle_joint)));
  Append(findings, CheckOpening(hinge));
  // both in the door frame
  const Eigen::Matrix3d door_from_leaf = door.hinge.parent_from_child_at_zero.linear();
  JointNumbers in_door = hinge;
  in_door.axis = door_from_leaf * hinge.axis;
  Append(findings,
         CheckDirection(in_door, door_from_leaf * door.links[kLeafLink].mass.center_of_mass_m,
                        door.opening));
  Append(findings, CheckLimits(door.hinge));
  Append(findings, CheckLimits(door.handle_joint));
  Append(findings, CheckLatch(door));
  Append(findings, CheckHingeLine(door));
  return findings;
}

Findings CheckPartJoint(const Part& part) {
  const JointNumbers joint{"part.json: joint", part.joint.axis, part.joint.lower_rad,
                           part.joint.upper_rad};
  Findings findings = CheckJoint(joint);
  const PartPiece* leaf = FindPiece(part, "leaf");
  if (part.role != PartRole::kBody || leaf == nullptr) return findings;
  Append(findings, CheckOpening(joint));
  Append(findings,
         CheckDirection(joint, leaf->mass.center_of_mass_m - part.joint.origin_m, Opening::kPull));
  return findings;
}

}  // namespace doorforge::internal
