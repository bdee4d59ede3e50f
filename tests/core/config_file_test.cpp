// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_file.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

struct Camera {
  int width = 256;
  std::string name = "paper";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("width", self.width);
    visit("name", self.name);
  }
};

TEST(ConfigFile, YamlScalarsGetTheirTypes) {
  const auto json = ParseYaml("{a: 1, b: 1.5, c: true, d: text, e: '1', f: [1e-3, -2]}", "test");
  EXPECT_EQ(json.dump(), R"({"a":1,"b":1.5,"c":true,"d":"text","e":"1","f":[0.001,-2]})");
}

TEST(ConfigFile, JsonIsReadAsYaml) {
  EXPECT_EQ(ParseYaml(R"({"a": {"b": [1, 2]}})", "test").dump(), R"({"a":{"b":[1,2]}})");
}

TEST(ConfigFile, ASyntaxErrorNamesTheLine) {
  try {
    ParseYaml("a: 1\nb: [", "my.yaml");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    EXPECT_NE(std::string(error.what()).find("my.yaml"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("line"), std::string::npos);
  }
}

TEST(ConfigFile, RefusesWhatIsNoFiniteNumberAndSaysWhere) {
  for (const std::string text : {".nan", ".NaN", "nan", ".inf", "-.inf", "Infinity"}) {
    try {
      ParseYaml("name: x\nwidth: " + text + "\n", "my.yaml");
      ADD_FAILURE() << text << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      const std::string what = error.what();
      EXPECT_NE(what.find("my.yaml: line 2: found " + text), std::string::npos) << what;
    }
    EXPECT_THROW(ParseSettings({"width=" + text}), Error);
  }
  EXPECT_EQ(ParseYaml("name: \"nan\"", "my.yaml").at("name"), "nan");
}

TEST(ConfigFile, SettingsNestAndTheLastOneWins) {
  EXPECT_EQ(ParseSettings({"a.b=1", "a.c=x=y", "a.b=2"}).dump(), R"({"a":{"b":2,"c":"x=y"}})");
  EXPECT_THROW(ParseSettings({"novalue"}), Error);
}

TEST(ConfigFile, SettingsOverrideDefaults) {
  const auto camera = LoadConfig<Camera>("", {"width=64"});
  EXPECT_EQ(camera.width, 64);
  EXPECT_EQ(camera.name, "paper");
  EXPECT_THROW(LoadConfig<Camera>("", {"widht=64"}), Error);
}

}  // namespace
}  // namespace doorforge
