// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/door_folders.h"

#include <filesystem>

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
