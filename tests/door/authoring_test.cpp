// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/authoring/export_batch.h"
#include "doorforge/authoring/part_batch.h"
#include "doorforge/catalogue/describe_catalogue.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/door_asset.h"

#include "scratch_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(DOORFORGE_SOURCE_DIR) / "data";

// Each test has a folder of its own, which is empty when it begins.
fs::path Scratch() {
  fs::path folder =
      ScratchFolder("authoring") / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  return folder;
}

// A flush door and two levers, of which the second is damaged.
fs::path PartsFolder(const fs::path& folder) {
  const std::vector<CatalogueEntry> catalogue = ListCatalogue(kData);
  std::vector<CatalogueEntry> entries;
  for (const char* id : {"interior_flush_01", "interior_lever_tube_01", "interior_lever_tube_02"})
    entries.push_back(FindCatalogueEntry(catalogue, id));
  for (const std::string& problem : BuildParts(entries, folder, Existing::kRefuse, 1))
    EXPECT_EQ(problem, "");
  CommitFile(folder / "interior_lever_tube_02" / "part.json", "{}", Existing::kReplace);
  return folder;
}

TEST(Authoring, APartThatIsThereAlreadyIsRefusedAndTheOthersAreBuilt) {
  const fs::path scratch = Scratch();
  const std::vector<CatalogueEntry> catalogue = ListCatalogue(kData);
  const std::vector<CatalogueEntry> one = {FindCatalogueEntry(catalogue, "safe_antique_01")};
  std::vector<CatalogueEntry> two = one;
  two.push_back(FindCatalogueEntry(catalogue, "interior_flush_01"));
  BuildParts(one, scratch, Existing::kRefuse, 1);
  const std::vector<std::string> problems = BuildParts(two, scratch, Existing::kRefuse, 2);
  EXPECT_NE(problems.at(0).find("already exists"), std::string::npos) << problems.at(0);
  EXPECT_EQ(problems.at(1), "");
  EXPECT_EQ(ReadPart(scratch / "interior_flush_01").role, PartRole::kBody);
}

TEST(Authoring, ADamagedPartIsToldAndTheOtherDoorsAreComposed) {
  const fs::path scratch = Scratch();
  std::vector<std::string> notes;
  ComposeRun run{.out = scratch / "doors", .parts = PartsFolder(scratch / "parts")};
  run.pairs = PairChoice::kAll;
  run.note = [&](const std::string& line) { notes.push_back(line); };
  const ComposedDoors composed = ComposeManyDoors(run, {});
  EXPECT_EQ(composed.damaged_parts, 1U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("interior_lever_tube_02: left out: "), std::string::npos) << notes[0];
  ASSERT_EQ(composed.doors.size(), 1U);
  EXPECT_EQ(composed.doors[0].id, "interior_flush_01__interior_lever_tube_01");
  EXPECT_EQ(composed.doors[0].problem, "");
  EXPECT_EQ(ReadDoor(run.out / composed.doors[0].id).id, composed.doors[0].id);
}

TEST(Authoring, PartsOfOtherCategoriesAreNeitherPreparedNorToldOf) {
  const fs::path scratch = Scratch();
  const std::vector<CatalogueEntry> catalogue = ListCatalogue(kData);
  std::vector<CatalogueEntry> entries;
  for (const char* id : {"interior_flush_01", "interior_lever_tube_01", "safe_antique_01"})
    entries.push_back(FindCatalogueEntry(catalogue, id));
  BuildParts(entries, scratch / "parts", Existing::kRefuse, 1);
  std::vector<std::string> notes;
  ComposeRun run{.out = scratch / "doors", .parts = scratch / "parts"};
  run.pairs = PairChoice::kAll;
  run.category = "interior";
  run.note = [&](const std::string& line) { notes.push_back(line); };
  ComposeRequest request;
  request.door.opening = Opening::kPush;  // which no safe is
  EXPECT_EQ(ComposeManyDoors(run, request).doors.size(), 1U);
  EXPECT_TRUE(notes.empty()) << notes[0];
  run.category = "safe";
  run.out = scratch / "safes";
  EXPECT_THROW(ComposeManyDoors(run, request), Error);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("safe_antique_01: left out: "), std::string::npos) << notes[0];
}

