// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/importers/import_objects.h"

#include <cmath>
#include <csignal>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

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

TEST(ImportObjects, RefusesAVertexBeyondAHundredMetresAndGoesOn) {
  const fs::path root = TestFolder("batch_far");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650089960005");
  const fs::path far = root / "in/LeverDoor/99650089960005/texture_dae/9960003.obj";
  TriangleMesh mesh = ReadObj(far);
  mesh.vertices[0].z() = 99000;
  std::string text;  // ToObj() keeps its promise about what it writes
  for (const Eigen::Vector3d& v : mesh.vertices)
    text += "v " + std::to_string(v.x()) + ' ' + std::to_string(v.y()) + ' ' +
            std::to_string(v.z()) + '\n';
  for (const Eigen::Vector3i& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' +
            std::to_string(t[2] + 1) + '\n';
  WriteText(far, text);
  const ImportReport report = ImportAll(root / "in", root / "out");
  ASSERT_EQ(report.objects.size(), 2U);
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported) << report.objects[0].message;
  EXPECT_EQ(report.objects[1].outcome, ImportOutcome::kInvalid);
  for (const char* part : {"9960003.obj", "allowed are coordinates up to 100 m"})
    EXPECT_NE(report.objects[1].message.find(part), std::string::npos) << report.objects[1].message;
}

TEST(ImportObjects, GivesUpAnObjectThatTakesTooMuchTimeAndSaysSo) {
  const fs::path root = TestFolder("batch_slow");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  ImportConfig config;
  config.max_seconds = 1e-9;
  const ImportReport report = ImportAll(root / "in", root / "out", config);
  ASSERT_EQ(report.objects.size(), 1U);
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kInvalid);
  for (const char* part : {"99650069960003", "processor time", "--max-seconds"})
    EXPECT_NE(report.objects[0].message.find(part), std::string::npos) << report.objects[0].message;
  EXPECT_FALSE(fs::exists(root / "out"));
}

TEST(ImportObjects, WritesNoHalfOfAPairWhereTheOtherHalfCannotBeWritten) {
  const fs::path root = TestFolder("batch_half");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  Profile round;
  constexpr int kCorners = 1500;  // some 100 kB of handle, beside a body of some hundred bytes
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kCorners;
    round.points.emplace_back(0.02 * std::cos(angle), 0.02 * std::sin(angle));
    if (i > 1) round.triangles.emplace_back(0, i - 1, i);
  }
  WriteText(root / "in/LeverDoor/99650069960003/texture_dae/9960003.obj",
            ToObj(Prism(round, 0, 2, -0.1, 0)));
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{50'000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(ImportAll(root / "in", root / "out"), Error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(fs::exists(root / "out/udm-9965006"));
  EXPECT_FALSE(fs::exists(root / "out/udm-9960003"));
  const ImportReport report = ImportAll(root / "in", root / "out");
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kImported) << report.objects[0].message;
}

TEST(ImportObjects, ADamagedPartInTheOutputCostsItsObjectAlone) {
  const fs::path root = TestFolder("batch_damaged_output");
  WriteSmallObject(root / "in/LeverDoor/99650069960003");
  WriteSmallObject(root / "in/LeverDoor/99650079960004", {.body_scale = 0.9, .handle_scale = 1.3});
  WriteText(root / "out/udm-9965006/part.json", "{");
  const ImportReport report = ImportAll(root / "in", root / "out");
  ASSERT_EQ(report.objects.size(), 2U);
  EXPECT_EQ(report.objects[0].outcome, ImportOutcome::kInvalid);
  EXPECT_NE(report.objects[0].message.find("part.json"), std::string::npos);
  EXPECT_EQ(report.objects[1].outcome, ImportOutcome::kImported) << report.objects[1].message;
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
