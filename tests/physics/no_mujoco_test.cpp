// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// What a build without MuJoCo says. The source that stands in then is compiled here, since the room
// of a machine that runs the tests has the other.

#include "mujoco/no_mujoco.cpp"  // NOLINT(bugprone-suspicious-include)

#include <string>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

TEST(NoMujoco, TheSimulatorIsRefusedWithWhatToInstall) {
  EXPECT_FALSE(internal::BuiltWithMujoco());
  try {
    internal::RequireMujoco();
    FAIL() << "it is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    EXPECT_NE(std::string(error.what()).find("install libmujoco-dev and configure again"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace doorforge
