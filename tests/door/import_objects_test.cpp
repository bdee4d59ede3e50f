// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/door/import_objects.h"

#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"

#include "small_object.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// relative path -> hash, of everything below
std::map<std::string, std::string> FilesIn(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = Sha256OfFile(entry.path());
  }
  return files;
}

ImportReport ImportAll(const fs::path& source, const fs::path& out, const ImportConfig& config = {},
                       Existing existing = Existing::kRefuse) {
  return ImportObjects(FindObjects(source), out, config, existing);
}

TEST(ImportObjects, WritesBothPartsOfAnObject) {
  const fs::path root = TestFolder("batch_one");
  WriteSmallObject(root / "LeverDoor/99650069960003");
  const ImportReport report = ImportAll(root / "LeverDoor/99650069960003", root / "out");
  ASSERT_EQ(report.objects.size(), 1U);
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported) << report.objects[0].message;
  EXPECT_TRUE(report.objects[0].grasp_holds);
  EXPECT_LT(report.objects[0].body_box_deviation_m, 1e-6);
  const Part body = ReadPart(root / "out/udm-9965006");
  const Part handle = ReadPart(root / "out/udm-9960003");
  EXPECT_EQ(body.id, "udm-9965006");
  EXPECT_EQ(body.license, "NOASSERTION");
  EXPECT_EQ(handle.mechanism, Mechanism::kLever);
  EXPECT_GT(handle.grasp_half_extent_m.minCoeff(), 0);
  EXPECT_TRUE(fs::exists(root / "out/udm-9960003/repair.json"));
  EXPECT_EQ(ReadJsonFile(root / "out/import.json")["objects"].size(), 1U);
}

TEST(ImportObjects, GoesOnAfterAFaultAndLeavesNothingOfIt) {
  const fs::path root = TestFolder("batch_faults");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650079960004");
  fs::remove(root / "in/LeverDoor/99650079960004/texture_dae/frame.obj");
  WriteSmallObject(root / "in/LeverDoor/99650089960005");
  WriteText(root / "in/LeverDoor/99650089960005/texture_dae/9960003.obj", "not a mesh");
  const ImportReport report = ImportAll(root / "in", root / "out");
  ASSERT_EQ(report.objects.size(), 3U);
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported) << report.objects[0].message;
  EXPECT_EQ(report.objects[1].outcome, ImportOutcome::kIncomplete);
  EXPECT_NE(report.objects[1].message.find("frame.obj"), std::string::npos);
  EXPECT_EQ(report.objects[2].outcome, ImportOutcome::kInvalid);
  // the good half of the third object is not written either
  std::vector<std::string> written;
  for (const auto& entry : fs::directory_iterator(root / "out"))
    written.push_back(entry.path().filename());
  std::sort(written.begin(), written.end());
  EXPECT_EQ(written, (std::vector<std::string>{"import.json", "udm-9960003", "udm-9965006"}));
}

TEST(ImportObjects, LeavesOutObjectsOfOtherCategories) {
  const fs::path root = TestFolder("batch_only");
  WriteSmallObject(root / "in/Fridge/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650079960004");
  ImportConfig config;
  config.only = {"interior"};
  const ImportReport report = ImportAll(root / "in", root / "out", config);
  ASSERT_EQ(report.objects.size(), 1U);
  EXPECT_EQ(report.left_out, 1);
  EXPECT_EQ(report.objects[0].name, "LeverDoor/99650079960004");
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported) << report.objects[0].message;
  EXPECT_FALSE(report.objects[0].body_id.empty());
}

TEST(ImportObjects, NothingIsWrittenWhenNothingImports) {
  const fs::path root = TestFolder("batch_nothing");
  WriteSmallObject(root / "LeverDoor/99650069960003");
  WriteText(root / "LeverDoor/99650069960003/mobility.urdf", "");
  ImportAll(root / "LeverDoor", root / "out");
  EXPECT_FALSE(fs::exists(root / "out"));
  EXPECT_THROW(FindObjects(root / "out"), Error);
  EXPECT_THROW(FindObjects(root / "LeverDoor/99650069960003/bounding_box.json"), Error);
}

