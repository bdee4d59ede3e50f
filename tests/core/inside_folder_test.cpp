// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/inside_folder.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class InsideFolder : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::path(testing::TempDir()) / ("doorforge_inside_folder_" + std::string(test->name()));
    fs::remove_all(root_);
    fs::create_directories(root_ / "object/meshes");
    std::ofstream(root_ / "object/meshes/leaf.obj") << "v 0 0 0";
    std::ofstream(root_ / "secret.obj") << "v 0 0 0";
  }
  void TearDown() override { fs::remove_all(root_); }

  // The code and the message of the error, or "none".
  std::string ErrorOf(const std::string& name, ErrorCode code) const {
    try {
      FileInside(root_ / "object", name, "the record");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    return "none";
  }

  fs::path root_;
};

TEST_F(InsideFolder, FindsTheFileThatTheRecordNames) {
  EXPECT_EQ(FileInside(root_ / "object", "meshes/leaf.obj", "the record"),
            root_ / "object" / "meshes/leaf.obj");
}

TEST_F(InsideFolder, RefusesNamesThatLeaveTheFolder) {
  fs::create_symlink(root_ / "secret.obj", root_ / "object/link.obj");
  fs::create_directory_symlink(root_, root_ / "object/up");
  for (const std::string& name :
       {std::string(), std::string("../secret.obj"), std::string("meshes/../../secret.obj"),
        (root_ / "secret.obj").string(), "file://" + (root_ / "secret.obj").string(),
        std::string("link.obj"), std::string("up/secret.obj")}) {
    const std::string message = ErrorOf(name, ErrorCode::kFormat);
    EXPECT_NE(message.find("the record: \"" + name + "\""), std::string::npos) << message;
    EXPECT_NE(message.find("allowed are files inside"), std::string::npos) << message;
  }
}

TEST_F(InsideFolder, SaysWhichFileIsMissingAndWhoNamesIt) {
  for (const std::string name : {"meshes/handle.obj", "meshes"}) {
    const std::string message = ErrorOf(name, ErrorCode::kMissing);
    EXPECT_NE(message.find(name + ": missing; the record names it"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace doorforge
