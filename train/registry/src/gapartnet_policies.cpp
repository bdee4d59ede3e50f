// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// GAPartNet's heuristics on true poses (Geng et al., GAPartNet, CVPR 2023), as the paper's table
// compares with: a grasp from the box of the handle, fixed increments about true axes, and nothing
// that looks at what came of them. docs/benchmark.md has the variants beside their sources.

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <utility>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/rollout/snapshot_grasp_policy.h"

#include "built_in_policies.h"

namespace doorforge {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

enum class Variant {
  kReleased,  ///< What UniDoorManip's released code does where its flag for the baseline is set.
  kClean,     ///< Middle of the box, its shorter edge between the fingers, arcs about true axes.
  kPull,      ///< GAPartNet's own demonstration: straight pulls, the rotation as it was.
};

// ---- the grasp ----------------------------------------------------------------------------------

// The tool in the handle's frame (x out of the leaf, z up): into the leaf, fingers along `fingers`.
Eigen::Matrix3d ToolAcross(const Eigen::Vector3d& fingers) {
  const Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
  Eigen::Matrix3d rotation;
  rotation << fingers.cross(approach), fingers, approach;
  return rotation;
}

bool StandsUpright(const DoorFacts& door) { return door.category == Category::kWindow; }

// The flag's offsets, in the frame of the released objects: x towards the free edge, z out. Its
// "range" is the box's height, also where it is used as a distance from the leaf.
Eigen::Vector3d ReleasedPoint(const DoorFacts& door) {
  const Eigen::Vector3d size = door.handle_box.sizes();
  const double to_free_edge = door.hinge_side == HingeSide::kLeft ? 1 : -1;
  const auto at = [&](double along, double up, double out) {
    return Eigen::Vector3d(out, to_free_edge * along, up);
  };
  switch (door.category) {
    case Category::kWindow:
      return at(0, (door.handle_box.min().x() + door.handle_box.max().x()) / 2, size.z() / 3);
    case Category::kCar:
      return at(size.y() / 2, 0, size.z() - 0.01);
    case Category::kSafe:
      return at(0, 0, size.z() / 4);
    case Category::kStorageFurniture:
      return at(0, 0, 0.8 * size.z());
    case Category::kInterior:
    case Category::kRefrigerator:
      break;
  }
  return door.mechanism == Mechanism::kRound ? at(0, 0, 0.8 * size.z())
                                             : at(-size.y() / 2, 0, size.z() - 0.01);
}

Eigen::Matrix3d ReleasedRotation(const DoorFacts& door) {
  return ToolAcross(StandsUpright(door) ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ());
}

Eigen::Matrix3d BoxRotation(const Eigen::AlignedBox3d& box) {
  return ToolAcross(box.sizes().y() < box.sizes().z() ? Eigen::Vector3d::UnitY()
                                                      : Eigen::Vector3d::UnitZ());
}

RigidTransform ToolAt(const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation) {
  RigidTransform tool = Translation(place);
  tool.linear() = rotation;
  return tool;
}

RigidTransform ReleasedGrasp(const GraspObservation& seen) {
  Rng rng(seen.seed, "gapartnet/" + seen.episode);
  const double noise = std::clamp(0.5 * rng.Normal(), -1.0, 1.0) * 10 * kDegree;
  const DoorFacts& door = seen.privileged.door;
  return ToolAt(ReleasedPoint(door), ReleasedRotation(door)) *
         RotationAbout(Eigen::Vector3d::UnitZ(), noise);
}

RigidTransform CleanGrasp(const GraspObservation& seen) {
  const Eigen::AlignedBox3d& box = seen.privileged.door.handle_box;
  return ToolAt(box.center(), BoxRotation(box));
}

// The demonstration brings the hand's frame to 0.1 m before the middle of the box's front.
RigidTransform PullGrasp(const GraspObservation& seen) {
  constexpr double kHandBefore = 0.1;
  const Eigen::AlignedBox3d& box = seen.privileged.door.handle_box;
  Eigen::Vector3d front = box.center();
  front.x() = box.max().x();
  const double tool_beyond = seen.hand_from_tcp.translation().z() - kHandBefore;
  return ToolAt(front, BoxRotation(box)) * Translation({0, 0, tool_beyond});
}

class BoxGrasp : public GraspPolicy {
 public:
  explicit BoxGrasp(Variant variant) : variant_(variant) {}

  std::optional<GraspAction> Choose(const GraspObservation& seen) override {
    const RigidTransform tool = seen.privileged.world_from_handle * InHandle(seen);
    GraspAction action;
    action.world_from_hand_rotation = tool.linear() * seen.hand_from_tcp.linear().transpose();
    action.contact_m = tool.translation() - kGraspInsertion * tool.linear().col(2);
    return action;
  }

 private:
  RigidTransform InHandle(const GraspObservation& seen) const {
    switch (variant_) {
      case Variant::kReleased:
        return ReleasedGrasp(seen);
      case Variant::kClean:
        return CleanGrasp(seen);
      case Variant::kPull:
        break;
    }
    return PullGrasp(seen);
  }

  Variant variant_;
};

// ---- the motions --------------------------------------------------------------------------------

/// One motion that is repeated, from where the hand is.
class FixedSteps : public Policy {
 public:
  explicit FixedSteps(Stage stage) : stage_(stage) {}

  void Reset() override { begun_ = false; }
  bool UsesPointCloud() const override { return false; }

  Action Act(const Observation& seen) override {
    const PrivilegedState& now = seen.privileged;
    if (!begun_) start_ = now;
    begun_ = true;
    return Step(now);
  }

 protected:
  virtual Action Step(const PrivilegedState& now) const = 0;
  Stage stage() const { return stage_; }
  const PrivilegedState& start() const { return start_; }  ///< At the stage's first action.

