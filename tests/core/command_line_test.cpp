// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "doorforge/core/environment_preset.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// A verb as the programs make them: two files, an option that must be there, and settings.
struct TriedVerb {
  CLI::App app{"", "doorforge try"};
  std::vector<std::string> files;
  std::string body;
  std::vector<std::string> settings;

  TriedVerb() {
    app.add_option("files", files)->required();
    app.add_option("-b,--body", body)->required();
    AddSettings(app, settings, "overrides one setting");
  }
};

void Parse(CLI::App& app, std::vector<std::string> words) {
  words.insert(words.begin(), "try");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  ParseVerb(app, static_cast<int>(pointers.size()), pointers.data());
}

std::string RefusalOf(CLI::App& app, const std::vector<std::string>& words) {
  try {
    Parse(app, words);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    return error.what();
  }
  return "";
}

TEST(CommandLine, ASettingLeavesWhatFollowsItToTheOthers) {
  TriedVerb verb;
  Parse(verb.app, {"--set", "a=1", "x.stl", "--set=b=2", "y.stl", "--body", "c"});
  EXPECT_EQ(verb.settings, (std::vector<std::string>{"a=1", "b=2"}));
  EXPECT_EQ(verb.files, (std::vector<std::string>{"x.stl", "y.stl"}));
}

TEST(CommandLine, ASecondSettingWithoutItsSetIsToldHowToBeGiven) {
  CLI::App app{"", "doorforge try"};
  std::vector<std::string> settings;
  AddSettings(app, settings, "overrides one setting");
  EXPECT_EQ(RefusalOf(app, {"--set", "a=1", "b=2"}),
            "\"b=2\" was not expected; each --set takes one setting: --set b=2; see `doorforge try "
            "--help`");
}

TEST(CommandLine, AnUnknownOptionIsToldTheNearestOneThoughARequiredOneIsMissing) {
  TriedVerb verb;
  EXPECT_EQ(RefusalOf(verb.app, {"x.stl", "--bodi", "c"}),
            "unknown option \"--bodi\"; did you mean \"--body\"? see `doorforge try --help`");
  TriedVerb other;
  EXPECT_EQ(RefusalOf(other.app, {"x.stl", "--hlep=3", "--body", "c"}),
            "unknown option \"--hlep\"; did you mean \"--help\"? see `doorforge try --help`");
}

TEST(CommandLine, SubcommandsAreSuggestedAndTheirOptionsToo) {
  const auto refusal = [](const std::vector<std::string>& words) {
    CLI::App app{"", "doorforge try"};
    app.require_subcommand(1);
    std::string size;
    app.add_subcommand("list")->add_option("--size", size);
    app.add_subcommand("show");
    return RefusalOf(app, words);
  };
  EXPECT_EQ(refusal({"lst"}),
            "unknown subcommand \"lst\"; did you mean \"list\"? see `doorforge try --help`");
  EXPECT_EQ(refusal({"list", "--sise", "3"}),
            "unknown option \"--sise\"; did you mean \"--size\"? see `doorforge try list --help`");
  EXPECT_EQ(refusal({}), "a subcommand is required: list, show; see `doorforge try --help`");
  EXPECT_EQ(refusal({"list", "--size", "3"}), "");
}