TEST(Authoring, OneDoorTakesItsPartsByFolder) {
  const fs::path scratch = Scratch();
  const fs::path parts = PartsFolder(scratch / "parts");
  const ComposeRun run{.out = scratch / "door"};
  const ComposeRequest request{.body = (parts / "interior_flush_01").string(),
                               .handle = (parts / "interior_lever_tube_01").string()};
  EXPECT_FALSE(MeansManyDoors(run, request));
  const ComposedDoors composed = ComposeOneDoor(run, request);
  EXPECT_FALSE(composed.imported);
  EXPECT_EQ(ReadDoor(run.out).id, composed.doors.at(0).id);
}

TEST(Authoring, AGlobMeansManyDoorsAndOneThatFitsNothingIsMissing) {
  const fs::path scratch = Scratch();
  const ComposeRun run{.out = scratch / "doors", .parts = PartsFolder(scratch / "parts")};
  const ComposeRequest request{.body = "safe_*", .handle = "interior_lever_tube_01"};
  EXPECT_TRUE(MeansManyDoors(run, request));
  try {
    ComposeManyDoors(run, request);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMissing);
    EXPECT_NE(std::string(error.what()).find("safe_*"), std::string::npos) << error.what();
  }
}

TEST(Authoring, AFolderWithoutADoorIsToldAndTheOtherDoorsAreExported) {
  const fs::path scratch = Scratch();
  const fs::path parts = PartsFolder(scratch / "parts");
  const fs::path door = scratch / "door";
  ComposeOneDoor({.out = door}, {.body = (parts / "interior_flush_01").string(),
                                 .handle = (parts / "interior_lever_tube_01").string()});
  const std::vector<fs::path> folders = {parts, door};
  const std::vector<ExportedDoor> exported =
      ExportDoors(folders, {.out = scratch / "out", .formats = {"mjcf"}});
  EXPECT_NE(exported.at(0).problem, "");
  EXPECT_EQ(exported.at(1).problem, "");
  EXPECT_TRUE(fs::is_directory(scratch / "out" / exported.at(1).id));
}

TEST(Authoring, ASelectionIsOfOneCategoryAndAnUnknownOneIsRefused) {
  for (const CatalogueEntry& entry : SelectParts(kData, {.category = "safe"}))
    EXPECT_EQ(entry.category, Category::kSafe);
  EXPECT_THROW(SelectParts(kData, {.category = "gate"}), Error);
}

TEST(Authoring, WhatCameOfManyDoorsIsSaidInALine) {
  const std::vector<ComposedDoor> doors = {{"a", "", true}, {"b", "", false}, {"c", "bad", false}};
  EXPECT_EQ(ComposedText(doors, "out"),
            "2 doors composed in out, 1 of them there already, 1 not\n");
  EXPECT_EQ(ComposedText(std::span(doors).subspan(1, 1), "out"), "1 door composed in out\n");
  EXPECT_EQ(ProblemsOf(doors), std::vector<std::string>{"c: bad"});
  const std::vector<ExportedDoor> exported = {{"x/a", "a", ""}, {"x/b", "", "worse"}};
  EXPECT_EQ(ProblemsOf(exported), std::vector<std::string>{"x/b: worse"});
}

TEST(Authoring, TheRecordOfABatchSaysOfEachPartWhetherItWasBuilt) {
  const std::vector<CatalogueEntry> parts = SelectParts(kData, {.category = "safe"});
  const std::vector<std::string> problems = {"", "no room"};
  const auto json = BuiltToJson(std::span(parts).first(2), problems);
  EXPECT_EQ(json.at("schema"), "doorforge.catalog_build");
  EXPECT_EQ(json.at("parts").at(0).at("built"), true);
  EXPECT_EQ(json.at("parts").at(1).at("built"), false);
  EXPECT_EQ(json.at("parts").at(1).at("message"), "no room");
  EXPECT_EQ(json.at("parts").at(1).at("id"), parts[1].id);
}

}  // namespace
}  // namespace doorforge
