// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/schemas/dataset.h"

#include "../physics/primitive_door.h"
#include "../program_answer.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

TEST(CollectDatasetExample, WritesADatasetAndSaysWhatIsWrongOtherwise) {
  const fs::path folder =
      fs::temp_directory_path() / ("doorforge_collect_example_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  const std::string command = DOORFORGE_BINARY_DIR "/bin/collect_dataset " +
                              (folder / "doors").string() + " " + (folder / "data").string() +
                              " 2>&1";
  const ProgramAnswer missing = AnswerOf(command);
  EXPECT_EQ(missing.code, 3);
  EXPECT_NE(missing.text.find("doors"), std::string::npos) << missing.text;

  DoorAsset door = MakePrimitiveDoor({});
  door.body.id = "leaf";
  door.handle.id = "lever";
  fs::create_directories(folder / "doors/one");
  WriteDoor(door, folder / "doors/one");
  const ProgramAnswer answer = AnswerOf(command);
  EXPECT_EQ(answer.code, 0) << answer.text;
  EXPECT_TRUE(answer.text.ends_with("data: no faults\n")) << answer.text;
  const DatasetReader reader(folder / "data", "open", "train");
  EXPECT_GE(reader.size(), 3U);
  EXPECT_EQ(reader.Arrays(0).cloud.size() % (3 * 1024), 0U);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace doorforge
