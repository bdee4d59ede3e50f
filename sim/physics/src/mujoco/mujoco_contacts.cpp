// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mujoco/mujoco_contacts.h"

#include <algorithm>
#include <array>

#include "robot/simulated_robot.h"

namespace doorforge::internal {
namespace {

using Side = MujocoPiece::Side;

constexpr double kTouches = 0.001;
// The ends of the fading of friction are those of row_solver.cpp.
constexpr double kFullFrictionDepth = 0.003;
constexpr double kNoFrictionDepth = 0.006;

// It is that of the shapes with their skins, as Bullet has it.
double DistanceOf(const mjContact& contact, Side first) {
  return contact.dist - (first == Side::kLatch ? contact.includemargin : kMujocoSkin);
}

std::string_view NameOfLink(int link) {
  if (link == kLeafLink) return "leaf";
  return link == kHandleLink ? "handle" : "frame";
}

void AddTouching(const std::string& name, std::string& names) {
  if (names.find(name) != std::string::npos) return;
  if (!names.empty()) names += ", ";
  names += name;
}

}  // namespace

MujocoContacts::MujocoContacts(const MujocoModel& model, const std::vector<MujocoPiece>& pieces,
                               const RobotModel& robot)
    : model_(model), robot_(robot), pieces_(pieces.size()) {
  for (std::size_t i = 0; i < pieces.size(); ++i)
    pieces_[static_cast<std::size_t>(model.GeomNamed(std::string("g") + std::to_string(i)))] =
        pieces[i];
}

void MujocoContacts::SetFrictions() const {
  for (int i = 0; i < model_.data->ncon; ++i) {
    mjContact& contact = model_.data->contact[i];
    const MujocoPiece& first = PieceOf(contact.geom1);
    const double left = (kNoFrictionDepth + DistanceOf(contact, first.side)) /
                        (kNoFrictionDepth - kFullFrictionDepth);
    const double friction =
        first.friction * PieceOf(contact.geom2).friction * std::clamp(left, 0.0, 1.0);
    contact.friction[0] = contact.friction[1] = std::max<double>(friction, mjMINMU);
  }
}

double MujocoContacts::deepest_m() const {
  double deepest = 0;
  for (int i = 0; i < model_.data->ncon; ++i) {
    const mjContact& contact = model_.data->contact[i];
    deepest = std::max(deepest, -DistanceOf(contact, PieceOf(contact.geom1).side));
  }
  return deepest;
}

void MujocoContacts::AddSelfContact(int index, DoorContacts& contacts) const {
  const mjContact& contact = model_.data->contact[index];
  std::array<double, 6> force{};
  Mujoco().contact_force(model_.model.get(), model_.data.get(), index, force.data());
  ++contacts.self_points;
  contacts.self_force_n += force[0];
  AddTouching(NameOfBody(robot_, PieceOf(contact.geom1).link) + "-" +
                  NameOfBody(robot_, PieceOf(contact.geom2).link),
              contacts.self_touches);
}

void MujocoContacts::AddDoorContact(int index, DoorContacts& contacts) const {
  const mjContact& contact = model_.data->contact[index];
  const bool robot_first = PieceOf(contact.geom1).side == Side::kRobot;
  const MujocoPiece& robot = PieceOf(robot_first ? contact.geom1 : contact.geom2);
  const MujocoPiece& door = PieceOf(robot_first ? contact.geom2 : contact.geom1);
  const double distance = DistanceOf(contact, robot.side);
  const bool pad = door.link == kHandleLink && robot.link >= robot_.left_finger();
  if (pad) contacts.pad_distance_m = std::clamp(distance, 0.0, contacts.pad_distance_m);
  if (distance >= kTouches) return;
  std::array<double, 6> force{};
  Mujoco().contact_force(model_.model.get(), model_.data.get(), index, force.data());
  // the frame's rows are normal and tangents; the force is that of the first geom on the second
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(contact.frame);
  const Eigen::Vector3d on_second =
      frame.transpose() * Eigen::Map<const Eigen::Vector3d>(force.data());
  contacts.force_on_door_n += robot_first ? on_second : Eigen::Vector3d(-on_second);
  if (pad) {
    const auto side = static_cast<std::size_t>(robot.link - robot_.left_finger());
    ++contacts.pad_points[side];
    contacts.pad_force_n[side] += force[0];
    contacts.deepest_m = std::max(contacts.deepest_m, -distance);
  } else {
    ++contacts.arm_points;
    contacts.arm_force_n += force[0];
    AddTouching(NameOfBody(robot_, robot.link) + "-" + std::string(NameOfLink(door.link)),
                contacts.arm_touches);
  }
}

DoorContacts MujocoContacts::Report() const {
  DoorContacts contacts;
  for (int i = 0; i < model_.data->ncon; ++i) {
    const mjContact& contact = model_.data->contact[i];
    const Side first = PieceOf(contact.geom1).side;
    const Side second = PieceOf(contact.geom2).side;
    if (first == Side::kLatch) continue;
    if (first == second)
      AddSelfContact(i, contacts);
    else
      AddDoorContact(i, contacts);
  }
  return contacts;
}

}  // namespace doorforge::internal
