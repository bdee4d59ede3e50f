// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/compose/shared_doors.h"

#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/schemas/door_index.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/mesh_pool.h"
#include "doorforge/validate/validate_door.h"

#include "mujoco_door.h"
#include "scratch_folder.h"
#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Part LeverWithRose() {
  Part handle = SmallLever();
  handle.pieces.push_back(MakeSolid("rose", BoxMesh({0, -0.02, -0.02}, {0.005, 0.02, 0.02}), 0.1));
  return handle;
}

class SharedDoors : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        ScratchFolder("shared") / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    bodies_ = {SmallBody(), SmallBody()};
    bodies_[1].id = "second_body";
    bodies_[1].part_from_mount.translation().z() = 0.9;
    handles_ = {LeverWithRose(), SmallLever()};
    handles_[1].id = "plain_lever";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<SharedDoorOutcome> Write(const fs::path& out, int threads, Existing existing,
                                       const ComposeConfig& config = {}) const {
    std::vector<PreparedPart> parts;
    for (const auto* list : {&bodies_, &handles_}) {
      for (const Part& part : *list) parts.emplace_back(part, config);
    }
    const std::vector<PartPair> pairs = {{0, 2}, {0, 3}, {1, 2}, {1, 3}};
    WriteMeshPool(parts, out, threads);
    return WriteSharedDoors({parts, pairs, config, existing, threads}, out, [](std::size_t) {});
  }

  static std::map<std::string, std::string> FilesBelow(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file())
        files[entry.path().lexically_relative(folder).string()] = ReadFile(entry.path());
    }
    return files;
  }

  fs::path folder_;
  std::vector<Part> bodies_;
  std::vector<Part> handles_;
};

TEST_F(SharedDoors, APairThatIsNoDoorIsNamedAsTheDoorWouldBe) {
  const ComposeConfig config{.handle_height_m = 3, .hinge_side = HingeSide::kRight};
  for (const SharedDoorOutcome& outcome : Write(folder_, 1, Existing::kRefuse, config)) {
    EXPECT_NE(outcome.problem.find("CMP008"), std::string::npos) << outcome.problem;
    EXPECT_TRUE(outcome.id.ends_with("__right")) << outcome.id;
  }
}

TEST_F(SharedDoors, ADoorThatSharesMeshesIsTheDoorComposedAlone) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    const ComposeConfig config{.hinge_side = side};
    const fs::path out = folder_ / NameOf(side);
    for (const SharedDoorOutcome& outcome : Write(out, 1, Existing::kRefuse, config))
      EXPECT_EQ(outcome.problem, "");
    const std::string suffix = side == HingeSide::kRight ? "__right" : "";
    const DoorAsset shared = ReadDoor(out / ("second_body__small_lever" + suffix));
    const DoorAsset alone = ComposeDoor(bodies_[1], handles_[0], config);
    EXPECT_EQ(ContentHash(shared), ContentHash(alone));
    EXPECT_EQ(shared.links[kLeafLink].geometry.size(), 2U);
  }
}

TEST_F(SharedDoors, EveryNumberOfThreadsWritesTheSameBytes) {
  Write(folder_ / "one", 1, Existing::kRefuse);
  Write(folder_ / "four", 4, Existing::kRefuse);
  const auto one = FilesBelow(folder_ / "one");
  EXPECT_EQ(one, FilesBelow(folder_ / "four"));
  EXPECT_EQ(one.count("small_body__plain_lever/model.urdf"), 1U);
}

TEST_F(SharedDoors, ARunThatWasEndedGoesOnWhereItWas) {
  Write(folder_, 2, Existing::kRefuse);
  const auto before = FilesBelow(folder_);
  fs::remove_all(folder_ / "second_body__plain_lever");
  const auto outcomes = Write(folder_, 2, Existing::kRefuse);
  EXPECT_EQ(FilesBelow(folder_), before);
  EXPECT_EQ(std::count_if(outcomes.begin(), outcomes.end(),
                          [](const SharedDoorOutcome& outcome) { return outcome.kept; }),
            3);
}

TEST_F(SharedDoors, AnotherDoorOfThatNameIsReplacedOnlyWhenAsked) {
  Write(folder_, 1, Existing::kRefuse);
  const ComposeConfig other{.lock_effort_nm = 40};
  EXPECT_NE(Write(folder_, 1, Existing::kRefuse, other)[0].problem.find("--overwrite"),
            std::string::npos);
  EXPECT_EQ(Write(folder_, 1, Existing::kReplace, other)[0].problem, "");
  EXPECT_EQ(ReadDoor(folder_ / "small_body__small_lever").latch.lock_effort_nm, 40);
}

TEST_F(SharedDoors, MuJoCoAndTheValidatorFollowTheUrdfIntoThePool) {
  Write(folder_, 1, Existing::kRefuse);
  const fs::path door = folder_ / "small_body__small_lever";
  const MuJoCoDoor simulated(door / "model.urdf");
  ASSERT_TRUE(simulated.ok()) << simulated.error();
  EXPECT_NEAR(simulated.MassOf("leaf"), ReadDoor(door).links[kLeafLink].mass.mass_kg, 1e-9);
  // the small parts break rules of shape; nothing is wrong with files, URDF or joints
  for (const Finding& finding : ValidateDoor(door).findings) {
    const std::string family = finding.code.substr(0, 3);
    EXPECT_TRUE(family == "COL" || family == "HND") << finding.code << " " << finding.measured;
  }
}

