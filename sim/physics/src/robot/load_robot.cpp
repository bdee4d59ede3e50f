// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/load_robot.h"

#include <algorithm>
#include <numbers>

#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/mesh_file.h"

#include "robot/flying_base.h"
#include "robot/gripper_frames.h"
#include "robot/robot_shapes.h"
#include "robot/robot_tree.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::RobotFaults;
using internal::RobotRoles;
using internal::RobotShapes;

std::vector<std::string> OrderOf(const RobotRoles& roles) {
  std::vector<std::string> order = roles.base;
  order.insert(order.end(), roles.arm.begin(), roles.arm.end());
  order.insert(order.end(), roles.fingers.begin(), roles.fingers.end());
  return order;
}

void CheckJoint(const UrdfJoint& joint, bool finger, RobotFaults& faults) {
  const std::string name = "joint \"" + joint.name + "\": ";
  if (joint.type != UrdfJointType::kContinuous && joint.upper <= joint.lower)
    faults.Add(name + "no range of motion; give `limit` a lower and an upper");
  if (finger) return;  // the force of fingers is physics.finger_force_n
  if (joint.effort.value_or(0) <= 0)
    faults.Add(name + "`limit` has no effort above 0 [N m, or N where it slides]");
  if (joint.velocity.value_or(0) <= 0)
    faults.Add(name + "`limit` has no velocity above 0 [rad/s, or m/s where it slides]");
}

RobotJoint ToJoint(const UrdfJoint& joint, const RobotFrame& parent) {
  RobotJoint result;
  result.name = joint.name;
  result.prismatic = joint.type == UrdfJointType::kPrismatic;
  result.parent = parent.joint;
  result.parent_from_joint = parent.body_from_frame * joint.parent_from_joint;
  result.axis = joint.axis.normalized();
  const bool continuous = joint.type == UrdfJointType::kContinuous;
  result.lower = continuous ? -2 * std::numbers::pi : joint.lower;
  result.upper = continuous ? 2 * std::numbers::pi : joint.upper;
  result.effort = joint.effort.value_or(0);
  result.velocity = joint.velocity.value_or(0);
  return result;
}

const UrdfJoint& JointNamed(const UrdfModel& urdf, const std::string& name) {
  return *std::find_if(urdf.joints.begin(), urdf.joints.end(),
                       [&](const UrdfJoint& joint) { return joint.name == name; });
}

// A link's mass in its body's frame; without an inertia, of its hulls filled evenly.
MassProperties MassOf(const UrdfLink& link, const RobotFrame& frame,
                      const std::vector<RobotPiece>& hulls, double density) {
  if (link.inertial) return Transformed(*link.inertial, frame.body_from_frame);
  std::vector<MassProperties> parts;
  for (const RobotPiece& hull : hulls) {
    const auto closed = density > 0 ? ClosedMesh::From(hull.mesh) : std::nullopt;
    if (closed) parts.push_back(MassPropertiesOf(*closed, density));
  }
  return Combined(parts);
}

void CheckMass(const RobotJoint& joint, const std::string& link, RobotFaults& faults) {
  if (joint.mass.mass_kg > 0 && joint.mass.inertia_kg_m2.trace() > 0) return;
  faults.Add("link \"" + link + "\" (joint \"" + joint.name +
             "\"): no mass or no inertia; give it `inertial`, or density_kg_m3 in NAME.robot.yaml");
}

// Shapes and masses of all links; the joints are there already.
void AddLinks(const UrdfModel& urdf, const std::map<std::string, RobotFrame>& frames,
              const RobotOptions& options, RobotShapes& shapes, RobotDescription& robot) {
  std::vector<std::vector<MassProperties>> masses(robot.joints.size());
  for (const UrdfLink& link : urdf.links) {
    const RobotFrame& frame = frames.at(link.name);
    std::vector<RobotPiece> hulls;
    for (const UrdfShape& shape : link.collisions)
      hulls.push_back(shapes.Hull(link.name, shape, frame));
    if (options.visuals == RobotVisuals::kCollision) {
      robot.visuals.insert(robot.visuals.end(), hulls.begin(), hulls.end());
    } else {
      for (const UrdfShape& shape : link.visuals)
        robot.visuals.push_back(shapes.Visual(link.name, shape, frame));
    }
    if (frame.joint >= 0)
      masses[static_cast<std::size_t>(frame.joint)].push_back(
          MassOf(link, frame, hulls, options.density_kg_m3));
    robot.hulls.insert(robot.hulls.end(), hulls.begin(), hulls.end());
  }
  for (std::size_t i = 0; i < masses.size(); ++i) robot.joints[i].mass = Combined(masses[i]);
}

// In the hand's body; what is not told is guessed.
std::optional<RigidTransform> TcpOf(const std::map<std::string, RobotFrame>& frames,
                                    const RobotOptions& options, const RobotDescription& robot,
                                    RobotFaults& faults) {
  if (!options.tcp_link.empty()) {
    const RobotFrame& frame = frames.at(options.tcp_link);
    if (frame.joint == robot.hand.joint) return frame.body_from_frame;
    faults.Add("tcp_link: \"" + options.tcp_link + "\" is not fixed to the hand");
    return std::nullopt;
  }
  if (options.tcp_xyz_m.empty() && options.tcp_rpy_rad.empty()) {
    const auto guessed = internal::GuessedTcp(robot);
    if (!guessed)
      faults.Add(
          "tool centre: the shapes of hand and fingers do not show it; give tcp_link, or tcp_xyz_m "
          "and tcp_rpy_rad, in NAME.robot.yaml");
    return guessed;
  }
  const auto three = [](const std::vector<double>& v) {
    return v.size() == 3 ? Eigen::Vector3d(v[0], v[1], v[2]) : Eigen::Vector3d::Zero().eval();
  };
  return robot.hand.body_from_frame *
         FromXyzRpy(three(options.tcp_xyz_m), three(options.tcp_rpy_rad));
}

