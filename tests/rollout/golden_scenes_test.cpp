// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Eight scenes end in states that are known bit by bit, on any number of threads. A change of these
// hashes is a change of every data set: it belongs into the change log. To renew them on purpose:
//
//   DOORFORGE_RENEW_GOLDEN=1 build/.../bin/rollout_test --gtest_filter='GoldenScenes.*'
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gnu/libc-version.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

const std::filesystem::path kFile =
    std::filesystem::path(DOORFORGE_SOURCE_DIR) / "tests/golden/scene_states.json";

// Compiler and mathematics library, which has sines of its own for processors with fused
// multiplication; others may round otherwise.
std::string Toolchain() {
  const char* fused = __builtin_cpu_supports("fma") ? ", FMA" : "";
  return std::string("GCC ") + __VERSION__ + ", glibc " + gnu_get_libc_version() + fused;
}

struct GoldenScene {
  std::string name;
  Mechanism mechanism;
  std::uint64_t index;
  Randomisation randomisation;
};

std::vector<GoldenScene> Scenes() {
  return {{"lever", Mechanism::kLever, 0, Randomisation::kPaper},
          {"lever, still", Mechanism::kLever, 1, Randomisation::kOff},
          {"lever, strong", Mechanism::kLever, 2, Randomisation::kStrong},
          {"round", Mechanism::kRound, 3, Randomisation::kPaper},
          {"round, still", Mechanism::kRound, 4, Randomisation::kOff},
          {"round, strong", Mechanism::kRound, 5, Randomisation::kStrong},
          {"no latch", Mechanism::kNone, 6, Randomisation::kPaper},
          {"no latch, strong", Mechanism::kNone, 7, Randomisation::kStrong}};
}

Json RunAll(int threads) {
  const RobotModel robot = LoadMobileFranka();
  const std::vector<GoldenScene> scenes = Scenes();
  std::vector<Episode> episodes(scenes.size());
  ParallelFor(scenes.size(), threads, [&](std::size_t i) {
    const DoorAsset door =
        MakePrimitiveDoor(RandomPrimitive(scenes[i].mechanism, 1, scenes[i].index));
    SceneConfig config;
    config.randomisation = scenes[i].randomisation;
    OpeningExpert expert;
    episodes[i] =
        RunEpisode(SampleScene(door, 1, scenes[i].index, config), door, robot, expert, nullptr);
  });
  Json found = Json::object();
  for (std::size_t i = 0; i < scenes.size(); ++i)
    found[scenes[i].name] = {{"outcome", NameOf(episodes[i].outcome)},
                             {"state_sha256", episodes[i].state_sha256}};
  return found;
}

TEST(GoldenScenes, EndInTheSameStatesOnOneThreadAndOnTwo) { EXPECT_EQ(RunAll(1), RunAll(2)); }

TEST(GoldenScenes, EndInTheStatesThatAreKnown) {
  const Json found = RunAll(2);
  const char* renew = std::getenv("DOORFORGE_RENEW_GOLDEN");
  if (renew != nullptr && std::string(renew) == "1") {
    std::filesystem::remove(kFile);
    WriteJsonFile(kFile, {{"schema", "doorforge.golden_scenes"},
                          {"schema_version", 1},
                          {"made_with", Toolchain()},
                          {"scenes", found}});
    GTEST_SKIP() << "written: " << kFile;
  }
  const Json golden = ReadJsonFile(kFile);
  if (golden.at("made_with") != Toolchain())
    GTEST_SKIP() << "the hashes are of " << golden.at("made_with") << ", this is " << Toolchain();
  for (const auto& [name, state] : golden.at("scenes").items())
    EXPECT_EQ(found.at(name), state) << name;
}

}  // namespace
}  // namespace doorforge
