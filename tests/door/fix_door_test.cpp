// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/validate/fix_door.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/compose/compose.h"
#include "doorforge/compose/shared_doors.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/part.h"

#include "box_door.h"
#include "broken_doors.h"
#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::map<std::string, std::string> BytesBelow(const fs::path& folder) {
  std::map<std::string, std::string> bytes;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      bytes[entry.path().lexically_relative(folder)] = ReadFile(entry.path());
  }
  return bytes;
}

std::string Describe(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text +=
        finding.code + " " + finding.where + ": " + finding.measured + "; " + finding.fix + "\n";
  return text;
}

bool IsFixable(const std::string& code) {
  for (const ValidationRule& rule : ValidationRules()) {
    if (rule.code == code) return rule.fixable;
  }
  return false;
}

// Broken beyond what the rule's fix allows.
bool IsTooFarGone(const BrokenDoor& broken) { return broken.code == "COL002"; }

TEST(FixFolder, MendsEveryFixableRuleAndLeavesTheRestAsItIs) {
  int index = 0;
  for (const BrokenDoor& broken : BrokenDoors()) {
    SCOPED_TRACE(broken.code + " " + broken.measured);
    const fs::path folder = Written(broken, "fix/" + std::to_string(index++));
    const auto before = BytesBelow(folder);
    const FixReport report = FixFolder(folder, FixMode::kWrite);
    if (IsFixable(broken.code) && !IsTooFarGone(broken)) {
      ASSERT_EQ(report.fixes.size(), 1u) << Describe(report.left);
      EXPECT_EQ(report.fixes[0].code, broken.code);
      EXPECT_FALSE(report.fixes[0].done.empty());
      EXPECT_TRUE(report.written);
      EXPECT_TRUE(report.left.empty()) << Describe(report.left);
      const ValidationReport after = ValidateDoor(folder);
      EXPECT_TRUE(after.findings.empty()) << Describe(after.findings);
    } else {
      EXPECT_TRUE(report.fixes.empty());
      EXPECT_FALSE(report.written);
      ASSERT_FALSE(report.left.empty());
      EXPECT_EQ(report.left[0].code, broken.code);
      EXPECT_EQ(BytesBelow(folder), before);
    }
  }
  // nothing is left beside the folders
  for (const auto& entry : fs::directory_iterator(ValidationFolder("fix")))
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

TEST(FixFolder, RestoresTheNumbersOfTheGoodDoor) {
  const fs::path good = Written(BoxDoor(), "fix_numbers/good");
  const fs::path folder = Written(BoxDoor(), "fix_numbers/broken");
  Json json = ReadJsonFile(folder / "door.json");
  json["hinge"]["axis"] = {0, 0, -2};
  json["hinge"]["effort_limit_nm"] = 0;
  json["links"][1]["mass"]["inertia_xx_yy_zz_kg_m2"] = {1, 1, -1};
  json["links"][1]["mass"]["center_of_mass_m"] = {0, 0, 9};
  WriteJsonFile(folder / "door.json", json);
  const FixReport report = FixFolder(folder, FixMode::kWrite);
  std::vector<std::string> codes;
  for (const Fix& fix : report.fixes) codes.push_back(fix.code);
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  EXPECT_EQ(codes, (std::vector<std::string>{"INR002", "INR004", "MEC001", "MEC005", "URD008"}));
  const DoorAsset mended = ReadDoor(folder);
  const DoorAsset expected = ReadDoor(good);
  EXPECT_LT((mended.hinge.axis - expected.hinge.axis).norm(), 1e-12);
  EXPECT_EQ(mended.hinge.effort_limit_nm, expected.hinge.effort_limit_nm);
  // mesh files hold floats
  const MassProperties& mass = mended.links[kLeafLink].mass;
  const MassProperties& wants = expected.links[kLeafLink].mass;
  EXPECT_NEAR(mass.mass_kg, wants.mass_kg, 1e-9);
  EXPECT_LT((mass.center_of_mass_m - wants.center_of_mass_m).norm(), 1e-6);
  EXPECT_LT((mass.inertia_kg_m2 - wants.inertia_kg_m2).norm(), 1e-5);
}

TEST(FixFolder, WritesNothingInADryRun) {
  DoorAsset door = BoxDoor();
  for (Eigen::Vector3i& t : door.links[kLeafLink].geometry[0].mesh.triangles) std::swap(t[0], t[1]);
  const fs::path folder = Written(door, "fix_dry/door");
  const auto before = BytesBelow(ValidationFolder("fix_dry"));
  const FixReport report = FixFolder(folder, FixMode::kDryRun);
  ASSERT_EQ(report.fixes.size(), 1u);
  EXPECT_EQ(report.fixes[0].code, "MSH006");
  EXPECT_FALSE(report.written);
  EXPECT_EQ(BytesBelow(ValidationFolder("fix_dry")), before);
}

TEST(FixFolder, ReplacesADentedCollisionShapeByItsConvexHull) {
  DoorAsset door = BoxDoor();
  // a millimetre of dent in the middle of the leaf's front
  TriangleMesh& hull = door.links[kLeafLink].geometry[0].hulls[0];
  hull.vertices.emplace_back(-0.0085, 0.4, 0.9);
  hull.triangles.resize(10);
  for (const Eigen::Vector2i& edge :
       {Eigen::Vector2i(1, 3), Eigen::Vector2i(3, 7), Eigen::Vector2i(7, 5), Eigen::Vector2i(5, 1)})
    hull.triangles.emplace_back(edge[0], edge[1], 8);
  const fs::path folder = Written(door, "fix_dent");
  ASSERT_EQ(ValidateDoor(folder).findings.size(), 1u) << Describe(ValidateDoor(folder).findings);
  EXPECT_EQ(ValidateDoor(folder).findings[0].code, "COL002");
  const FixReport report = FixFolder(folder, FixMode::kWrite);
  ASSERT_EQ(report.fixes.size(), 1u) << Describe(report.left);
  EXPECT_TRUE(ValidateDoor(folder).findings.empty());
}

TEST(FixFolder, NeverWritesToAMeshPool) {
  const fs::path doors = ValidationFolder("fix_pool");
  fs::remove_all(doors);
  std::vector<PreparedPart> parts;
  parts.emplace_back(SmallBody(), ComposeConfig{});
  parts.emplace_back(SmallLever(), ComposeConfig{});
  const std::vector<PartPair> pairs = {{0, 1}};
  WriteMeshPool(parts, doors, 1);
  WriteSharedDoors({parts, pairs, {}, Existing::kRefuse, 1}, doors, [](std::size_t) {});
  const fs::path folder = doors / "small_body__small_lever";
  const auto good = BytesBelow(folder);
  const auto pool = BytesBelow(doors / "pool");
  Json json = ReadJsonFile(folder / "door.json");
  json["handle_joint"]["velocity_limit_rad_s"] = 0;
  CommitFile(folder / "door.json", json.dump() + "\n");
  const FixReport report = FixFolder(folder, FixMode::kWrite);
  ASSERT_EQ(report.fixes.size(), 1u) << Describe(report.left);
  EXPECT_EQ(report.fixes[0].code, "MEC005");
  EXPECT_EQ(Json::parse(BytesBelow(folder)["door.json"]), Json::parse(good.at("door.json")));
  EXPECT_EQ(BytesBelow(folder)["model.urdf"], good.at("model.urdf"));
  EXPECT_EQ(BytesBelow(doors / "pool"), pool);
}

TEST(FixFolder, MendsAPart) {
  Part part = SmallLever();
  for (Eigen::Vector3i& t : part.pieces[0].mesh.triangles) std::swap(t[0], t[1]);
  part.pieces[0].mass.inertia_kg_m2.setZero();
  const fs::path folder = ValidationFolder("fix_part");
  StagedFolder staged(folder, kPartFolder, Existing::kReplace);
  WritePart(part, staged.path());
  staged.Commit();
  CommitFile(folder / "notes.txt", "the author's own");
  const FixReport report = FixFolder(folder, FixMode::kWrite);
  ASSERT_EQ(report.fixes.size(), 2u) << Describe(report.left);
  EXPECT_EQ(ReadPart(folder).pieces[0].mesh.triangles, SmallLever().pieces[0].mesh.triangles);
  EXPECT_EQ(ReadFile(folder / "notes.txt"), "the author's own");
}

}  // namespace
}  // namespace doorforge
