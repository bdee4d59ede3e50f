// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mujoco/mujoco_scene.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <Eigen/Eigenvalues>

#include "robot/simulated_robot.h"
#include "world/door_inertia.h"

namespace doorforge::internal {
namespace {

// What may touch whom, as bits: the robot itself and the door, bolt and strike each other.
constexpr const char* kRobotBits = " contype='1' conaffinity='1'";
constexpr const char* kDoorBits = " contype='0' conaffinity='1'";
constexpr const char* kLatchBits = " contype='2' conaffinity='2'";
// Contacts are reported from this on beyond the skin [m], as touching is in DoorContacts.
constexpr double kSeen = 0.001;
constexpr double kLatchSkin = 2e-4;
constexpr double kLeafFriction = 0.5;
// How the fingers hang together: the pair gives by about 1 mm where one bears 20 N more than the
// other. Bullet's gear is rigid, and so are its contacts, which share such a load by chance; here
// contacts are springs, and a handle a little beside the middle would have it all on one pad.
constexpr const char* kFingerCoupling = "0.005 1' solimp='0.9 0.9 0.001'";

std::string Listed(const Eigen::Vector3d& v) {
  std::ostringstream text;
  text.precision(15);
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

std::string Placed(const RigidTransform& transform) {
  const Eigen::Quaterniond turn(transform.linear());
  std::ostringstream text;
  text.precision(15);
  text << " pos='" << Listed(transform.translation()) << "' quat='" << turn.w() << ' ' << turn.x()
       << ' ' << turn.y() << ' ' << turn.z() << "'";
  return text.str();
}

std::string Inertial(const MassProperties& mass, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mass.inertia_kg_m2);
  RigidTransform place = Translation(mass.center_of_mass_m);
  place.linear() = solver.eigenvectors();
  if (place.linear().determinant() < 0) place.linear().col(2) *= -1;
  std::ostringstream text;
  text.precision(15);
  text << "<inertial" << Placed(place) << " mass='" << mass.mass_kg << "' diaginertia='"
       << Listed(solver.eigenvalues().cwiseMax(least)) << "'/>\n";
  return text.str();
}

/// Writes bodies; meshes are collected aside, since they come before them in the file.
class SceneWriter {
 public:
  explicit SceneWriter(std::vector<MujocoPiece>& pieces) : pieces_(pieces) {
    bodies.precision(15);
    meshes_.precision(15);
  }

  void Hull(const TriangleMesh& mesh, const MujocoPiece& piece, const RigidTransform& place) {
    const bool latch = piece.side == MujocoPiece::Side::kLatch;
    const std::size_t index = pieces_.size();
    meshes_ << "<mesh name='m" << index << "' vertex='";
    for (const Eigen::Vector3d& vertex : mesh.vertices) meshes_ << Listed(vertex) << "  ";
    meshes_ << "'/>\n";
    bodies << "<geom name='g" << index << "' type='mesh' mesh='m" << index << '\''
           << (latch                                     ? kLatchBits
               : piece.side == MujocoPiece::Side::kRobot ? kRobotBits
                                                         : kDoorBits)
           << " margin='" << (latch ? kLatchSkin : kMujocoSkin + kSeen) << "' gap='"
           << (latch ? 0 : kSeen) << "'" << Placed(place) << "/>\n";
    pieces_.push_back(piece);
  }

  void Joint(const std::string& name, bool slides, const Eigen::Vector3d& axis,
             const Eigen::Vector2d& range) {
    bodies << "<joint name='" << name << "' type='" << (slides ? "slide" : "hinge") << "' axis='"
           << Listed(axis) << "' range='" << range.x() << ' ' << range.y() << "'";
  }

  std::string meshes() const { return meshes_.str(); }
  std::ostringstream bodies;

 private:
  std::vector<MujocoPiece>& pieces_;
  std::ostringstream meshes_;
};

class RobotWriter {
 public:
  RobotWriter(SceneWriter& writer, const RobotModel& robot, double finger_friction)
      : writer_(writer), robot_(robot), frictions_(FrictionsOf(robot, finger_friction)) {}

