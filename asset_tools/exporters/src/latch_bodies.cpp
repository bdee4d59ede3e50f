// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "latch_bodies.h"

#include <algorithm>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/schemas/mesh_file.h"

#include "cut_hull.h"
#include "export_text.h"

namespace doorforge::internal {
namespace {

constexpr double kAround = 0.003;   // [m] of free space around bolt and strike in the mortise
constexpr double kInFront = 0.08;   // [m] of the strike, on the way of the opening leaf
constexpr double kGravity = 9.81;   // [m/s2]
constexpr double kSpareHold = 1.5;  // of the torque that holds the handle's weight

Eigen::AlignedBox3d Bounds(const TriangleMesh& mesh, const RigidTransform& frame_from_mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(frame_from_mesh * vertex);
  return bounds;
}

// Bullet adds a millimetre around every convex mesh: so much more play, or bolt and strike would
// press from the start, and half as much between tip and corner, so that the door unlocks by 8 % of
// the throw early here and late there.
constexpr double kMorePlay = 0.002;        // [m]
constexpr double kMoreClearance = 0.001;   // [m]
constexpr double kLeafClearance = 0.0005;  // [m] between strike and leaf as it passes
constexpr double kPassed = 0.3;            // [rad] the leaf has left the strike behind

// The leaf's bounds in the frame of the bolt.
Eigen::AlignedBox3d LeafAround(const Bolt& bolt, const DoorAsset& door) {
  Eigen::AlignedBox3d leaf;
  for (const DoorGeometry& geometry : door.links[kLeafLink].geometry) {
    if (geometry.label != PointLabel::kHandle)
      leaf.extend(Bounds(geometry.mesh, bolt.leaf_from_bolt.inverse()));
  }
  return leaf;
}

// How much further out than beside the edge at rest the strike must stand, so that the leaf passes
// it as it opens. The leaf is taken for its bounds.
double StrikeOffset(const Bolt& bolt, const DoorAsset& door) {
  const RigidTransform strike_from_base = bolt.base_from_strike.inverse();
  const Eigen::AlignedBox3d leaf = LeafAround(bolt, door);
  const Eigen::Vector3d lip = bolt.strike_hull.vertices[2];  // where its far side begins
  double offset = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i) {
    const RigidTransform turned = door.hinge.parent_from_child_at_zero *
                                  RotationAbout(door.hinge.axis, kPassed * i / kSteps) *
                                  bolt.leaf_from_bolt;
    for (int k = 0; k <= kSteps; ++k) {
      const double x = leaf.min().x() + leaf.sizes().x() * k / kSteps;
      const Eigen::Vector3d at =
          strike_from_base * (turned * Eigen::Vector3d(x, leaf.max().y(), 0));
      if (at.x() < -kLeafClearance || at.x() > lip.x() + kLeafClearance) continue;
      const double surface = std::max(at.x(), 0.0) / lip.x() * lip.y();
      offset = std::max(offset, at.y() - surface + kLeafClearance);
    }
  }
  return offset;
}

// The bolt and its strike, further out of the leaf: the bolt reaches behind the strike nearly as
// far as before, so the door unlocks at nearly the same angle.
Bolt MovedOut(const Bolt& bolt, const DoorAsset& door) {
  Bolt moved = bolt;
  const double offset = StrikeOffset(bolt, door);
  moved.leaf_from_bolt = bolt.leaf_from_bolt * Translation({0, offset, 0});
  const Eigen::Matrix3d base_from_edge =
      (door.hinge.parent_from_child_at_zero * bolt.leaf_from_bolt).linear();
  moved.base_from_strike =
      Translation(base_from_edge * Eigen::Vector3d(kMorePlay, offset + kMoreClearance, 0)) *
      bolt.base_from_strike;
  moved.play_m += kMorePlay;
  return moved;
}

// All that the bolt can reach while the door is closed, and the strike, in the frame of the bolt.
PlacedBox MortiseOf(const Bolt& bolt, const DoorAsset& door) {
  PlacedBox mortise;
  mortise.frame_from_box = door.hinge.parent_from_child_at_zero * bolt.leaf_from_bolt;
  mortise.bounds = Bounds(bolt.bolt_hull, RigidTransform::Identity());
  mortise.bounds.extend(
      Eigen::Vector3d(mortise.bounds.min() - Eigen::Vector3d(0, bolt.travel_m, 0)));
  mortise.bounds.extend(
      Bounds(bolt.strike_hull, mortise.frame_from_box.inverse() * bolt.base_from_strike));
  // what stands out in front of the strike would meet a bolt that passes it, and the frame of a
  // leaf that is thick reaches to the leaf's front
  const double front =
      std::max(mortise.bounds.max().x() + kInFront, LeafAround(bolt, door).max().x());
  mortise.bounds.extend(Eigen::Vector3d(front, mortise.bounds.max().y(), mortise.bounds.max().z()));
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(kAround);
  return {mortise.frame_from_box, {mortise.bounds.min() - around, mortise.bounds.max() + around}};
}

// Files of pieces that were cut begin with `prefix`.
void AddFrame(const DoorAsset& door, const std::string& prefix, LatchBodies& latch) {
  const PlacedBox mortise = MortiseOf(latch.bolt, door);
  for (const DoorGeometry& geometry : door.links[kBaseLink].geometry) {
    for (std::size_t i = 0; i < geometry.hulls.size(); ++i) {
      const std::vector<TriangleMesh> pieces = WithoutBox(geometry.hulls[i], mortise);
      const std::string name = geometry.name + "_" + std::to_string(i);
      if (pieces.size() == 1 && pieces[0].vertices == geometry.hulls[i].vertices) {
        latch.frame.push_back({name, CollisionMeshPath(geometry, i), pieces[0]});
        continue;
      }
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        const std::string piece = name + "_" + std::to_string(k);
        latch.frame.push_back({piece, "meshes/latch/" + prefix + piece + ".obj", pieces[k]});
      }
    }
  }
}

