// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/robot_tree.h"

#include <algorithm>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

#include "flying_base.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kFewestArmJoints = 6;
constexpr std::size_t kMostTurningJoints = 8;

const UrdfJoint* JointNamed(const UrdfModel& urdf, const std::string& name) {
  const auto found = std::find_if(urdf.joints.begin(), urdf.joints.end(),
                                  [&](const UrdfJoint& joint) { return joint.name == name; });
  return found == urdf.joints.end() ? nullptr : &*found;
}

// The joint above each link, found once: a hostile tree is large.
class JointsAbove {
 public:
  explicit JointsAbove(const UrdfModel& urdf) {
    for (const UrdfJoint& joint : urdf.joints) above_.emplace(joint.child, &joint);
  }

  // Nothing above the root.
  const UrdfJoint* Of(const std::string& link) const {
    const auto found = above_.find(link);
    return found == above_.end() ? nullptr : found->second;
  }

  // The link at which the fixed joints above this one end.
  std::string BodyOf(std::string link) const {
    for (const UrdfJoint* above = Of(link);
         above != nullptr && above->type == UrdfJointType::kFixed; above = Of(link))
      link = above->parent;
    return link;
  }

 private:
  std::map<std::string, const UrdfJoint*> above_;
};

std::set<std::string> BodiesThatCarryJoints(const UrdfModel& urdf, const JointsAbove& above) {
  std::set<std::string> bodies;
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.type != UrdfJointType::kFixed) bodies.insert(above.BodyOf(joint.parent));
  }
  return bodies;
}

std::vector<std::string> NamesOf(const std::vector<UrdfJoint>& joints) {
  std::vector<std::string> names;
  for (const UrdfJoint& joint : joints) names.push_back(joint.name);
  return names;
}

std::vector<std::string> NamesOf(const std::vector<UrdfLink>& links) {
  std::vector<std::string> names;
  for (const UrdfLink& link : links) names.push_back(link.name);
  return names;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + '"';
  return text.empty() ? "none" : text;
}

// Sliding joints at the ends of the tree, by the body that carries them.
std::vector<std::string> GuessedFingers(const UrdfModel& urdf, RobotFaults& faults) {
  const JointsAbove above(urdf);
  const std::set<std::string> carriers = BodiesThatCarryJoints(urdf, above);
  std::map<std::string, std::vector<std::string>> sliding;
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.type == UrdfJointType::kPrismatic && !carriers.contains(joint.child))
      sliding[above.BodyOf(joint.parent)].push_back(joint.name);
  }
  std::vector<std::vector<std::string>> pairs;
  for (const auto& [body, joints] : sliding) {
    if (joints.size() == 2) pairs.push_back(joints);
  }
  if (pairs.size() == 1) return pairs.front();
  std::vector<std::string> all;
  for (const auto& [body, joints] : sliding) all.insert(all.end(), joints.begin(), joints.end());
  faults.Add("fingers: expected one pair of sliding joints on the hand, found " +
             std::to_string(pairs.size()) + " pairs (sliding joints at the ends: " + Listed(all) +
             "); name the pair under `fingers` in the file NAME.robot.yaml beside the URDF");
  return {};
}

std::vector<std::string> FingersOf(const UrdfModel& urdf, const RobotOptions& options,
                                   RobotFaults& faults) {
  if (options.fingers.empty()) return GuessedFingers(urdf, faults);
  bool known = options.fingers.size() == 2;
  if (!known) faults.Add("fingers: expected two joints, left and right");
  for (const std::string& name : options.fingers) {
    if (!faults.Knows(name, NamesOf(urdf.joints), "fingers: joint")) {
      known = false;
    } else if (JointNamed(urdf, name)->type != UrdfJointType::kPrismatic) {
      faults.Add("fingers: joint \"" + name + "\" does not slide");
      known = false;
    }
  }
  return known ? options.fingers : std::vector<std::string>{};
}