TEST(ImportObjects, SharedPartsAreMadeOnceAndOtherScalesGetANumber) {
  const fs::path root = TestFolder("batch_shared");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650069960004");
  WriteSmallObject(root / "in/LeverDoor/99650069960005", {.body_scale = 0.9});
  const ImportReport report = ImportAll(root / "in", root / "out");
  EXPECT_EQ(report.objects[0].body_id, "udm-9965006");
  EXPECT_EQ(report.objects[1].body_id, "udm-9965006");
  EXPECT_EQ(report.objects[2].body_id, "udm-9965006-2");
  EXPECT_NEAR(ReadPart(root / "out/udm-9965006-2").joint.origin_m.y(), -0.45, 1e-6);
  // the three handles have the same file at the same scale
  EXPECT_EQ(report.objects[2].handle_id, "udm-9960003");
}

TEST(ImportObjects, TheSameBytesForAnyNumberOfThreadsAndOnASecondRun) {
  const fs::path root = TestFolder("batch_threads");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650079960004", {.body_scale = 0.85, .handle_scale = 1});
  ImportAll(root / "in", root / "one", {.threads = 1});
  ImportAll(root / "in", root / "two", {.threads = 2});
  EXPECT_EQ(FilesIn(root / "one"), FilesIn(root / "two"));
  const auto written = fs::last_write_time(root / "one/udm-9965006/part.json");
  const ImportReport again = ImportAll(root / "in", root / "one", {.threads = 1});
  EXPECT_EQ(again.objects[0].outcome, ImportOutcome::kImported);
  EXPECT_EQ(fs::last_write_time(root / "one/udm-9965006/part.json"), written);
}

TEST(ImportObjects, SeveralPathsAreOneRunAndAFaultyOneCostsNoOther) {
  const fs::path root = TestFolder("batch_paths");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650079960004", {.body_scale = 0.85});
  WriteText(root / "in/notes.txt", "no object");
  const std::vector<fs::path> paths = {root / "in/LeverDoor/99650069960003", root / "in/nowhere",
                                       root / "in/notes.txt", root / "in/LeverDoor",
                                       root / "in/LeverDoor/../LeverDoor/99650079960004"};
  const std::vector<ForeignSource> sources = FindObjects(paths);
  ASSERT_EQ(sources.size(), 4U) << "each object once";
  const ImportReport report = ImportObjects(sources, root / "out", {}, Existing::kRefuse);
  ASSERT_EQ(report.objects.size(), 4U);
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported);
  EXPECT_EQ(report.objects[1].outcome, ImportOutcome::kIncomplete);
  EXPECT_NE(report.objects[1].message.find("no such file or folder"), std::string::npos);
  EXPECT_EQ(report.objects[2].outcome, ImportOutcome::kIncomplete);
  EXPECT_EQ(report.objects[3].outcome, ImportOutcome::kImported);
  EXPECT_THROW(FindObjects(std::vector<fs::path>{root / "in/nowhere"}), Error);
}

TEST(ImportObjects, PartsMadeWithOtherSettingsAreReplacedOnlyWhenAsked) {
  const fs::path root = TestFolder("batch_settings");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  ImportAll(root / "in", root / "out");
  ImportConfig other;
  other.make.handle_convex.max_parts = 3;
  const ImportReport refused = ImportAll(root / "in", root / "out", other);
  EXPECT_EQ(refused.objects[0].outcome, ImportOutcome::kExists);
  EXPECT_NE(refused.objects[0].message.find("--overwrite"), std::string::npos);
  const ImportReport replaced = ImportAll(root / "in", root / "out", other, Existing::kReplace);
  EXPECT_EQ(replaced.objects[0].outcome, ImportOutcome::kImported);
}

}  // namespace
}  // namespace doorforge
