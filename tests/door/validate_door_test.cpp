// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/validate/validate_door.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <new>
#include <set>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/foreign/foreign_rules.h"
#include "doorforge/mesh/work_budget.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/part.h"

#include "box_door.h"
#include "broken_doors.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::set<std::string> CodesOf(const ValidationReport& report) {
  std::set<std::string> codes;
  for (const Finding& finding : report.findings) codes.insert(finding.code);
  return codes;
}

std::string Describe(const ValidationReport& report) {
  return ToJson(std::vector<ValidationReport>{report}).dump(2);
}

TEST(ValidateDoor, FindsNothingInAGoodDoor) {
  const ValidationReport report = ValidateDoor(Written(BoxDoor(), "good"));
  EXPECT_TRUE(report.findings.empty()) << Describe(report);
  EXPECT_EQ(report.errors, 0);
}

TEST(ValidateDoor, RaisesOneRuleForEachOfAtLeast40BrokenDoors) {
  int index = 0;
  for (const BrokenDoor& broken : BrokenDoors()) {
    SCOPED_TRACE(broken.code + " " + broken.measured);
    const ValidationReport report =
        ValidateDoor(Written(broken, broken.code + "_" + std::to_string(index++)));
    EXPECT_EQ(CodesOf(report), std::set<std::string>{broken.code}) << Describe(report);
    for (const Finding& finding : report.findings) {
      EXPECT_NE(finding.measured.find(broken.measured), std::string::npos) << finding.measured;
      EXPECT_FALSE(finding.where.empty());
      EXPECT_FALSE(finding.fix.empty());
      EXPECT_EQ(finding.allowed.find("{}"), std::string::npos);
    }
  }
  EXPECT_GE(index, 40);
}

// SWP and OPN are simulated; openable_check_test.cpp breaks doors for them.
bool IsSimulated(std::string_view code) {
  return code.starts_with("SWP") || code.starts_with("OPN");
}

TEST(ValidateDoor, HasAMutationForEveryRule) {
  std::set<std::string> mutated;
  for (const BrokenDoor& broken : BrokenDoors()) mutated.insert(broken.code);
  std::set<std::string> codes;
  std::set<std::string> rules;
  for (const ValidationRule& rule : ValidationRules()) {
    EXPECT_TRUE(codes.insert(std::string(rule.code)).second) << rule.code << " occurs twice";
    if (!IsSimulated(rule.code)) rules.insert(std::string(rule.code));
  }
  EXPECT_EQ(mutated, rules);
}

TEST(ValidateDoor, HandsSoundDoorsAloneToTheOpeningCheck) {
  int checked = 0;
  const DoorValidator validator([&](const DoorAsset&) {
    ++checked;
    return std::vector<Finding>{FindingOf("OPN001", "latch", "1 rad")};
  });
  const ValidationReport good = validator.Validate(Written(BoxDoor(), "openable_good"));
  EXPECT_EQ(CodesOf(good), std::set<std::string>{"OPN001"});
  DoorAsset door = BoxDoor();
  door.hinge.upper_rad = 0.5;
  const ValidationReport bad = validator.Validate(Written(door, "openable_bad"));
  EXPECT_EQ(CodesOf(bad), (std::set<std::string>{"MEC003", "OPN007"})) << Describe(bad);
  EXPECT_EQ(checked, 1);
}

// What a validator remembers of other doors, and how many threads use it, changes no finding.
TEST(ValidateDoor, FindsTheSameAfterOtherDoorsAndInSeveralThreads) {
  std::vector<fs::path> folders;
  std::vector<std::string> alone;
  for (const BrokenDoor& broken : BrokenDoors()) {
    folders.push_back(Written(broken, "together/" + std::to_string(folders.size())));
    alone.push_back(Describe(ValidateDoor(folders.back())));
  }
  for (const int threads : {1, 3}) {
    const DoorValidator validator;
    std::vector<std::string> together(folders.size());
    ParallelFor(folders.size(), threads,
                [&](std::size_t i) { together[i] = Describe(validator.Validate(folders[i])); });
    EXPECT_EQ(together, alone) << threads << " threads";
  }
}

TEST(ValidateDoor, ReportsAllFaultsAtOnceAndCountsThem) {
  DoorAsset door = BoxDoor();
  door.hinge.upper_rad = 0.5;
  door.latch.lock_effort_nm = -1;
  door.license = "NOASSERTION";
  const fs::path folder = Written(door, "several");
  fs::remove(folder / "meshes/visual/leaf.obj");
  fs::remove(folder / "meshes/collision/grip_1.obj");
  const ValidationReport report = ValidateDoor(folder);
  EXPECT_EQ(CodesOf(report), (std::set<std::string>{"MSH001", "MEC003", "MEC008", "LIC002"}))
      << Describe(report);
  EXPECT_EQ(report.errors, 4);
  EXPECT_EQ(report.warnings, 1);
}

// A grip whose extent in cells of two millimetres no integer of 32 bits holds.
TEST(ValidateDoor, FindsAVertexOfTheGripThatLiesFarAway) {
  for (const double far : {99.5, -343598.0, 1e30}) {
    const fs::path folder = Written(BoxDoor(), "far_" + std::to_string(far).substr(0, 6));
    TriangleMesh grip = ReadObj(folder / "meshes/visual/grip.obj");
    grip.vertices[0].x() = far;
    grip.vertices[1].y() = far;
    grip.vertices[2].z() = far;
    CommitFile(folder / "meshes/visual/grip.obj", ToObj(grip));
    const ValidationReport report = ValidateDoor(folder);
    const char* const code = std::abs(far) > 100 ? "MSH002" : "REC003";
    EXPECT_TRUE(CodesOf(report).contains(code)) << Describe(report);
  }
}

