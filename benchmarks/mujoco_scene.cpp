// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mujoco_scene.h"

#include <algorithm>
#include <functional>
#include <sstream>

#include <Eigen/Eigenvalues>

namespace doorforge {
namespace {

constexpr int kRobotBit = 1;
constexpr int kDoorBit = 2;

std::string Numbers(const Eigen::Vector3d& v) {
  std::ostringstream text;
  text.precision(12);
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

std::string PlaceOf(const RigidTransform& transform) {
  const Eigen::Quaterniond turn(transform.linear());
  std::ostringstream text;
  text.precision(12);
  text << " pos='" << Numbers(transform.translation()) << "' quat='" << turn.w() << ' ' << turn.x()
       << ' ' << turn.y() << ' ' << turn.z() << "'";
  return text.str();
}

std::string InertialOf(const MassProperties& mass, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia_kg_m2);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  RigidTransform place = Translation(mass.center_of_mass_m);
  place.linear() = axes;
  std::ostringstream text;
  text << "<inertial" << PlaceOf(place) << " mass='" << mass.mass_kg << "' diaginertia='"
       << Numbers(solver.eigenvalues().cwiseMax(least)) << "'/>\n";
  return text.str();
}

class Writer {
 public:
  // Meshes are collected aside: they come before the bodies in the file.
  void Hull(const TriangleMesh& mesh, int own, double friction) {
    const std::string name = "hull" + std::to_string(hulls_++);
    assets_ << "<mesh name='" << name << "' vertex='";
    for (const Eigen::Vector3d& vertex : mesh.vertices) assets_ << Numbers(vertex) << "  ";
    assets_ << "'/>\n";
    bodies << "<geom type='mesh' mesh='" << name << "' contype='" << own << "' conaffinity='"
           << (own == kRobotBit ? kDoorBit : kRobotBit) << "' friction='" << friction
           << " 0 0' condim='3' margin='0.001'/>\n";
  }
  std::string assets() const { return assets_.str(); }
  std::ostringstream bodies;

 private:
  std::ostringstream assets_;
  int hulls_ = 0;
};

void Joint(Writer& writer, const std::string& name, bool slides, const Eigen::Vector3d& axis,
           const Eigen::Vector2d& range) {
  writer.bodies << "<joint name='" << name << "' type='" << (slides ? "slide" : "hinge")
                << "' axis='" << Numbers(axis) << "' limited='true' range='" << range.x() << ' '
                << range.y() << "'/>\n";
}

void WriteRobot(Writer& writer, const Scene& scene, const RobotModel& robot) {
  const std::size_t count = robot.joints().size();
  const std::function<void(int)> body = [&](int parent) {
    for (std::size_t i = 0; i < count; ++i) {
      const RobotJoint& joint = robot.joints()[i];
      if (joint.parent != parent) continue;
      writer.bodies << "<body" << PlaceOf(joint.parent_from_joint) << ">\n";
      Joint(writer, "robot" + std::to_string(i), joint.prismatic, joint.axis,
            {joint.lower, joint.upper});
      writer.bodies << InertialOf(joint.mass, joint.prismatic ? 1e-3 : 1e-2);
      const double friction = i + 2 >= count ? scene.physics.finger_friction : 0.3;
      for (const RobotPiece& piece : robot.hulls()) {
        if (piece.joint == static_cast<int>(i)) writer.Hull(piece.mesh, kRobotBit, friction);
      }
      body(static_cast<int>(i));
      writer.bodies << "</body>\n";
    }
  };
  writer.bodies << "<body" << PlaceOf(scene.world_from_robot_base) << ">\n";
  body(-1);
  writer.bodies << "</body>\n";
}

void WriteLink(Writer& writer, const DoorLink& link, double least, double friction) {
  writer.bodies << InertialOf(link.mass, least);
  for (const DoorGeometry& geometry : link.geometry) {
    for (const TriangleMesh& hull : geometry.hulls) writer.Hull(hull, kDoorBit, friction);
  }
}

void WriteDoor(Writer& writer, const Scene& scene, const DoorAsset& door) {
  writer.bodies << "<body" << PlaceOf(scene.world_from_door) << ">\n<body"
                << PlaceOf(door.hinge.parent_from_child_at_zero) << ">\n";
  Joint(writer, "leaf", false, door.hinge.axis, {door.hinge.lower_rad, door.hinge.upper_rad});
  WriteLink(writer, door.links[kLeafLink], 1e-2, 0.5);
  writer.bodies << "<body" << PlaceOf(door.handle_joint.parent_from_child_at_zero) << ">\n";
  Joint(writer, "handle", false, door.handle_joint.axis,
        {door.handle_joint.lower_rad, door.handle_joint.upper_rad});
  // MuJoCo combines frictions by the larger one; the pads' is the product already
  WriteLink(writer, door.links[kHandleLink], 5e-4, scene.physics.handle_friction);
  writer.bodies << "</body></body></body>\n";
}

std::string Actuators(const RobotModel& robot) {
  std::ostringstream text;
  const std::size_t count = robot.joints().size();
  for (std::size_t i = 0; i < count; ++i) {
    const double effort = robot.joints()[i].effort;
    if (i + 2 < count) {
      text << "<position joint='robot" << i << "' kp='" << (i < 2 ? 20000 : 2000)
           << "' forcelimited='true' forcerange='" << -effort << ' ' << effort << "'/>\n";
    } else {
      text << "<motor joint='robot" << i << "'/>\n";
    }
  }
  return text.str();
}

}  // namespace

std::string MujocoScene(const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
  Writer writer;
  WriteRobot(writer, scene, robot);
  WriteDoor(writer, scene, door);
  const std::size_t count = robot.joints().size();
  std::ostringstream text;
  text << "<mujoco><compiler angle='radian' inertiafromgeom='false'/>\n<option timestep='"
       << scene.physics.time_step_s << "' gravity='0 0 0' iterations='"
       << scene.physics.solver_iterations
       << "' integrator='implicit'/>\n<size njmax='2000' nconmax='400'/>\n<default><joint "
          "damping='10'/></default>\n<asset>\n"
       << writer.assets() << "</asset>\n<worldbody>\n"
       << writer.bodies.str() << "</worldbody>\n<equality><joint joint1='robot" << count - 2
       << "' joint2='robot" << count - 1 << "'/></equality>\n<actuator>\n"
       << Actuators(robot) << "</actuator></mujoco>\n";
  return text.str();
}

}  // namespace doorforge