// Moving joints from the root to the body.
std::vector<std::string> ChainTo(const JointsAbove& above, const std::string& link) {
  std::vector<std::string> chain;
  for (const UrdfJoint* joint = above.Of(link); joint != nullptr; joint = above.Of(joint->parent)) {
    if (joint->type != UrdfJointType::kFixed) chain.insert(chain.begin(), joint->name);
  }
  return chain;
}

void SplitChain(const UrdfModel& urdf, const std::vector<std::string>& chain, RobotRoles& roles,
                RobotFaults& faults) {
  const auto slides = [&](std::size_t i) {
    return i < chain.size() && JointNamed(urdf, chain[i])->type == UrdfJointType::kPrismatic;
  };
  const std::size_t base = slides(0) && slides(1) ? 2 : 0;
  roles.base.assign(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(base));
  roles.arm.assign(chain.begin() + static_cast<std::ptrdiff_t>(base), chain.end());
  if (roles.arm.size() < kFewestArmJoints || roles.arm.size() > kMostTurningJoints)
    faults.Add("arm: " + std::to_string(roles.arm.size()) + " joints between " +
               (base == 2 ? "the base" : "the root") + " and the hand, expected 6 to 8 (" +
               Listed(roles.arm) + "); a hand without an arm can fly: physics.base: floating");
  for (const std::string& name : roles.arm) {
    if (JointNamed(urdf, name)->type == UrdfJointType::kPrismatic)
      faults.Add("joint \"" + name + "\" slides; joints of the arm must turn");
  }
}

void RequireRoles(const UrdfModel& urdf, const RobotRoles& roles, RobotFaults& faults) {
  std::vector<std::string> known = roles.base;
  known.insert(known.end(), roles.arm.begin(), roles.arm.end());
  known.insert(known.end(), roles.fingers.begin(), roles.fingers.end());
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.type != UrdfJointType::kFixed &&
        std::find(known.begin(), known.end(), joint.name) == known.end())
      faults.Add("joint \"" + joint.name +
                 "\" moves, but lies neither between root and hand nor is it a finger; make it "
                 "fixed");
  }
}

}  // namespace

bool RobotFaults::Knows(const std::string& name, const std::vector<std::string>& known,
                        const std::string& where) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return true;
  Add(where + " \"" + name + "\" is not in the URDF; the nearest is \"" + NearestName(name, known) +
      '"');
  return false;
}

void RobotFaults::Check() const {
  if (problems_.empty()) return;
  std::string text = "robot \"" + robot_ + "\" cannot be used:";
  for (const std::string& problem : problems_) text += "\n  " + problem;
  throw Error(ErrorCode::kFormat, text);
}

RobotRoles FindRoles(const UrdfModel& urdf, const RobotOptions& options, RobotBase base,
                     RobotFaults& faults) {
  RobotRoles roles;
  roles.fingers = FingersOf(urdf, options, faults);
  if (!options.tcp_link.empty()) faults.Knows(options.tcp_link, NamesOf(urdf.links), "tcp_link:");
  const bool hand_known = options.hand_link.empty() ||
                          faults.Knows(options.hand_link, NamesOf(urdf.links), "hand_link:");
  if (roles.fingers.empty() || !hand_known) return roles;
  roles.hand_link =
      options.hand_link.empty() ? JointNamed(urdf, roles.fingers[0])->parent : options.hand_link;
  const JointsAbove above(urdf);
  const std::string body = above.BodyOf(roles.hand_link);
  for (const std::string& name : roles.fingers) {
    if (above.BodyOf(JointNamed(urdf, name)->parent) != body)
      faults.Add("finger \"" + name + "\" does not slide on the hand \"" + roles.hand_link + '"');
  }
  if (base == RobotBase::kFloating) return roles;
  SplitChain(urdf, ChainTo(above, roles.hand_link), roles, faults);
  RequireRoles(urdf, roles, faults);
  return roles;
}