TEST(ValidateDoor, MakesAFindingOfWhateverACheckThrows) {
  const fs::path folder = Written(BoxDoor(), "throwing");
  const auto codes = [&](const std::function<void()>& fail) {
    const DoorValidator validator([&](const DoorAsset&) {
      fail();
      return std::vector<Finding>{};
    });
    return CodesOf(validator.Validate(folder));
  };
  EXPECT_EQ(codes([] { throw std::bad_alloc(); }), std::set<std::string>{"REC003"});
  EXPECT_EQ(codes([] { throw std::length_error("vector"); }), std::set<std::string>{"REC003"});
  EXPECT_EQ(codes([] {}), std::set<std::string>{});
}

TEST(ValidateDoor, GivesUpWhatTakesTooMuchTimeAndSaysSo) {
  DoorAsset door = BoxDoor();
  const fs::path folder = Written(door, "slow");
  const WorkBudget budget((folder / "door.json").string(), 1e-9);
  const ValidationReport report = ValidateDoor(folder);
  ASSERT_EQ(CodesOf(report), std::set<std::string>{"REC003"}) << Describe(report);
  EXPECT_EQ(report.findings.size(), 1U) << "one fault, one finding: " << Describe(report);
  EXPECT_NE(report.findings[0].measured.find("--max-seconds"), std::string::npos);
}

TEST(ValidateDoor, LeavesPhysicalRulesToThePhysicsProfile) {
  DoorAsset door = BoxDoor();
  door.hinge.upper_rad = 0.5;
  const fs::path folder = Written(door, "profile");
  EXPECT_EQ(ValidateDoor(folder, ValidationProfile::kPhysics).errors, 1);
  EXPECT_EQ(ValidateDoor(folder, ValidationProfile::kUrdf).errors, 0);
}

TEST(ValidateDoor, RefusesAFolderWithoutARecord) {
  fs::create_directories(ValidationFolder("empty"));
  try {
    FindRecords(ValidationFolder("empty"));
    FAIL() << "expected an Error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMissing);
  }
  EXPECT_THROW(ValidateDoor(ValidationFolder("empty")), Error);
}

TEST(ValidateDoor, FindsAllDoorsBelowAFolder) {
  Written(BoxDoor(), "many/a");
  Written(BoxDoor(), "many/sub/b");
  const std::vector<fs::path> found = FindRecords(ValidationFolder("many"));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].filename(), "a");
  EXPECT_EQ(found[1].filename(), "b");
  const std::vector<std::string> paths = {ValidationFolder("many/sub"), ValidationFolder("many")};
  ASSERT_EQ(FindRecords(paths).size(), 3u);
  EXPECT_EQ(FindRecords(paths)[0].filename(), "b");
}

TEST(ValidateDoor, WritesFindingsAndCountsAsJson) {
  DoorAsset door = BoxDoor();
  door.license.clear();
  const std::vector<ValidationReport> reports = {ValidateDoor(Written(door, "json"))};
  const Json json = ToJson(reports);
  EXPECT_EQ(json["schema"], "doorforge.validation");
  EXPECT_EQ(json["counts"]["errors"], 1);
  EXPECT_EQ(json["counts"]["folders"], 1);
  ASSERT_EQ(json["findings"].size(), 1u);
  for (const char* key :
       {"folder", "code", "severity", "where", "measured", "allowed", "fix", "fixable"})
    EXPECT_TRUE(json["findings"][0].contains(key)) << key;
}

TEST(ValidatePart, FindsAGraspBesideTheHandleAndAnOpenMesh) {
  Part part;
  part.id = "box_lever";
  part.role = PartRole::kHandle;
  part.mechanism = Mechanism::kLever;
  part.license = "CC0-1.0";
  const DoorAsset door = BoxDoor();
  const DoorGeometry& grip = door.links[kHandleLink].geometry[0];
  part.pieces.push_back(
      {"grip", grip.mesh, grip.hulls, {1, 1, 1, 1}, door.links[kHandleLink].mass});
  part.joint = {{0, 0, 0}, {1, 0, 0}, 0, 0.78};
  part.part_from_grasp = door.handle_from_grasp;
  const auto validate = [&](const std::string& name) {
    StagedFolder staged(ValidationFolder(name), kPartFolder, Existing::kReplace);
    WritePart(part, staged.path());
    staged.Commit();
    return ValidatePart(ValidationFolder(name));
  };
  const ValidationReport good = validate("part_good");
  EXPECT_TRUE(good.findings.empty()) << Describe(good);
  part.part_from_grasp.translation().z() = 0.2;
  part.pieces[0].mesh.triangles.pop_back();
  EXPECT_EQ(CodesOf(validate("part_bad")), (std::set<std::string>{"MSH005", "HND004"}));
}

// docs/validation-rules.md is written by hand from the table; this keeps the two together.
TEST(ValidationRules, AreListedInTheDocumentation) {
  const std::string page =
      ReadFile(fs::path(DOORFORGE_SOURCE_DIR) / "docs" / "validation-rules.md");
  std::set<std::string> listed;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| `")) listed.insert(line);
  }
  std::set<std::string> expected;
  for (const ValidationRule& rule : AllRules()) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%.4g", rule.limit);
    std::string allowed(rule.allowed);
    if (const auto at = allowed.find("{}"); at != std::string::npos) allowed.replace(at, 2, limit);
    expected.insert("| `" + std::string(rule.code) + "` | " + std::string(NameOf(rule.severity)) +
                    " | " + std::string(rule.text) + " | " + allowed + " | " +
                    std::string(rule.fix) + " | " + (rule.fixable ? "yes" : "") + " |");
  }
  EXPECT_EQ(listed, expected);
}

}  // namespace
}  // namespace doorforge
