// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/exporters/export_urdf.h"

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "doorforge/compose/compose.h"
#include "doorforge/core/error.h"

#include "mujoco_door.h"
#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

DoorAsset SmallDoor() {
  Part handle = SmallLever();
  handle.pieces.push_back(MakeSolid("rose", BoxMesh({0, -0.02, -0.02}, {0.005, 0.02, 0.02}), 0.1));
  return ComposeDoor(SmallBody(), handle, {});
}

fs::path Written(const DoorAsset& door, const std::string& test) {
  const fs::path folder = TestFolder(test) / "door";
  WriteDoorFolder(door, folder, Existing::kRefuse);
  return folder;
}

TEST(ExportUrdf, UrdfdomReadsWhatTheDoorSays) {
  const DoorAsset door = SmallDoor();
  const fs::path folder = Written(door, "urdfdom");
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(ReadFile(folder / "model.urdf"));
  ASSERT_TRUE(model);
  EXPECT_EQ(model->getRoot()->name, "base");
  const auto hinge = model->getJoint("hinge");
  ASSERT_TRUE(hinge);
  EXPECT_EQ(hinge->type, urdf::Joint::REVOLUTE);
  EXPECT_NEAR(hinge->limits->upper, door.hinge.upper_rad, 1e-12);
  EXPECT_GT(hinge->limits->effort, 0);
  EXPECT_GT(hinge->limits->velocity, 0);
  EXPECT_NEAR(hinge->dynamics->damping, 0.5, 1e-12);
  const auto handle = model->getLink("handle");
  ASSERT_TRUE(handle && handle->inertial);
  EXPECT_NEAR(handle->inertial->mass, door.links[kHandleLink].mass.mass_kg, 1e-12);
  EXPECT_NEAR(handle->inertial->ixx, door.links[kHandleLink].mass.inertia_kg_m2(0, 0), 1e-12);
  EXPECT_EQ(model->getLink("leaf")->collision_array.size(), 2U);
}

TEST(ExportUrdf, MuJoCoMovesTheDoorAsWeDo) {
  const DoorAsset door = SmallDoor();
  const MuJoCoDoor simulated(Written(door, "mujoco") / "model.urdf");
  ASSERT_TRUE(simulated.ok()) << simulated.error();
  EXPECT_EQ(simulated.joint_count(), 2);
  for (const double hinge : {0.0, 0.9}) {
    for (const double handle : {0.0, 0.6}) {
      const auto ours = DoorFromLinks(door, hinge, handle);
      const auto theirs = simulated.LinkPoses(hinge, handle);
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_TRUE(ours[i + 1].isApprox(theirs[i], 1e-6)) << "link " << i + 1;
    }
  }
  EXPECT_NEAR(simulated.MassOf("leaf"), door.links[kLeafLink].mass.mass_kg, 1e-9);
}

TEST(ExportUrdf, AHandleThatDoesNotTurnIsFixed) {
  Part pull = SmallLever();
  pull.mechanism = Mechanism::kNone;
  pull.joint.upper_rad = 0;
  const DoorAsset door = ComposeDoor(SmallBody(), pull, {});
  EXPECT_EQ(ToUrdfModel(door).joints[1].type, UrdfJointType::kFixed);
  const MuJoCoDoor simulated(Written(door, "mujoco_fixed") / "model.urdf");
  ASSERT_TRUE(simulated.ok()) << simulated.error();
  EXPECT_EQ(simulated.joint_count(), 1);
}

TEST(ExportUrdf, ADoorReadBackIsTheDoorInMemory) {
  const DoorAsset door = SmallDoor();
  EXPECT_EQ(ContentHash(ReadDoor(Written(door, "door_round_trip"))), ContentHash(door));
}

TEST(ExportUrdf, AnExistingDoorIsNotReplacedUnasked) {
  const DoorAsset door = SmallDoor();
  const fs::path folder = Written(door, "existing");
  EXPECT_THROW(WriteDoorFolder(door, folder, Existing::kRefuse), Error);
  EXPECT_NO_THROW(WriteDoorFolder(door, folder, Existing::kReplace));
}

}  // namespace
}  // namespace doorforge
