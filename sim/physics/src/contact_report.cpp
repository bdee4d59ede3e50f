// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "contact_report.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

constexpr double kTouchDistance = 0.001;

std::string NameOfDoorPart(const DoorBody& door, const btCollisionObject* object) {
  if (object == door.leaf_collider()) return "leaf";
  if (object == door.handle_collider()) return "handle";
  return "frame";
}

void AddContact(const btPersistentManifold& manifold, const RobotBody& robot, const DoorBody& door,
                double time_step_s, DoorContacts& contacts) {
  const btCollisionObject* first = manifold.getBody0();
  const btCollisionObject* second = manifold.getBody1();
  if (robot.NameOf(first).empty()) std::swap(first, second);
  const bool handle = second == door.handle_collider();
  const bool left = first == robot.collider(kLeftFinger);
  const bool right = first == robot.collider(kRightFinger);
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
  if (!contacts.arm_touches.empty()) contacts.arm_touches += ", ";
  contacts.arm_touches += robot.NameOf(first) + "-" + NameOfDoorPart(door, second);
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
