// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <span>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "doorforge/compose/compose.h"
#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/mass_properties.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/schemas/bolt.h"

#include "cut_hull.h"
#include "latch_bodies.h"
#include "scratch_folder.h"
#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

double VolumeOf(const TriangleMesh& mesh) {
  const auto closed = ClosedMesh::From(mesh);
  EXPECT_TRUE(closed.has_value());
  return closed ? MassPropertiesOf(*closed, 1).mass_kg : 0;
}

DoorAsset LeverDoor(const ComposeConfig& config = {}) {
  Part handle = SmallLever();
  handle.pieces.push_back(MakeSolid("rose", BoxMesh({0, -0.02, -0.02}, {0.005, 0.02, 0.02}), 0.1));
  return ComposeDoor(SmallBody(), handle, config);
}

TEST(WithoutBox, LeavesTheVolumeOutsideTheBoxInClosedPieces) {
  const TriangleMesh hull = BoxMesh({0, 0, 0}, {1, 1, 1});
  // how far the box reaches into the cube along each axis, however it lies
  for (const Eigen::Vector3d& low :
       {Eigen::Vector3d(0.2, 0.3, 0.4), Eigen::Vector3d(-1, 0.3, 0.4), Eigen::Vector3d(-1, -1, 0.5),
        Eigen::Vector3d(0.25, -0.5, -0.5)}) {
    const Eigen::AlignedBox3d box(low, low + Eigen::Vector3d(1.3, 0.4, 0.9));
    double sum = 0;
    for (const TriangleMesh& piece : internal::WithoutBox(hull, {RigidTransform::Identity(), box}))
      sum += VolumeOf(piece);
    const Eigen::AlignedBox3d shared =
        box.intersection(Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
    EXPECT_NEAR(sum, 1 - (shared.isEmpty() ? 0 : shared.volume()), 1e-6) << low.transpose();
  }
}

TEST(WithoutBox, LeavesAHullAloneThatItDoesNotMeet) {
  const TriangleMesh hull = BoxMesh({0, 0, 0}, {1, 1, 1});
  const auto pieces =
      internal::WithoutBox(hull, {RotationAbout(Eigen::Vector3d::UnitZ(), 0.7),
                                  {Eigen::Vector3d(3, 3, 3), Eigen::Vector3d(4, 4, 4)}});
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].vertices, hull.vertices);
}

// Whether a convex hull holds the point, or misses it by less than `margin`.
bool Holds(const TriangleMesh& hull, const Eigen::Vector3d& point, double margin) {
  for (const Eigen::Vector3i& t : hull.triangles) {
    const auto corner = [&](int k) { return hull.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (normal.norm() > 1e-12 && normal.normalized().dot(point - corner(0)) > margin) return false;
  }
  return true;
}

// By sampling: no point of the bolt, thrown or drawn back, lies in one of the frame's pieces.
void ExpectFree(const Bolt& bolt, const DoorAsset& door,
                std::span<const internal::FramePiece> frame) {
  for (const double drawn : {0.0, 0.5, 1.0}) {
    const RigidTransform base_from_bolt = door.hinge.parent_from_child_at_zero *
                                          bolt.leaf_from_bolt *
                                          Translation({0, -drawn * bolt.travel_m, 0});
    for (const Eigen::Vector3d& vertex : bolt.bolt_hull.vertices) {
      for (const internal::FramePiece& piece : frame)
        EXPECT_FALSE(Holds(piece.hull, base_from_bolt * vertex, 0.002)) << piece.name;
    }
  }
}

TEST(LatchBodies, TheMortiseHoldsTheBoltWherePiecesOfTheFrameWouldMeetIt) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      const DoorAsset door = LeverDoor({.hinge_side = side, .opening = opening});
      const auto latch = internal::LatchBodiesOf(door);
      ASSERT_TRUE(latch.has_value());
      EXPECT_GT(latch->frame.size(), 2U);  // something was cut, and the strike
      ExpectFree(latch->bolt, door, std::span(latch->frame).first(latch->frame.size() - 1));
    }
  }
}