TEST_F(SharedDoors, TheirIndexHoldsTheHashesOfTheDoorsThemselves) {
  for (const ComposeConfig& config :
       {ComposeConfig{}, ComposeConfig{.hinge_side = HingeSide::kRight},
        ComposeConfig{.opening = Opening::kPush, .handle_turn_deg = 90}}) {
    const fs::path out =
        folder_ / (std::string(NameOf(config.hinge_side)) + std::string(NameOf(config.opening)));
    Write(out, 1, Existing::kRefuse, config);
    WriteDoorIndex(out, 2);
    const std::vector<FoundDoor> doors = FindDoorSet({.folders = {out}}, 1).doors;
    ASSERT_EQ(doors.size(), 4U);
    for (const FoundDoor& door : doors) {
      EXPECT_TRUE(door.is_indexed);
      EXPECT_EQ(door.identity, IdentityOf(ReadDoor(door.folder)));
    }
  }
}

// Meshes that were hashed for a door before are not hashed again, roses at other places are.
TEST_F(SharedDoors, DoorsReadOneAfterTheOtherHaveTheirOwnMeshesAndIdentities) {
  Write(folder_, 1, Existing::kRefuse);
  DoorIdentifier identifier;
  for (int time = 0; time < 2; ++time) {
    for (const FoundDoor& found : FindDoorSet({.folders = {folder_}}, 1).doors) {
      const auto [door, identity] = identifier.Read(found.folder);
      EXPECT_EQ(identity, IdentityOf(ReadDoor(found.folder)));
      EXPECT_EQ(IdentityOf(door), identity);
    }
  }
}

TEST_F(SharedDoors, AChangedPoolFileIsNoticedThoughItWasReadBefore) {
  Write(folder_, 1, Existing::kRefuse);
  const fs::path door = FindDoorSet({.folders = {folder_}}, 1).doors.at(0).folder;
  DoorIdentifier identifier;
  identifier.Read(door);
  const fs::path mesh = door / ReadDoorFiles(door)[kLeafLink][0].mesh;
  CommitFile(mesh, ReadFile(mesh) + "v 9 9 9\n");
  EXPECT_THROW(identifier.Read(door), Error);
}

TEST_F(SharedDoors, AChangedPoolFileIsNoticedBesideAnIndexToo) {
  Write(folder_, 1, Existing::kRefuse);
  WriteDoorIndex(folder_, 1);
  const std::vector<FoundDoor> doors = FindDoorSet({.folders = {folder_}}, 1).doors;
  DoorCache shelf(doors);
  const fs::path mesh = doors.at(0).folder / ReadDoorFiles(doors[0].folder)[kLeafLink][0].mesh;
  CommitFile(mesh, ReadFile(mesh) + "v 9 9 9\n");
  EXPECT_THROW(shelf.Take(0), Error);
}

TEST_F(SharedDoors, AChangedPoolFileIsNoticed) {
  Write(folder_, 1, Existing::kRefuse);
  const fs::path door = folder_ / "small_body__small_lever";
  const std::string mesh = ReadDoorFiles(door)[kLeafLink][0].mesh;
  CommitFile(door / mesh, ReadFile(door / mesh) + "v 9 9 9\n");
  EXPECT_THROW(ReadDoor(door), Error);
  bool found = false;
  for (const Finding& finding : ValidateDoor(door).findings) found |= finding.code == "MSH004";
  EXPECT_TRUE(found);
  fs::remove(door / mesh);
  EXPECT_THROW(ReadDoor(door), Error);
}

TEST_F(SharedDoors, NothingButThePoolIsReachedFromARecord) {
  Write(folder_, 1, Existing::kRefuse);
  const fs::path door = folder_ / "small_body__small_lever";
  const auto record = ReadJsonFile(door / "door.json");
  const auto expect_refused = [&](const nlohmann::ordered_json& json, const char* what) {
    WriteJsonFile(door / "door.json", json);
    try {
      ReadDoor(door);
      ADD_FAILURE() << what;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("door.json"), std::string::npos) << error.what();
    }
  };
  for (const char* pool : {"../../pool", "/tmp", "pool", "../pool/..", ""}) {
    auto json = record;
    json["mesh_pool"] = pool;
    expect_refused(json, pool);
  }
  for (const char* shape : {"../../etc/passwd", "../../../../../../../../x", ""}) {
    auto json = record;
    json["links"][1]["geometry"][0]["shape"] = shape;
    expect_refused(json, shape);
  }
  auto json = record;
  json.erase("mesh_pool");
  expect_refused(json, "shape without a pool");
  WriteJsonFile(door / "door.json", record);
  EXPECT_NO_THROW(ReadDoor(door));
  // a pool that is a link to elsewhere
  fs::rename(folder_ / "pool", folder_ / "elsewhere");
  fs::create_symlink(folder_ / "elsewhere", folder_ / "pool");
  EXPECT_THROW(ReadDoor(door), Error);
  fs::remove(folder_ / "pool");
  EXPECT_THROW(ReadDoor(door), Error);
}

TEST_F(SharedDoors, AMeshThatIsALinkIsRefused) {
  Write(folder_, 1, Existing::kRefuse);
  const fs::path door = folder_ / "small_body__small_lever";
  const fs::path mesh = door / ReadDoorFiles(door)[kLeafLink][0].mesh;
  fs::rename(mesh, folder_ / "secret.obj");
  fs::create_symlink(folder_ / "secret.obj", mesh);
  EXPECT_THROW(ReadDoor(door), Error);
}

TEST(MeshPool, NamesAreHashesOnly) {
  EXPECT_EQ(PooledMeshPath(std::string(64, 'a')), "../pool/" + std::string(20, 'a') + ".obj");
  for (const std::string& bad : {std::string(64, 'A'), std::string(63, 'a'), std::string("../x")})
    EXPECT_THROW(PooledMeshPath(bad), Error);
}

}  // namespace
}  // namespace doorforge
