// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "world/contact_report.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

constexpr double kTouchDistance = 0.001;

std::string NameOfDoorPart(const DoorBody& door, const btCollisionObject* object) {
  if (object == door.leaf_collider()) return "leaf";
  if (object == door.handle_collider()) return "handle";
  return "frame";
}

void AddName(const std::string& name, std::string& names) {
  if (!names.empty()) names += ", ";
  names += name;
}

void AddSelfContact(const btPersistentManifold& manifold, const RobotBody& robot,
                    double time_step_s, DoorContacts& contacts) {
  bool touches = false;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    if (point.getDistance() >= kTouchDistance) continue;
    touches = true;
    ++contacts.self_points;
    contacts.self_force_n += point.getAppliedImpulse() / time_step_s;
  }
  if (touches)
    AddName(robot.NameOf(manifold.getBody0()) + "-" + robot.NameOf(manifold.getBody1()),
            contacts.self_touches);
}

// Normal and friction on the body that is the manifold's first [N s].
btVector3 ImpulseOnFirst(const btManifoldPoint& point) {
  return point.m_normalWorldOnB * point.getAppliedImpulse() +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
}

void AddContact(const btPersistentManifold& manifold, const RobotBody& robot, const DoorBody& door,
                double time_step_s, DoorContacts& contacts) {
  const btCollisionObject* first = manifold.getBody0();
  const btCollisionObject* second = manifold.getBody1();
  if (robot.NameOf(first).empty()) std::swap(first, second);
  if (!robot.NameOf(second).empty()) return AddSelfContact(manifold, robot, time_step_s, contacts);
  if (robot.NameOf(first).empty()) return;  // bolt and strike
  const bool handle = second == door.handle_collider();
  const bool left = first == robot.finger(0);
  const bool right = first == robot.finger(1);
  const bool pad = handle && (left || right);
  const auto side = static_cast<std::size_t>(right ? 1 : 0);
  bool touches = false;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    if (pad)
      contacts.pad_distance_m = std::clamp<double>(point.getDistance(), 0, contacts.pad_distance_m);
    if (point.getDistance() >= kTouchDistance) continue;
    touches = true;
    const double force = point.getAppliedImpulse() / time_step_s;
    const btVector3 on_door =
        ImpulseOnFirst(point) * ((second == manifold.getBody0() ? 1 : -1) / time_step_s);
    contacts.force_on_door_n += Eigen::Vector3d(on_door.x(), on_door.y(), on_door.z());
    if (pad) {
      ++contacts.pad_points[side];
      contacts.pad_force_n[side] += force;
      contacts.deepest_m = std::max(contacts.deepest_m, -static_cast<double>(point.getDistance()));
    } else {
      ++contacts.arm_points;
      contacts.arm_force_n += force;
    }
  }
  if (!touches || pad) return;
  AddName(robot.NameOf(first) + "-" + NameOfDoorPart(door, second), contacts.arm_touches);
}

}  // namespace

DoorContacts ReportContacts(btCollisionDispatcher& dispatcher, const RobotBody& robot,
                            const DoorBody& door, double time_step_s) {
  DoorContacts contacts;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() > 0) AddContact(manifold, robot, door, time_step_s, contacts);
  }
  return contacts;
}

}  // namespace doorforge::internal
