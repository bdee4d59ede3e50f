// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Ran {
  int code = -1;
  std::string output;
};

Ran RunExample(const std::string& program, const fs::path& door) {
  const std::string command =
      DOORFORGE_BINARY_DIR "/bin/" + program + " " + door.string() + " 2>&1";
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 256> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) ran.output += line.data();
  ran.code = WEXITSTATUS(pclose(pipe));
  return ran;
}

fs::path WrittenDoor(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  DoorAsset door = MakePrimitiveDoor({});
  door.body.id = "leaf";
  door.handle.id = "lever";
  WriteDoor(door, folder);
  return folder;
}

TEST(OwnPolicyExample, OpensMostDoorsAndSaysWhatIsWrongOtherwise) {
  const fs::path folder = WrittenDoor("own_policy_example");
  const Ran ran = RunExample("own_policy", folder);
  EXPECT_EQ(ran.code, 0) << ran.output;
  EXPECT_TRUE(ran.output.ends_with("opened 5 of 5\n") || ran.output.ends_with("opened 4 of 5\n"))
      << ran.output;
  fs::remove_all(folder);
  const Ran missing = RunExample("own_policy", folder);
  EXPECT_EQ(missing.code, 3);
  EXPECT_NE(missing.output.find("own_policy_example"), std::string::npos) << missing.output;
}

TEST(StepDoorExample, TriesThreeWaysOnFromOneGrasp) {
  const fs::path folder = WrittenDoor("step_door_example");
  const Ran ran = RunExample("step_door", folder);
  EXPECT_EQ(ran.code, 0) << ran.output;
  EXPECT_NE(ran.output.find("0.00 rad ahead: door_stuck when the actions were used up"),
            std::string::npos)
      << ran.output;
  EXPECT_NE(ran.output.find("0.08 rad ahead: opened, hinge gained 4"), std::string::npos)
      << ran.output;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace doorforge