 private:
  Stage stage_;
  PrivilegedState start_;
  bool begun_ = false;
};

Action About(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis, double angle,
             const RigidTransform& hand) {
  const RigidTransform target =
      Translation(origin) * RotationAbout(axis, angle) * Translation(-origin) * hand;
  return {target.translation() - hand.translation(), target.linear()};
}

/// Arcs of the same length about the true axes of handle and hinge.
class CleanSteps : public FixedSteps {
 public:
  using FixedSteps::FixedSteps;

 protected:
  Action Step(const PrivilegedState& now) const override {
    constexpr double kTurn = 5 * kDegree;
    constexpr double kOpen = 3 * kDegree;
    if (stage() == Stage::kHandle)
      return About(now.handle_origin_in_world, now.handle_axis_in_world, kTurn,
                   now.world_from_hand);
    return About(now.hinge_origin_in_world, now.hinge_axis_in_world, kOpen, now.world_from_hand);
  }
};

/// The demonstration pulls by 1 cm an object of 0.4 times its size, so 2.5 cm of a whole one.
class PullSteps : public FixedSteps {
 public:
  using FixedSteps::FixedSteps;

 protected:
  Action Step(const PrivilegedState& /*now*/) const override {
    constexpr double kPull = 0.025;
    return {kPull * start().world_from_handle.linear().col(0), start().world_from_hand.linear()};
  }
};

/// The increments of the released rules, task by task.
class ReleasedSteps : public FixedSteps {
 public:
  using FixedSteps::FixedSteps;

 protected:
  Action Step(const PrivilegedState& now) const override {
    const bool flap = now.door.category == Category::kCar;  // one motion for both stages
    if (stage() == Stage::kOpen || flap)
      return {StepLength(now.door) * now.world_from_handle.linear().col(0), Rotation(now)};
    if (const double twist = TwistOf(now.door); twist != 0) return Twist(now, twist);
    return {StepLength(now.door) * TurningWay(now), Rotation(now)};
  }

 private:
  static double StepLength(const DoorFacts& door) {
    switch (door.category) {
      case Category::kWindow:
      case Category::kSafe:
        return 0.04;
      case Category::kCar:
        return 0.045;
      case Category::kStorageFurniture:
        return 0.05;
      case Category::kInterior:
      case Category::kRefrigerator:
        break;
    }
    return door.mechanism == Mechanism::kRound ? 0.05 : 0.06;
  }

  // About the hand's own axis; 0: the task moves the hand along the handle's axes instead.
  static double TwistOf(const DoorFacts& door) {
    if (door.category == Category::kSafe) return 25 * kDegree;
    const bool round =
        door.category == Category::kStorageFurniture ||
        (door.category == Category::kInterior && door.mechanism == Mechanism::kRound);
    return round ? 20 * kDegree : 0;
  }

  // The released objects all unlock one way; here it is the way that the handle's axis says.
  static Action Twist(const PrivilegedState& now, double angle) {
    const Eigen::Vector3d axis = now.world_from_hand.linear().col(2);
    const double way = axis.dot(now.handle_axis_in_world) > 0 ? 1 : -1;
    return {Eigen::Vector3d::Zero(),
            RotationAbout(axis, way * angle).linear() * now.world_from_hand.linear()};
  }

  // Down the lever, towards the hinge on a window: along the handle's own axes, which turn with it.
  static Eigen::Vector3d TurningWay(const PrivilegedState& now) {
    const Eigen::Matrix3d handle = now.world_from_handle.linear();
    if (now.door.category != Category::kWindow) return -handle.col(2);
    const double to_hinge = now.door.hinge_side == HingeSide::kLeft ? -1 : 1;
    return to_hinge * handle.col(1);
  }

  // The hand as the grasp was meant to be, turned with the handle: of the two half turns the one
  // in which it took hold, or, of hands whose axes are other ones, as it took hold.
  Eigen::Matrix3d Rotation(const PrivilegedState& now) const {
    constexpr double kNear = 30 * kDegree;
    const Eigen::Matrix3d held =
        start().world_from_handle.linear().transpose() * start().world_from_hand.linear();
    for (const double half_turn : {0.0, std::numbers::pi}) {
      const Eigen::Matrix3d meant =
          ReleasedRotation(now.door) * RotationAbout(Eigen::Vector3d::UnitZ(), half_turn).linear();
      if (RotationVector(meant.transpose() * held).norm() < kNear)
        return now.world_from_handle.linear() * meant;
    }
    return now.world_from_handle.linear() * held;
  }
};

std::unique_ptr<Policy> MakeSteps(Variant variant, Stage stage) {
  switch (variant) {
    case Variant::kReleased:
      return std::make_unique<ReleasedSteps>(stage);
    case Variant::kClean:
      return std::make_unique<CleanSteps>(stage);
    case Variant::kPull:
      break;
  }
  return std::make_unique<PullSteps>(stage);
}

}  // namespace

void internal::AddGapartnet(PolicyRegistry& registry) {
  constexpr std::array kNames = {std::pair(Variant::kReleased, "gapartnet"),
                                 std::pair(Variant::kClean, "gapartnet_clean"),
                                 std::pair(Variant::kPull, "gapartnet_pull")};
  for (const auto& [variant, name] : kNames) {
    for (const Stage stage : {Stage::kOpen, Stage::kHandle})
      registry.Add(MotionPolicyRow{
          stage, name, [variant, stage](const auto&) { return MakeSteps(variant, stage); },
          /*is_own=*/false});
    registry.Add(GraspPolicyRow{
        name, [variant](const auto&) { return std::make_unique<BoxGrasp>(variant); }, 1,
        /*is_own=*/false});
  }
}

}  // namespace doorforge
