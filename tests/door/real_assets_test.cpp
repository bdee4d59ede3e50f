// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Objects of the release itself, from shared/assets beside the checkout; skipped without them.

#include <cstdlib>
#include <regex>

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "doorforge/compose/compose.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/importers/import_objects.h"

#include "formats/import_unidoormanip.h"
#include "mujoco_door.h"
#include "small_object.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class RealAssets : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path shared = fs::path(DOORFORGE_SOURCE_DIR).parent_path() / "shared/assets";
    if (!fs::exists(shared / "unpack.sh"))
      GTEST_SKIP() << "no real assets beside the checkout (" << shared << ")";
    const fs::path target = fs::path(DOORFORGE_BINARY_DIR) / "real_assets";
    const std::string command =
        "bash '" + (shared / "unpack.sh").string() + "' '" + target.string() + "' unidoormanip";
    ASSERT_EQ(std::system(command.c_str()), 0);
    objects_ = target / "unidoormanip_objects";
  }

  fs::path objects_;
};

// "a b c" of joint `name`'s `element`, read as plain text: nothing of the importer is in it
Eigen::Vector3d TextOf(const std::string& urdf, const std::string& name,
                       const std::string& element) {
  const std::size_t at = urdf.find("<joint name=\"" + name + "\"");
  if (at == std::string::npos) return Eigen::Vector3d::Zero();
  const std::string joint = urdf.substr(at, urdf.find("</joint>", at) - at);
  std::smatch match;
  const std::regex pattern("<" + element + "[^>]*xyz=\"([^ \"]+) ([^ \"]+) ([^ \"]+)\"");
  if (!std::regex_search(joint, match, pattern)) return Eigen::Vector3d::Zero();
  return {std::stod(match[1]), std::stod(match[2]), std::stod(match[3])};
}

// link frame (along the door, up, out) -> ours (out, along the door, up)
Eigen::Vector3d Ours(const Eigen::Vector3d& link) { return {link.z(), link.x(), link.y()}; }

struct Line {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
};

double DistanceBetween(const Line& a, const Eigen::Vector3d& point) {
  return (point - a.point).cross(a.direction).norm();
}

// a part of the unrepaired meshes, enough for composing
Part Unrepaired(const PartDraft& draft) {
  Part part = draft.facts;
  for (const RawPiece& raw : draft.pieces) {
    PartPiece piece;
    piece.name = raw.name;
    piece.mesh = raw.mesh;
    piece.mass = {1, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    part.pieces.push_back(piece);
  }
  return part;
}

void ExpectAxesOfTheSource(const fs::path& folder) {
  const UniDoorManipObject object = ReadUniDoorManip(folder, "");
  const Part body = Unrepaired(LoadBody(object));
  const DoorAsset door = ComposeDoor(body, Unrepaired(LoadHandle(object)), {});
  const auto links = DoorFromLinks(door, 0, 0);
  const std::string urdf = ReadFile(folder / "mobility.urdf");
  // the door stands on the floor, the source's base lies in its middle
  const Eigen::Vector3d up(0, 0, body.joint.origin_m.z() - object.hinge.origin_m.z());
  const Eigen::Vector3d hinge_origin = TextOf(urdf, "joint_1", "origin");
  const Line hinge{Ours(hinge_origin) + up, Ours(TextOf(urdf, "joint_1", "axis"))};
  const Eigen::Vector3d mount =
      TextOf(urdf, "joint_2", "origin") + TextOf(urdf, "joint_3", "origin");
  const Line handle{Ours(hinge_origin + mount) + up, Ours(TextOf(urdf, "joint_2", "axis"))};
  const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  EXPECT_LT(DistanceBetween(hinge, links[kLeafLink].translation()), 1e-4);
  EXPECT_LT(angle(links[kLeafLink].linear() * door.hinge.axis, hinge.direction), 1e-4);
  EXPECT_LT(DistanceBetween(handle, links[kHandleLink].translation()), 1e-4);
  EXPECT_LT(angle(links[kHandleLink].linear() * door.handle_joint.axis, handle.direction), 1e-4);
  // the leaf's real surface is within a leaf's thickness of where the source puts the handle
  EXPECT_LT(std::abs((links[kHandleLink].translation() - handle.point).x()), 0.1);
}

TEST_F(RealAssets, AxesOfAllLeverDoorsAndCabinetsAreThoseOfTheirUrdf) {
  int count = 0;
  for (const char* subtask : {"LeverDoor", "RoundDoor", "Cabinet", "Fridge"}) {
    for (const auto& [folder, format] : FindObjects(objects_ / subtask)) {
      SCOPED_TRACE(folder.string());
      if (std::string(subtask) == "Fridge" && !fs::exists(folder / "texture_dae/frame.dae"))
        continue;
      ExpectAxesOfTheSource(folder);
      ++count;
    }
  }
  EXPECT_GE(count, 22 + 17 + 9 + 6);
}

TEST_F(RealAssets, MeshesFillTheBoxesThatTheObjectsState) {
  int complete = 0;
  std::vector<std::string> contradict;
  for (const auto& [folder, format] : FindObjects(objects_)) {
    SCOPED_TRACE(folder.string());
    try {
      const UniDoorManipObject object = ReadUniDoorManip(folder, "");
      ++complete;
      if (BoxDeviation(object, LoadHandle(object)) > 1e-4 ||
          BoxDeviation(object, LoadBody(object)) > 5e-3)
        contradict.push_back(object.name);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMissing) << error.what();
    }
  }
  EXPECT_EQ(complete, 83);
  // its boxes were written for scales 1 and 0.9, its URDF has 0.7 and 0.7
  EXPECT_EQ(contradict, std::vector<std::string>{"Safe/99611289961230"});
}

TEST_F(RealAssets, ALeverDoorAndACabinetMakeDoorsThatMuJoCoAndUrdfdomLoad) {
  const fs::path root = TestFolder("real_doors");
  const auto import = [&](const fs::path& object) {
    const ImportReport report =
        ImportObjects(FindObjects(objects_ / object), root / "parts", {}, Existing::kRefuse);
    EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported) << report.objects[0].message;
    const DoorAsset door = ComposeDoor(ReadPart(root / "parts" / report.objects[0].body_id),
                                       ReadPart(root / "parts" / report.objects[0].handle_id), {});
    WriteDoorFolder(door, root / door.id, Existing::kRefuse);
    return root / door.id / "model.urdf";
  };
  for (const char* object : {"LeverDoor/99660019960022", "Cabinet/99613409961601"}) {
    const fs::path urdf = import(object);
    EXPECT_TRUE(urdf::parseURDF(ReadFile(urdf)));
    const MuJoCoDoor simulated(urdf);
    EXPECT_TRUE(simulated.ok()) << simulated.error();
  }
}

}  // namespace
}  // namespace doorforge
