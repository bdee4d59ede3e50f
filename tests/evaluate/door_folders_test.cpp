// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/door_folders.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class DoorFoldersTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("door_folders_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "empty");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& id, const std::string& place, double width_m = 0.8) const {
    PrimitiveDoor shape;
    shape.width_m = width_m;
    DoorAsset door = MakePrimitiveDoor(shape);
    door.id = id;
    door.body.id = id + "_body";
    door.handle.id = id + "_handle";
    fs::create_directories(folder_ / place);
    WriteDoor(door, folder_ / place);
  }

  ErrorCode CodeOf(const std::vector<std::string>& folders) const {
    try {
      ReadDoors(folders);
    } catch (const Error& error) {
      return error.code();
    }
    ADD_FAILURE() << "nothing was refused";
    return ErrorCode::kIo;
  }

  fs::path folder_;
};

TEST_F(DoorFoldersTest, FindsDoorsAtAnyDepthAndSortsThemById) {
  Write("b", "x/deep/first");
  Write("a", "y");
  const auto doors = ReadDoors({(folder_ / "x").string(), (folder_ / "y").string()});
  ASSERT_EQ(doors.size(), 2U);
  EXPECT_EQ(doors[0].id, "a");
  EXPECT_EQ(doors[1].id, "b");
  EXPECT_EQ(ReportDoorOf(doors[1]).sha256, ContentHash(doors[1]));
}

TEST_F(DoorFoldersTest, ASelectionTakesDoorsEvenlyFromEachCategory) {
  for (const char* id : {"a", "b", "c", "d", "e", "f"}) Write(id, id);
  const auto doors = ReadDoors({folder_.string()}, {.split = "", .per_category = 3});
  ASSERT_EQ(doors.size(), 3U);
  EXPECT_EQ(doors[0].id, "a");
  EXPECT_EQ(doors[1].id, "c");
  EXPECT_EQ(doors[2].id, "e");
}

TEST_F(DoorFoldersTest, ASplitTakesDoorsOfWhichBothPartsAreOnItsSide) {
  Write("a", "a");
  const DoorAsset door = ReadDoors({folder_.string()}).at(0);
  const fs::path split = folder_ / "own.yaml";
  const auto write = [&](const std::string& handle) {
    std::ofstream(split) << "schema: doorforge.split\nschema_version: 1\ntrain: []\ntest: [\""
                         << door.body.id << "\", \"" << handle << "\"]\nunseen_categories: []\n";
  };
  write("another");
  const auto read = [&](const std::string& side) {
    return ReadDoors({folder_.string()}, {.split = split.string() + side, .per_category = 0});
  };
  EXPECT_THROW(read(""), Error);
  write(door.handle.id);
  EXPECT_EQ(read("").size(), 1U);
  EXPECT_EQ(read(":test").size(), 1U);
  EXPECT_THROW(read(":train"), Error);
  EXPECT_THROW(read(":tset"), Error);
}

TEST_F(DoorFoldersTest, TheSameDoorTwiceCountsOnceButAnIdMustNotMeanTwoDoors) {
  Write("a", "first");
  Write("a", "copy");
  EXPECT_EQ(ReadDoors({folder_.string()}).size(), 1U);
  Write("a", "other", 0.7);
  EXPECT_EQ(CodeOf({folder_.string()}), ErrorCode::kInvalidArgument);
}

TEST_F(DoorFoldersTest, AFolderWithoutDoorsIsMissingInput) {
  EXPECT_EQ(CodeOf({(folder_ / "empty").string()}), ErrorCode::kMissing);
  EXPECT_EQ(CodeOf({(folder_ / "nowhere").string()}), ErrorCode::kMissing);
}

}  // namespace
}  // namespace doorforge
