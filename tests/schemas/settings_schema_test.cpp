// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/settings_schema.h"

#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/benchmark/benchmark_table.h"
#include "doorforge/collect/reobserve.h"
#include "doorforge/collect/stage_config.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/deploy/online_controller.h"
#include "doorforge/evaluate/evaluation_config.h"
#include "doorforge/importers/import_objects.h"
#include "doorforge/mesh/repair_mesh.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/policy/train_config.h"
#include "doorforge/registry/policy_episodes.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

Json TrainSchema(const std::string& verb, std::string_view stage) {
  return SettingsSchema("Settings of `doorforge train " + verb + "`", TrainDefaultsOf(stage));
}

std::vector<std::pair<std::string, Json>> Settings() {
  std::vector<std::pair<std::string, Json>> all = {
      {"act", SettingsSchema<OnlineControllerConfig>("Settings of `doorforge act`")},
      {"benchmark", SettingsSchema<BenchmarkSize>("A size of `doorforge benchmark`")},
      {"compose", SettingsSchema<ComposeRequest>("Settings of `doorforge compose`")},
      {"eval", SettingsSchema<EvaluationConfig>("Settings of `doorforge eval`")},
      {"import", SettingsSchema<ImportConfig>("Settings of `doorforge import`")},
      {"reobserve", SettingsSchema<ReobserveConfig>("Settings of `doorforge dataset re-observe`")},
      {"repair", SettingsSchema<RepairConfig>("Settings of `doorforge repair`")},
      {"robot", SettingsSchema<RobotOptions>("NAME.robot.yaml beside a robot's NAME.urdf")},
      {"sight", SettingsSchema<SceneConfig>("Settings of `doorforge sight`")},
      {"simulate", SettingsSchema<PolicySimulateConfig>("Settings of `doorforge simulate`")},
      {"train_find", TrainSchema("find", "find")},
      {"train_grasp", TrainSchema("grasp", "grasp")},
      {"train_motion", TrainSchema("open` and `doorforge train handle", "open")}};
  for (const auto& [name, stage] :
       {std::pair{"open", Stage::kOpen}, {"handle", Stage::kHandle}, {"grasp", Stage::kGrasp}})
    all.emplace_back(std::string("datagen_") + name,
                     SettingsSchema(std::string("Settings of `doorforge datagen ") + name + "`",
                                    DefaultsOf(stage)));
  return all;
}

// After settings were changed on purpose:
//   DOORFORGE_WRITE_SCHEMAS=1 build/dev/bin/settings_schema_test
TEST(SettingsSchema, PublishedOnesAreThoseOfThePrograms) {
  for (const auto& [name, schema] : Settings()) {
    const std::filesystem::path path =
        DOORFORGE_SOURCE_DIR "/schemas/json/settings_" + name + ".schema.json";
    if (std::getenv("DOORFORGE_WRITE_SCHEMAS") != nullptr) WriteJsonFile(path, schema);
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    EXPECT_EQ(ReadFile(path), schema.dump(2) + "\n")
        << path << " is not what the program reads; this file says how to write it anew";
  }
}

}  // namespace
}  // namespace doorforge