void CheckOptions(const RobotOptions& options, std::size_t arm_joints, RobotFaults& faults) {
  for (const auto& [key, numbers] :
       {std::pair("tcp_xyz_m", &options.tcp_xyz_m), std::pair("tcp_rpy_rad", &options.tcp_rpy_rad)})
    if (!numbers->empty() && numbers->size() != 3)
      faults.Add(std::string(key) + ": expected 3 numbers, found " +
                 std::to_string(numbers->size()));
  if (!options.rest_rad.empty() && options.rest_rad.size() != arm_joints)
    faults.Add("rest_rad: expected " + std::to_string(arm_joints) + " numbers, found " +
               std::to_string(options.rest_rad.size()));
}

RobotModel Build(const std::string& name, const UrdfModel& given, const RobotSource& source,
                 RobotBase base) {
  RootLinkOf(given);  // a walk up from a link ends only in a tree
  RobotFaults faults(name.empty() ? given.name : name);
  RobotRoles roles = internal::FindRoles(given, source.options, base, faults);
  const bool flies = base == RobotBase::kFloating;
  if (flies) faults.Check();  // nobody knows what to cut off without the hand
  const UrdfModel cut = flies ? internal::HandAlone(given, roles, source.options, faults) : given;
  const std::size_t rests = flies ? source.options.rest_rad.size() : roles.arm.size();
  if (flies || !roles.arm.empty()) CheckOptions(source.options, rests, faults);
  for (const UrdfJoint& joint : cut.joints) {
    const bool finger =
        std::find(roles.fingers.begin(), roles.fingers.end(), joint.name) != roles.fingers.end();
    if (joint.type != UrdfJointType::kFixed) CheckJoint(joint, finger, faults);
  }
  const UrdfModel urdf = internal::OnBase(cut, base, roles);
  const std::vector<std::string> order = OrderOf(roles);
  const auto frames = internal::FramesOf(urdf, order);
  RobotDescription robot;
  robot.name = name;
  robot.base = base;
  for (const std::string& joint : order)
    robot.joints.push_back(
        ToJoint(JointNamed(urdf, joint), frames.at(JointNamed(urdf, joint).parent)));
  RobotShapes shapes(source.urdf.parent_path(), source.options, source.read_mesh, faults);
  AddLinks(urdf, frames, source.options, shapes, robot);
  for (const RobotJoint& joint : robot.joints)
    CheckMass(joint, JointNamed(urdf, joint.name).child, faults);
  faults.Check();  // what follows needs whole roles and shapes

  internal::NormaliseFingers(robot);
  robot.hand = frames.at(roles.hand_link);
  robot.tcp.joint = robot.hand.joint;
  if (const auto tcp = TcpOf(frames, source.options, robot, faults)) {
    robot.tcp.body_from_frame = *tcp;
    if (!internal::OrderFingers(robot))
      faults.Add("tool centre: its y axis must lie along the way in which the fingers slide");
  }
  faults.Check();
  if (flies) {
    internal::PointAhead(robot);
    return RobotModel(std::move(robot));  // the posture at rest is the arm's
  }
  const std::vector<double>& rest = source.options.rest_rad;
  robot.rest = ArmVector::Map(rest.data(), static_cast<Eigen::Index>(rest.size()));
  return RobotModel(std::move(robot));
}

RobotOptions OptionsBeside(const fs::path& urdf) {
  fs::path path = urdf;
  path.replace_extension(".robot.yaml");
  return LoadConfig<RobotOptions>(fs::is_regular_file(path) ? path.string() : "", {});
}

RobotModel LoadBuiltIn(RobotBase base) {
  RobotSource source;
  source.urdf = DataFolder() / "robots" / "mobile_franka" / "mobile_franka.urdf";
  source.options.tcp_link = "panda_hand_tcp";
  source.read_mesh = ReadObj;
  return Build("", ReadUrdf(source.urdf), source, base);
}

}  // namespace

RobotModel BuildRobot(const UrdfModel& urdf, const RobotSource& source, RobotBase base) {
  RobotSource readable = source;
  if (!readable.read_mesh) readable.read_mesh = ReadObj;
  // the platform's meshes come from the data folder
  const RobotMeshReader given = readable.read_mesh;
  const fs::path own = DataFolder() / "robots";
  readable.read_mesh = [given, own](const fs::path& path) {
    return path.string().starts_with(own.string()) ? ReadObj(path) : given(path);
  };
  return Build(urdf.name.empty() ? "robot" : urdf.name, urdf, readable, base);
}

RobotModel LoadRobot(const fs::path& urdf, RobotBase base, const RobotMeshReader& read_mesh) {
  if (urdf.empty()) return LoadBuiltIn(base);
  const UrdfModel model = ReadUrdf(urdf);  // names the file itself
  const RobotOptions options = OptionsBeside(urdf);
  try {
    return BuildRobot(model, {urdf, options, read_mesh}, base);
  } catch (const Error& error) {
    const std::string problem = error.what();
    const bool named = problem.find(urdf.string()) != std::string::npos;
    throw Error(error.code(), named ? problem : urdf.string() + ": " + problem);
  }
}

RobotModel LoadMobileFranka() { return LoadBuiltIn(RobotBase::kSliders); }

}  // namespace doorforge
