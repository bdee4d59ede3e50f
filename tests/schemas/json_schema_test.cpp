// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/json_schema.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

const std::filesystem::path kFolder = DOORFORGE_SOURCE_DIR "/schemas/json";

// The published schemas of data sets follow the records; programs/published_schemas_test holds all
// that are published to what the programs write. After a record was changed on purpose:
//   DOORFORGE_WRITE_SCHEMAS=1 build/dev/bin/schemas_test --gtest_filter=JsonSchemaTest.*
TEST(JsonSchemaTest, PublishedSchemasAreThoseOfTheRecords) {
  for (const RecordSchema& record : RecordSchemas()) {
    const std::filesystem::path path = kFolder / (record.name + ".schema.json");
    if (std::getenv("DOORFORGE_WRITE_SCHEMAS") != nullptr) WriteJsonFile(path, record.schema);
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    EXPECT_EQ(ReadFile(path), record.schema.dump(2) + "\n")
        << path << " is not what the record says; this file says how to write it anew";
  }
}

TEST(JsonSchemaTest, KeysTypesSignsAndNamesComeFromTheRecords) {
  for (const RecordSchema& record : RecordSchemas()) {
    const auto& properties = record.schema.at("properties");
    if (record.name == "dataset") {
      const auto& part = properties.at("parts").at("items").at("properties");
      EXPECT_EQ(part.at("episodes").at("type"), "integer");
      EXPECT_EQ(part.at("episodes").at("minimum"), 0);
      EXPECT_EQ(part.at("stage").at("enum").size(), 3U);
      EXPECT_EQ(properties.at("schema").at("const"), "doorforge.dataset");
      EXPECT_EQ(properties.at("train_cloud_radius_m").at("type"), "number");
      EXPECT_TRUE(properties.at("train_statistics").contains("additionalProperties"));
    }
    if (record.name == "shard_index") {
      const auto& required = record.schema.at("required");
      EXPECT_EQ(std::count(required.begin(), required.end(), "index_crc32c"), 0);
      EXPECT_EQ(std::count(required.begin(), required.end(), "tar_sha256"), 1);
      EXPECT_EQ(properties.at("tar_sha256").at("pattern"), "^[0-9a-f]{64}$");
    }
    if (record.name == "episode") {
      EXPECT_EQ(properties.at("outcome").at("enum").at(0), "opened");
      EXPECT_EQ(properties.at("peak_hinge_rad").at("description"), "unit: rad");
    }
  }
}

}  // namespace
}  // namespace doorforge