// A refrigerator's: the frame is a box that goes on behind the leaf's edge, where a bolt that was
// moved out does not come.
TEST(LatchBodies, InPlaceTheMortiseReachesAsFarInAsTheBoltIsDrawn) {
  Part body = SmallBody();
  body.pieces = {MakeSolid("frame", BoxMesh({-0.6, -0.45, 0}, {-0.03, 0.45, 2.05}), 8),
                 MakeSolid("leaf", BoxMesh({-0.05, -0.4, 0}, {0, 0.4, 2}), 20)};
  const DoorAsset door = ComposeDoor(body, SmallLever(), {});
  const auto latch = internal::LatchBodiesInPlace(door);
  ASSERT_TRUE(latch.has_value());
  EXPECT_EQ(latch->bolt.leaf_from_bolt.translation(), BoltOf(door).leaf_from_bolt.translation());
  EXPECT_GT(latch->frame.size(), 1U);
  ExpectFree(latch->bolt, door, latch->frame);
}

// A car's hatch: bolt and strike lie in the middle of the leaf's bounds, far behind the front of
// both leaf and frame.
TEST(LatchBodies, ABoltThatPassesItsStrikePassesTheFrameOfAThickLeafToo) {
  Part body = SmallBody();
  body.pieces = {MakeSolid("frame", BoxMesh({-0.3, 0.405, 0}, {0.02, 0.45, 1.65}), 8),
                 MakeSolid("leaf", BoxMesh({-0.3, -0.4, 0}, {0.02, 0.4, 1.6}), 20)};
  body.joint = {{0.02, -0.4, 1.6}, {0, 0, -1}, 0, 1.5};
  const DoorAsset door = ComposeDoor(body, SmallLever(), {});
  const auto latch = internal::LatchBodiesOf(door);
  ASSERT_TRUE(latch.has_value());
  for (double hinge = 0; hinge < 0.6; hinge += 0.005) {
    const RigidTransform base_from_bolt =
        door.hinge.parent_from_child_at_zero * RotationAbout(door.hinge.axis, hinge) *
        latch->bolt.leaf_from_bolt * Translation({0, -latch->bolt.throw_m, 0});
    for (const Eigen::Vector3d& vertex : latch->bolt.bolt_hull.vertices) {
      for (const internal::FramePiece& piece : latch->frame)
        EXPECT_FALSE(Holds(piece.hull, base_from_bolt * vertex, 0))
            << piece.name << " at " << hinge;
    }
  }
}

// Debian's MuJoCo knows no <mimic> and has one point a contact: what holds is bolt and strike
// alone, at a third of the load that later versions are asked for.
TEST(ExportedUrdf, ItsBoltHoldsTheDoorInMuJoCo) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      const DoorAsset door = LeverDoor({.hinge_side = side, .opening = opening});
      const fs::path folder = ScratchFolder("latch_export") / door.id;
      const std::array formats = {*DoorFormatNamed("urdf")};
      for (const LatchExport latch : {LatchExport::kBolt, LatchExport::kData}) {
        WriteExportedDoor(door, formats, folder, Existing::kReplace, {latch});
        std::array<char, 1000> error{};
        const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(
            mj_loadXML((folder / "model.urdf").c_str(), nullptr, error.data(),
                       static_cast<int>(error.size())),
            mj_deleteModel);
        ASSERT_NE(model, nullptr) << error.data();
        model->opt.timestep = 0.001;
        const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()),
                                                                     mj_deleteData);
        const int hinge = mj_name2id(model.get(), mjOBJ_JOINT, "hinge");
        const Eigen::Vector3d grasp =
            door.handle_joint.parent_from_child_at_zero * door.handle_from_grasp.translation();
        for (int i = 0; i < 1500; ++i) {
          data->qfrc_applied[model->jnt_dofadr[hinge]] =
              25 * grasp.head<2>().norm() * std::min(i / 500.0, 1.0);
          mj_step(model.get(), data.get());
        }
        const double opened = data->qpos[model->jnt_qposadr[hinge]];
        if (latch == LatchExport::kBolt)
          EXPECT_LT(opened, 0.035) << door.id;
        else
          EXPECT_GT(opened, 0.5) << door.id;  // nothing holds it, as export.md says
      }
      fs::remove_all(folder);
    }
  }
}

}  // namespace
}  // namespace doorforge
