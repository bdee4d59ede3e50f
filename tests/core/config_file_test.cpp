// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_file.h"

#include <functional>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
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

std::string WhyYamlRefused(const std::string& yaml) {
  try {
    ParseYaml(yaml, "my.yaml");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    return error.what();
  }
  return {};
}

TEST(ConfigFile, ATextThatNamesItselfIsRefused) {
  EXPECT_NE(WhyYamlRefused("a: &a [*a]").find("my.yaml: line 1"), std::string::npos);
  EXPECT_NE(WhyYamlRefused("&a {b: *a}").find("levels"), std::string::npos);
}

TEST(ConfigFile, AShortTextThatMeansBillionsOfValuesIsRefused) {
  std::string yaml = "a0: &a0 [1,1,1,1,1,1,1,1,1]\n";
  for (int level = 1; level < 10; ++level) {
    const std::string name = "a" + std::to_string(level);
    const std::string below = "*a" + std::to_string(level - 1);
    yaml += name + ": &" + name + " [";
    for (int i = 0; i < 9; ++i) yaml += (i > 0 ? "," : "") + below;
    yaml += "]\n";
  }
  EXPECT_NE(WhyYamlRefused(yaml).find("100000 values"), std::string::npos);
}

TEST(ConfigFile, DeepTextIsRefusedAndNamesUsedAgainAreFine) {
  EXPECT_NE(WhyYamlRefused(std::string(100, '[') + std::string(100, ']')), "");
  EXPECT_NE(WhyYamlRefused(std::string(100000, '[')), "");
  EXPECT_NE(WhyYamlRefused("? [a, b]\n: 1"), "") << "a key that is no name";
  EXPECT_EQ(ParseYaml("{a: &x [1, 2], b: *x}", "t").dump(), R"({"a":[1,2],"b":[1,2]})");
}

TEST(ConfigFile, MessagesNameTheFileAndNoLibrary) {
  const auto folder = std::filesystem::path(testing::TempDir());
  const auto path = (folder / "bad_config.yaml").string();
  for (const char* text : {"widht: 1", "width: x", "width: [", "width: 99999999999"}) {
    CommitFile(path, text);
    try {
      LoadConfig<Camera>(path, {});
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with(path + ": ")) << what;
      EXPECT_EQ(what.find("yaml-cpp"), std::string::npos) << what;
    }
  }
  try {
    LoadConfig<Camera>("", {"width=x"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("--set: ")) << error.what();
  }
}

TEST(ConfigFile, WhatIsRefusedLaterStillNamesTheFile) {
  const auto use = [](const std::string& message) {
    return [message]() -> int { throw Error(ErrorCode::kInvalidConfig, message); };
  };
  const auto what = [](const std::string& path, const std::function<int()>& used) {
    try {
      NamingConfig(path, used);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(what("my.yaml", use("config.width: is 0")), "my.yaml: config.width: is 0");
  EXPECT_EQ(what("", use("config.width: is 0")), "--set: config.width: is 0");
  EXPECT_EQ(what("my.yaml", use("physics: bad")), "my.yaml: physics: bad");
  EXPECT_EQ(what("my.yaml", use("robots/arm.yaml: bad")), "robots/arm.yaml: bad");
  EXPECT_EQ(what("my.yaml", use("--doors: none")), "--doors: none");
  EXPECT_EQ(NamingConfig("my.yaml", [] { return 7; }), 7);
}

TEST(ConfigFile, ASettingBelowAValueIsRefusedByName) {
  try {
    ParseSettings({"scene=1", "scene.seed=2"});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--set scene.seed=2"), std::string::npos);
  }
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
