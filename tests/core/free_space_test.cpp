// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/free_space.h"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

TEST(FreeSpace, RefusesMoreThanThereIsAndSaysTheWayOut) {
  const fs::path folder = fs::temp_directory_path() / "not there" / "nor this";
  EXPECT_EQ(LackOfSpace(folder, 1), "");
  EXPECT_NO_THROW(RequireSpace(folder, 1, ""));
  EXPECT_NO_THROW(RequireSpace("", -5, "")) << "the working folder";
  EXPECT_NE(LackOfSpace(folder, 1e18).find("nor this: about 953674316406 MiB are needed, "),
            std::string::npos);
  try {
    RequireSpace(folder, 1e18, "make room");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kIo);
    EXPECT_TRUE(std::string(error.what()).ends_with(" MiB are free; make room"));
  }
}

TEST(FreeSpace, CountsTheBytesOfAllFilesBelow) {
  const fs::path folder =
      fs::temp_directory_path() / ("doorforge_space_" + std::to_string(::getpid()));
  EXPECT_EQ(BytesBelow(folder), 0);
  fs::create_directories(folder / "inner");
  std::ofstream(folder / "a") << "12345";
  std::ofstream(folder / "inner" / "b") << "678";
  EXPECT_EQ(BytesBelow(folder), 8);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace doorforge