namespace {

UrdfJoint& Joint(UrdfModel& urdf, const std::string& name) {
  return *std::find_if(urdf.joints.begin(), urdf.joints.end(),
                       [&](const UrdfJoint& joint) { return joint.name == name; });
}

UrdfJoint FixedJoint(const std::string& name, const std::string& parent, const std::string& child) {
  UrdfJoint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  return joint;
}

// The sliders and the platform of the built-in robot, under names of their own.
void AddSliders(UrdfModel& urdf, RobotRoles& roles) {
  const std::filesystem::path folder = DataFolder() / "robots" / "mobile_franka";
  const UrdfModel franka = ReadUrdf(folder / "mobile_franka.urdf");
  const auto renamed = [](const std::string& name) { return "doorforge_" + name; };
  const std::string root = RootLinkOf(urdf);
  for (std::size_t i = 0; i < 3; ++i) {  // base, basex, basey
    UrdfLink link = franka.links[i];
    link.name = renamed(link.name);
    for (auto* shapes : {&link.visuals, &link.collisions}) {
      for (UrdfShape& shape : *shapes) {
        auto& file = std::get<UrdfMeshFile>(shape.geometry);
        file.filename = (folder / file.filename).string();
      }
    }
    urdf.links.push_back(std::move(link));
    if (i == 2) continue;
    UrdfJoint joint = franka.joints[i];
    joint.name = renamed(joint.name);
    joint.parent = renamed(joint.parent);
    joint.child = renamed(joint.child);
    roles.base.push_back(joint.name);
    urdf.joints.push_back(std::move(joint));
  }
  urdf.joints.push_back(FixedJoint("doorforge_mount", "doorforge_basey", root));
}

void AddTurntable(UrdfModel& urdf, RobotRoles& roles) {
  const std::string platform = Joint(urdf, roles.base.back()).child;
  UrdfLink table;
  table.name = "doorforge_turntable";
  MassProperties mass;
  mass.mass_kg = 5;
  mass.inertia_kg_m2 = Eigen::Vector3d(0.05, 0.05, 0.1).asDiagonal();
  table.inertial = mass;
  UrdfJoint turn;
  turn.name = "doorforge_yaw";
  turn.type = UrdfJointType::kRevolute;
  turn.parent = platform;
  turn.child = table.name;
  turn.axis = Eigen::Vector3d::UnitZ();
  turn.lower = -1.5707963267948966;
  turn.upper = 1.5707963267948966;
  turn.effort = 500;
  turn.velocity = 1;
  for (UrdfJoint& joint : urdf.joints) {
    if (joint.parent == platform) joint.parent = table.name;
  }
  urdf.links.push_back(std::move(table));
  urdf.joints.push_back(turn);
  roles.base.push_back(turn.name);
}

}  // namespace

UrdfModel OnBase(UrdfModel urdf, RobotBase base, RobotRoles& roles) {
  if (base == RobotBase::kFloating) return OnFlyingBase(urdf, roles);
  if (base == RobotBase::kFixed) {
    for (const std::string& name : roles.base) Joint(urdf, name).type = UrdfJointType::kFixed;
    roles.base.clear();
    return urdf;
  }
  if (roles.base.empty()) AddSliders(urdf, roles);
  if (base == RobotBase::kYaw) AddTurntable(urdf, roles);
  return urdf;
}

namespace {

void AddFrames(const UrdfModel& urdf, const std::vector<std::string>& order,
               const std::string& link, std::map<std::string, RobotFrame>& frames) {
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.parent != link) continue;
    const RobotFrame& parent = frames.at(link);
    const auto moving = std::find(order.begin(), order.end(), joint.name);
    frames[joint.child] =
        moving == order.end()
            ? RobotFrame{parent.joint, parent.body_from_frame * joint.parent_from_joint}
            : RobotFrame{static_cast<int>(moving - order.begin()), RigidTransform::Identity()};
    AddFrames(urdf, order, joint.child, frames);
  }
}

}  // namespace

std::map<std::string, RobotFrame> FramesOf(const UrdfModel& urdf,
                                           const std::vector<std::string>& order) {
  std::map<std::string, RobotFrame> frames;
  const std::string root = RootLinkOf(urdf);
  frames[root] = {};
  AddFrames(urdf, order, root, frames);
  return frames;
}

}  // namespace doorforge::internal