TEST(CommandLine, AnEmptyValueIsRefusedWhereItMustNotPassForNone) {
  const auto refusal = [](EmptyValues empty) -> std::string {
    CLI::App app{"", "doorforge try"};
    std::string size;
    app.add_subcommand("list")->add_option("--size", size);
    std::vector<std::string> words = {"try", "list", "--size", ""};
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    try {
      ParseVerb(app, 4, pointers.data(), empty);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(EmptyValues::kAccept), "");
  EXPECT_EQ(refusal(EmptyValues::kRefuse),
            "--size: its value is empty; is a variable unset? Leave the option out to do without "
            "it");
}

enum class KnobShape { kRound, kFlat };
constexpr NamedValue<KnobShape> kKnobShapes[] = {{KnobShape::kRound, "round"},
                                                 {KnobShape::kFlat, "flat"}};
constexpr std::span<const NamedValue<KnobShape>> ValuesOf(KnobShape) { return kKnobShapes; }

TEST(CommandLine, AChoiceIsOneOfItsEnumsWordsAndTheHelpShowsTheDefault) {
  const auto with = [](const std::vector<std::string>& words, KnobShape& shape) {
    CLI::App app{"", "doorforge try"};
    AddChoice(app, "--shape", shape, "of the knob");
    const std::string refusal = RefusalOf(app, words);
    return refusal.empty() ? app.help() : refusal;
  };
  KnobShape shape = KnobShape::kFlat;
  EXPECT_NE(with({}, shape).find("=flat"), std::string::npos);
  EXPECT_EQ(shape, KnobShape::kFlat);
  with({"--shape", "round"}, shape);
  EXPECT_EQ(shape, KnobShape::kRound);
  EXPECT_NE(with({"--shape", "rund"}, shape).find("rund not in {round,flat}"), std::string::npos);
}

TEST(CommandLine, AChoiceThatIsNotGivenIsLeftToOthers) {
  std::optional<KnobShape> shape;
  CLI::App app{"", "doorforge try"};
  AddChoice(app, "--shape", shape, "of the knob");
  Parse(app, {});
  EXPECT_FALSE(shape.has_value());
  Parse(app, {"--shape", "flat"});
  EXPECT_EQ(shape, KnobShape::kFlat);
}

TEST(CommandLine, TheSimulatorIsOneOfTwoWordsAndASettingUnderThoseGiven) {
  CLI::App app{"", "doorforge try"};
  ConfigSources sources;
  AddEnvironment(app, sources);
  AddSettings(app, sources.settings, "overrides one setting");
  Parse(app, {"--set", "scene.latch=none", "--simulator", "mujoco"});
  EXPECT_EQ(sources.simulator, "mujoco");
  EXPECT_EQ(sources.settings, std::vector<std::string>{"scene.latch=none"});
  CLI::App other{"", "doorforge try"};
  AddEnvironment(other, sources);
  EXPECT_NE(RefusalOf(other, {"--simulator", "mojoco"}).find("mujoco"), std::string::npos);
}

TEST(CommandLine, OverwriteMeansThatWhatIsThereIsReplaced) {
  Existing existing = Existing::kRefuse;
  CLI::App app{"", "doorforge try"};
  AddOverwrite(app, existing, "replace it");
  Parse(app, {});
  EXPECT_EQ(existing, Existing::kRefuse);
  Parse(app, {"--overwrite"});
  EXPECT_EQ(existing, Existing::kReplace);
}

TEST(CommandLine, WhatIsMissingIsStillTold) {
  TriedVerb verb;
  const std::string refusal = RefusalOf(verb.app, {"x.stl"});
  EXPECT_NE(refusal.find("--body"), std::string::npos) << refusal;
}

TEST(CommandLine, AnOptionsEarlierNameIsUnderstoodToldAndNotGivenBesideTheNewOne) {
  const auto parsed = [](const std::vector<std::string>& words) {
    CLI::App app("", "doorforge try");
    std::string value = "default";
    AddWord(app, "--opener", value, "who opens");
    AddEarlierName(app, "--policy", "--opener", value);
    EXPECT_EQ(app.help().find("--policy"), std::string::npos);
    EXPECT_NE(app.help().find("default"), std::string::npos);
    Parse(app, words);
    return value;
  };
  EXPECT_EQ(parsed({}), "default");
  EXPECT_EQ(parsed({"--opener", "a"}), "a");
  testing::internal::CaptureStderr();
  EXPECT_EQ(parsed({"--policy", "b"}), "b");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "note: --policy is called --opener now\n");
  EXPECT_THROW(parsed({"--policy", "b", "--opener", "a"}), Error);
}

TEST(CommandLine, ARecordHasTheCommandAsAShellTakesIt) {
  std::vector<std::string> words = {"eval", "--doors", "held out", "-n", "3", "", "a$b"};
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  EXPECT_EQ(CommandLineText("doorforge eval", static_cast<int>(pointers.size()), pointers.data()),
            "doorforge eval --doors 'held out' -n 3 '' 'a$b'");
}

}  // namespace
}  // namespace doorforge