void AddStrike(LatchBodies& latch) {
  TriangleMesh strike = latch.bolt.strike_hull;
  for (Eigen::Vector3d& vertex : strike.vertices) vertex = latch.bolt.base_from_strike * vertex;
  latch.frame.push_back({"strike", kStrikeMeshPath, std::move(strike)});
}

bool MayLatch(const DoorAsset& door) {
  return door.latch.type != LatchType::kNone && Turns(door.handle_joint);
}

// The most that gravity turns the handle with about a level axis.
double HoldingTorque(const DoorAsset& door) {
  const MassProperties& mass = door.links[kHandleLink].mass;
  const Eigen::Vector3d axis = door.handle_joint.axis.normalized();
  const Eigen::Vector3d arm = mass.center_of_mass_m - axis.dot(mass.center_of_mass_m) * axis;
  const double level = axis.head<2>().norm();  // gravity does not turn about the vertical
  return kSpareHold * mass.mass_kg * kGravity * arm.norm() * level;
}

}  // namespace

std::optional<LatchBodies> LatchBodiesOf(const DoorAsset& door) {
  if (!MayLatch(door)) return std::nullopt;
  LatchBodies latch;
  latch.bolt = MovedOut(BoltOf(door), door);
  latch.handle_friction_nm = HoldingTorque(door);
  AddFrame(door, "", latch);
  AddStrike(latch);
  return latch;
}

std::optional<LatchBodies> LatchBodiesInPlace(const DoorAsset& door) {
  if (!MayLatch(door)) return std::nullopt;
  LatchBodies latch;
  latch.bolt = BoltOf(door);
  AddFrame(door, "in_place_", latch);
  return latch;
}

void WriteLatchMeshes(const LatchBodies& latch, const std::filesystem::path& folder) {
  CommitFile(folder / kBoltMeshPath, ToObj(latch.bolt.bolt_hull));
  CommitFile(folder / kStrikeHullPath, ToObj(latch.bolt.strike_hull));
  for (const FramePiece& piece : latch.frame) {
    if (piece.file.starts_with("meshes/latch/")) CommitFile(folder / piece.file, ToObj(piece.hull));
  }
}

MassProperties BoltMass(const Bolt& bolt) {
  return {bolt.mass_kg, Eigen::Vector3d::Zero(), 1e-5 * Eigen::Matrix3d::Identity()};
}

}  // namespace doorforge::internal