  void BodiesOn(int parent) {
    for (int i = 0; i < robot_.joint_count(); ++i) {
      if (robot_.joint(i).parent == parent) Body(i);
    }
  }

 private:
  void Body(int index) {
    const RobotJoint& joint = robot_.joint(index);
    writer_.bodies << "<body name='robot" << index << '\'' << Placed(joint.parent_from_joint)
                   << ">\n";
    writer_.Joint(std::string("robot") + std::to_string(index), joint.prismatic, joint.axis,
                  {joint.lower, joint.upper});
    // the drive is a friction that the engine leads: its limit is set in each step
    writer_.bodies << " frictionloss='1'/>\n" << Inertial(joint.mass, LeastInertiaOf(joint));
    for (const RobotPiece& piece : robot_.hulls()) {
      if (piece.joint == index)
        writer_.Hull(
            piece.mesh,
            {MujocoPiece::Side::kRobot, index, frictions_[static_cast<std::size_t>(index)]},
            RigidTransform::Identity());
    }
    BodiesOn(index);
    writer_.bodies << "</body>\n";
  }

  SceneWriter& writer_;
  const RobotModel& robot_;
  std::vector<double> frictions_;
};

void AddHulls(SceneWriter& writer, const DoorAsset& door, DoorLinkIndex link, double friction) {
  for (const DoorGeometry& geometry : door.links[link].geometry) {
    for (const TriangleMesh& hull : geometry.hulls)
      writer.Hull(hull, {MujocoPiece::Side::kDoor, link, friction}, RigidTransform::Identity());
  }
}

// Viscous torque up to what one step of the scene could turn into acceleration, as in Bullet.
void AddTurning(SceneWriter& writer, const char* name, const DoorJoint& joint,
                double most_damping) {
  if (joint.upper_rad <= joint.lower_rad) return;
  writer.Joint(name, false, joint.axis, {joint.lower_rad, joint.upper_rad});
  writer.bodies << " damping='" << std::min(joint.damping_nm_s, most_damping) << "'/>\n";
}

void AddBolt(SceneWriter& writer, const Bolt& bolt) {
  writer.bodies << "<body name='bolt'" << Placed(bolt.leaf_from_bolt) << ">\n<inertial pos='0 0 0' "
                << "mass='" << bolt.mass_kg << "' diaginertia='1e-5 1e-5 1e-5'/>\n";
  writer.Joint("bolt", true, Eigen::Vector3d::UnitY(), {-bolt.travel_m, 0});
  writer.bodies << " damping='" << bolt.damping_n_s_m << "' stiffness='" << bolt.stiffness_n_per_m
                << "' springref='" << bolt.preload_n / bolt.stiffness_n_per_m << "'/>\n";
  writer.Hull(bolt.bolt_hull, {MujocoPiece::Side::kLatch, 0, bolt.friction},
              RigidTransform::Identity());
  writer.bodies << "</body>\n";
}

void AddDoor(SceneWriter& writer, const Scene& scene, const DoorAsset& door,
             const std::optional<Bolt>& bolt) {
  const DoorLink& leaf = door.links[kLeafLink];
  const DoorLink& handle = door.links[kHandleLink];
  const auto most_damping = [&](const DoorJoint& joint, const DoorLink& link, double least) {
    return 0.5 * InertiaAbout(joint, link.mass, least) / scene.physics.time_step_s;
  };
  writer.bodies << "<body name='frame'" << Placed(scene.world_from_door) << ">\n";
  AddHulls(writer, door, kBaseLink, kLeafFriction);
  if (bolt)
    writer.Hull(bolt->strike_hull, {MujocoPiece::Side::kLatch, 1, 1}, bolt->base_from_strike);
  writer.bodies << "<body name='leaf'" << Placed(door.hinge.parent_from_child_at_zero) << ">\n";
  AddTurning(writer, "leaf", door.hinge, most_damping(door.hinge, leaf, kLeastLeafInertia));
  writer.bodies << Inertial(leaf.mass, kLeastLeafInertia);
  AddHulls(writer, door, kLeafLink, kLeafFriction);
  if (bolt) AddBolt(writer, *bolt);
  writer.bodies << "<body name='handle'" << Placed(door.handle_joint.parent_from_child_at_zero)
                << ">\n";
  AddTurning(writer, "handle", door.handle_joint,
             most_damping(door.handle_joint, handle, kLeastHandleInertia));
  writer.bodies << Inertial(handle.mass, kLeastHandleInertia);
  AddHulls(writer, door, kHandleLink, scene.physics.handle_friction);
  writer.bodies << "</body></body></body>\n";
}

// The pairs of the robot's bodies that do not touch.
std::string Excluded(const RobotModel& robot) {
  const std::set<std::pair<int, int>> meet(robot.self_collisions().begin(),
                                           robot.self_collisions().end());
  std::ostringstream text;
  for (int second = 1; second < robot.joint_count(); ++second) {
    for (int first = 0; first < second; ++first) {
      if (!meet.contains({first, second}))
        text << "<exclude body1='robot" << first << "' body2='robot" << second << "'/>\n";
    }
  }
  return text.str();
}

// A cable: the handle pulls the bolt back, and nothing pushes the handle.
std::string Cable(const Bolt& bolt, const std::string& stiff) {
  std::ostringstream text;
  text.precision(15);
  text << "<tendon><fixed name='latch' limited='true' range='-1 0' solreflimit='" << stiff
       << "' solimplimit='0.99 0.999 0.0001'><joint joint='bolt' coef='1'/><joint joint='handle' "
          "coef='"
       << bolt.travel_m_per_rad << "'/></fixed></tendon>\n";
  return text.str();
}

}  // namespace

MujocoSceneText DescribeForMujoco(const Scene& scene, const DoorAsset& door,
                                  const RobotModel& robot, const std::optional<Bolt>& bolt,
                                  double time_step_s) {
  MujocoSceneText result;
  SceneWriter writer(result.pieces);
  writer.bodies << "<body" << Placed(scene.world_from_robot_base) << ">\n";
  RobotWriter(writer, robot, scene.physics.finger_friction).BodiesOn(-1);
  writer.bodies << "</body>\n";
  AddDoor(writer, scene, door, bolt);
  std::ostringstream stiff;  // as stiff as the step allows, critically damped
  stiff.precision(15);
  stiff << 2 * time_step_s << " 1";
  const std::string hard = "'" + stiff.str() + "'";
  std::ostringstream text;
  text.precision(15);
  text << "<mujoco><compiler angle='radian' inertiafromgeom='false' balanceinertia='true'/>\n"
       << "<option timestep='" << time_step_s << "' gravity='0 0 0' integrator='Euler' "
       << "solver='Newton' cone='elliptic' impratio='20' jacobian='dense' tolerance='1e-10' "
       << "iterations='" << scene.physics.solver_iterations
       << "'><flag multiccd='enable'/></option>\n<size njmax='500' nconmax='120'/>\n"
       << "<default><geom condim='3' friction='1 0 0' solref=" << hard
       << " solimp='0.95 0.99 0.0005'/><joint limited='true' solreflimit=" << hard
       << " solimplimit='0.99 0.999 0.0001' solreffriction=" << hard
       << " solimpfriction='0.9999 0.9999 0.0001'/><equality solref='" << kFingerCoupling
       << "/></default>\n<asset>\n"
       << writer.meshes() << "</asset>\n<worldbody>\n"
       << writer.bodies.str() << "</worldbody>\n<contact>\n"
       << Excluded(robot) << "</contact>\n<equality><joint joint1='robot" << robot.left_finger()
       << "' joint2='robot" << robot.right_finger() << "'/></equality>\n"
       << (bolt ? Cable(*bolt, stiff.str()) : "") << "</mujoco>\n";
  result.xml = text.str();
  return result;
}

}  // namespace doorforge::internal
