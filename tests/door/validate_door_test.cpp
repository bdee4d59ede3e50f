// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/door/validate_door.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/door/export_urdf.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/part.h"

#include "box_door.h"
#include "scratch_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path FolderOf(const std::string& name) { return ScratchFolder("validate") / name; }

fs::path Written(const DoorAsset& door, const std::string& name) {
  WriteDoorFolder(door, FolderOf(name), Existing::kReplace);
  return FolderOf(name);
}

std::set<std::string> CodesOf(const ValidationReport& report) {
  std::set<std::string> codes;
  for (const Finding& finding : report.findings) codes.insert(finding.code);
  return codes;
}

using EditDoor = std::function<void(DoorAsset&)>;
using EditFolder = std::function<void(const fs::path&)>;

/// A good door broken in one way, before or after it is written.
struct Mutation {
  std::string code;
  EditDoor edit_door;
  EditFolder edit_folder;
  std::string measured;             ///< Part of the finding's `measured`.
  std::set<std::string> also = {};  ///< Rules that the same fault breaks too.
};

EditFolder InJson(const std::function<void(Json&)>& edit) {
  return [edit](const fs::path& folder) {
    Json json = ReadJsonFile(folder / "door.json");
    edit(json);
    WriteJsonFile(folder / "door.json", json);
  };
}

EditFolder InUrdf(const std::function<void(UrdfModel&)>& edit) {
  return [edit](const fs::path& folder) {
    UrdfModel model = ReadUrdf(folder / "model.urdf");
    edit(model);
    CommitFile(folder / "model.urdf", ToUrdf(model));
  };
}

const char* const kLeafMesh = "meshes/visual/leaf.obj";

DoorGeometry& Leaf(DoorAsset& door) { return door.links[kLeafLink].geometry[0]; }
DoorGeometry& Grip(DoorAsset& door) { return door.links[kHandleLink].geometry[0]; }

void MoveHandle(DoorAsset& door, const Eigen::Vector3d& by) {
  door.handle_joint.parent_from_child_at_zero.pretranslate(by);
}

TriangleMesh Prism(int sides) {
  TriangleMesh mesh;
  for (const double z : {0.5, 0.6}) {
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * 3.14159265358979 * k / sides;
      mesh.vertices.emplace_back(-0.02 + 0.01 * std::cos(angle), 0.4 + 0.01 * std::sin(angle), z);
    }
  }
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    mesh.triangles.emplace_back(k, next, sides + next);
    mesh.triangles.emplace_back(k, sides + next, sides + k);
    if (k == 0 || next == 0) continue;
    mesh.triangles.emplace_back(0, next, k);
    mesh.triangles.emplace_back(sides, sides + k, sides + next);
  }
  return mesh;
}

void AddMutationsOfFiles(std::vector<Mutation>& all) {
  all.push_back({"REC001", {}, [](const fs::path& f) { CommitFile(f / "door.json", "{"); }, ""});
  all.push_back({"REC002",
                 {},
                 InJson([](Json& j) { j["links"][0]["geometry"][0]["name"] = "leaf"; }),
                 "2 times",
                 {"URD011"}});
  all.push_back(
      {"MSH001", {}, [](const fs::path& f) { fs::remove(f / kLeafMesh); }, "missing", {"URD009"}});
  all.push_back({"MSH002",
                 {},
                 [](const fs::path& f) { CommitFile(f / kLeafMesh, "v 0 nan 0\n"); },
                 "leaf.obj:1"});
  all.push_back(
      {"MSH003",
       {},
       InJson([](Json& j) { j["links"][1]["geometry"][0]["mesh"]["path"] = "../../leaf.obj"; }),
       "../../leaf.obj"});
  all.push_back({"MSH004",
                 {},
                 [](const fs::path& f) {
                   TriangleMesh mesh = ReadObj(f / kLeafMesh);
                   mesh.vertices[7].z() += 0.0001;
                   CommitFile(f / kLeafMesh, ToObj(mesh));
                 },
                 "SHA-256"});
}

void AddMutationsOfMeshes(std::vector<Mutation>& all) {
  all.push_back({"MSH005",
                 [](DoorAsset& d) { Leaf(d).mesh.triangles.pop_back(); },
                 {},
                 "3 boundary, 0 non-manifold, 0 inconsistent edges of 11 triangles"});
  all.push_back({"MSH006",
                 [](DoorAsset& d) {
                   for (Eigen::Vector3i& t : Leaf(d).mesh.triangles) std::swap(t[0], t[1]);
                 },
                 {},
                 "-0.0576 m3"});  // 0.04 x 0.8 x 1.8 m
  all.push_back({"MSH007",
                 [](DoorAsset& d) { Leaf(d).mesh.triangles.emplace_back(0, 0, 1); },
                 {},
                 "1 degenerate"});
  all.push_back({"COL001", [](DoorAsset& d) { Leaf(d).hulls.clear(); }, {}, "none"});
  all.push_back(
      {"COL002",
       [](DoorAsset& d) { Leaf(d).hulls[0].vertices[7] = Eigen::Vector3d(-0.03, 0.4, 0.9); },
       {},
       " m"});
  all.push_back({"COL003",
                 [](DoorAsset& d) {
                   Grip(d).hulls[1] = BoxOf({0.04, -0.115, -0.01}, {0.052, 0.01, 0.01});
                 },
                 {},
                 "0.005 m"});
  all.push_back({"COL004",
                 [](DoorAsset& d) {
                   Leaf(d).hulls[0] = BoxOf({-0.0475, 0, 0.01}, {-0.0075, 0.8, 1.79});
                 },
                 {},
                 "0.02 m"});
  all.push_back(
      {"COL005", [](DoorAsset& d) { Leaf(d).hulls.assign(33, Leaf(d).hulls[0]); }, {}, "33"});
  all.push_back({"COL006", [](DoorAsset& d) { Leaf(d).hulls.push_back(Prism(40)); }, {}, "80"});
}

void AddMutationsOfMass(std::vector<Mutation>& all) {
  const auto mass = [](DoorAsset& d) -> MassProperties& { return d.links[kLeafLink].mass; };
  all.push_back({"INR001", [=](DoorAsset& d) { mass(d).mass_kg = 0; }, {}, "0 kg"});
  all.push_back(
      {"INR002", [=](DoorAsset& d) { mass(d).inertia_kg_m2(1, 1) = -2; }, {}, "-2 kg m2"});
  all.push_back(
      {"INR003",
       [=](DoorAsset& d) { mass(d).inertia_kg_m2 = Eigen::Vector3d(1, 1.5, 3).asDiagonal(); },
       {},
       "3 above 1 + 1.5"});
  all.push_back(
      {"INR004", [=](DoorAsset& d) { mass(d).center_of_mass_m.z() = 2.31; }, {}, "0.5 m"});
  all.push_back({"INR005", [=](DoorAsset& d) { mass(d).mass_kg = 0.576; }, {}, "10 kg/m3"});
}

void AddMutationsOfMechanics(std::vector<Mutation>& all) {
  all.push_back({"MEC001",
                 {},
                 InJson([](Json& j) {
                   j["hinge"]["axis"] = {0, 0, -2};
                 }),
                 "length 2"});
  all.push_back(
      {"MEC002", [](DoorAsset& d) { d.handle_joint.lower_rad = 0.2; }, {}, "0.2 to 0.785"});
  all.push_back({"MEC003", [](DoorAsset& d) { d.hinge.upper_rad = 0.5; }, {}, "0.5 rad"});
  all.push_back({"MEC004", [](DoorAsset& d) { d.hinge.axis = Eigen::Vector3d::UnitZ(); }, {}, "-"});
  all.push_back(
      {"MEC005", {}, InJson([](Json& j) { j["hinge"]["effort_limit_nm"] = 0.0; }), "effort 0 N m"});
  all.push_back({"MEC006", [](DoorAsset& d) { d.latch.unlock_angle_rad = 1; }, {}, "unlock 1"});
  all.push_back({"MEC007", [](DoorAsset& d) { d.handle_joint.upper_rad = 0; }, {}, "0 rad"});
  all.push_back(
      {"MEC008", [](DoorAsset& d) { d.latch.lock_effort_nm = -1; }, {}, "lock effort -1"});
  all.push_back({"MEC009",
                 [](DoorAsset& d) {
                   for (TriangleMesh* mesh : {&Leaf(d).mesh, Leaf(d).hulls.data()}) {
                     for (Eigen::Vector3d& vertex : mesh->vertices) vertex.y() += 0.3;
                   }
                   d.links[kLeafLink].mass.center_of_mass_m.y() += 0.3;
                   MoveHandle(d, {0, 0.3, 0});
                 },
                 {},
                 "0.3001 m"});
}

void AddMutationsOfUrdf(std::vector<Mutation>& all) {
  all.push_back(
      {"URD001", {}, [](const fs::path& f) { fs::remove(f / "model.urdf"); }, "model.urdf"});
  all.push_back({"URD001",
                 {},
                 [](const fs::path& f) {
                   std::string text = ReadFile(f / "model.urdf");
                   text.insert(text.rfind("</robot>"), "<link name=\"leaf\"/>");
                   CommitFile(f / "model.urdf", text);
                 },
                 "second one named \"leaf\""});
  all.push_back({"URD002",
                 {},
                 InUrdf([](UrdfModel& m) {
                   m.links.emplace_back().name = "closer";
                   UrdfJoint joint;
                   joint.name = "closer_joint";
                   joint.parent = "leaf";
                   joint.child = "closer";
                   m.joints.push_back(joint);
                 }),
                 "not in door.json"});
  all.push_back({"URD003",
                 {},
                 InUrdf([](UrdfModel& m) {
                   UrdfJoint joint = m.joints[0];
                   joint.name = "second_hinge";
                   m.joints.push_back(joint);
                 }),
                 "child of two joints"});
  all.push_back({"URD004", {}, InUrdf([](UrdfModel& m) { m.joints[0].name = "hing"; }), "absent"});
  all.push_back(
      {"URD005", {}, InUrdf([](UrdfModel& m) { m.joints[0].upper = 1.25; }), "differs by 0.25"});
  all.push_back({"URD006", {}, InUrdf([](UrdfModel& m) { m.joints[0].axis *= 3; }), "length 3"});
  all.push_back(
      {"URD007", {}, InUrdf([](UrdfModel& m) { m.joints[0].effort.reset(); }), "effort absent"});
  all.push_back({"URD008",
                 {},
                 InUrdf([](UrdfModel& m) { m.links[1].inertial->mass_kg *= 2; }),
                 "mass off by 0.5"});
  all.push_back({"URD009",
                 {},
                 InUrdf([](UrdfModel& m) {
                   std::get<UrdfMeshFile>(m.links[1].visuals[0].geometry).filename = "../leaf.obj";
                 }),
                 "../leaf.obj",
                 {"URD011"}});
  all.push_back({"URD010",
                 {},
                 InUrdf([](UrdfModel& m) {
                   std::get<UrdfMeshFile>(m.links[1].visuals[0].geometry).scale *= 0.5;
                 }),
                 "0.5 0.5 0.5"});
  all.push_back({"URD011",
                 {},
                 InUrdf([](UrdfModel& m) { m.links[1].collisions.clear(); }),
                 "lacks collision meshes/collision/leaf_0.obj"});
}

void AddMutationsOfHandle(std::vector<Mutation>& all) {
  all.push_back({"HND001",
                 [](DoorAsset& d) {
                   MoveHandle(d, {-0.045, 0, 0});
                 },
                 {},
                 "% of the surface",
                 {"HND006", "HND008"}});
  all.push_back({"HND002",
                 [](DoorAsset& d) {
                   MoveHandle(d, {-0.05, 0, 0});
                 },
                 {},
                 "0.002 m",
                 {"HND001", "HND006", "HND008"}});
  all.push_back({"HND003", [](DoorAsset& d) { MoveHandle(d, {0, 0.09, 0}); }, {}, "0.02 m"});
  all.push_back({"HND004",
                 [](DoorAsset& d) { d.handle_from_grasp.translation().y() = -0.3; },
                 {},
                 "nothing"});
  all.push_back({"HND005",
                 [](DoorAsset& d) {
                   d.handle_from_grasp = d.handle_from_grasp * RotationAbout({0, 1, 0}, 2.0944);
                 },
                 {},
                 "-0.5",
                 {"HND008"}});
  all.push_back({"HND006",
                 [](DoorAsset& d) {
                   MoveHandle(d, {-0.036, 0, 0});
                 },
                 {},
                 "0.001 m",
                 {"HND008"}});
  all.push_back({"HND007",
                 [](DoorAsset& d) {
                   const TriangleMesh plate = BoxOf({0.04, -0.12, -0.04}, {0.052, 0.01, 0.04});
                   Grip(d).mesh = SideBySide(Grip(d).hulls[0], plate);
                   Grip(d).hulls[1] = plate;
                 },
                 {},
                 "0.08 m",
                 {"HND008"}});
  all.push_back({"HND008",
                 [](DoorAsset& d) {
                   const TriangleMesh block = BoxOf({0.02, 0.63, 0.855}, {0.06, 0.67, 0.87});
                   AddGeometry({"rose", block, {block}, {1, 1, 1, 1}, PointLabel::kHandle}, 7000,
                               d.links[kLeafLink]);
                 },
                 {},
                 "way not free"});
  all.push_back({"LIC001", [](DoorAsset& d) { d.license.clear(); }, {}, "empty"});
  all.push_back({"LIC002", [](DoorAsset& d) { d.license = "NOASSERTION"; }, {}, "NOASSERTION"});
}

std::vector<Mutation> AllMutations() {
  std::vector<Mutation> all;
  AddMutationsOfFiles(all);
  AddMutationsOfMeshes(all);
  AddMutationsOfMass(all);
  AddMutationsOfMechanics(all);
  AddMutationsOfUrdf(all);
  AddMutationsOfHandle(all);
  return all;
}

std::string Describe(const ValidationReport& report) {
  return ToJson(std::vector<ValidationReport>{report}).dump(2);
}

TEST(ValidateDoor, FindsNothingInAGoodDoor) {
  const ValidationReport report = ValidateDoor(Written(BoxDoor(), "good"));
  EXPECT_TRUE(report.findings.empty()) << Describe(report);
  EXPECT_EQ(report.errors, 0);
}

TEST(ValidateDoor, RaisesExactlyTheRulesThatAFaultBreaks) {
  int index = 0;
  for (const Mutation& mutation : AllMutations()) {
    SCOPED_TRACE(mutation.code + " " + mutation.measured);
    DoorAsset door = BoxDoor();
    if (mutation.edit_door) mutation.edit_door(door);
    const fs::path folder = Written(door, mutation.code + "_" + std::to_string(index++));
    if (mutation.edit_folder) mutation.edit_folder(folder);
    const ValidationReport report = ValidateDoor(folder);
    std::set<std::string> expected = mutation.also;
    expected.insert(mutation.code);
    EXPECT_EQ(CodesOf(report), expected) << Describe(report);
    for (const Finding& finding : report.findings) {
      if (finding.code != mutation.code) continue;
      EXPECT_NE(finding.measured.find(mutation.measured), std::string::npos) << finding.measured;
      EXPECT_FALSE(finding.where.empty());
      EXPECT_FALSE(finding.fix.empty());
      EXPECT_EQ(finding.allowed.find("{}"), std::string::npos);
    }
  }
}

TEST(ValidateDoor, HasAMutationForEveryRule) {
  std::set<std::string> mutated;
  for (const Mutation& mutation : AllMutations()) mutated.insert(mutation.code);
  std::set<std::string> rules;
  for (const ValidationRule& rule : ValidationRules()) {
    EXPECT_TRUE(rules.insert(std::string(rule.code)).second) << rule.code << " occurs twice";
  }
  EXPECT_EQ(mutated, rules);
}

TEST(ValidateDoor, ReportsAllFaultsAtOnceAndCountsThem) {
  DoorAsset door = BoxDoor();
  door.hinge.upper_rad = 0.5;
  door.latch.lock_effort_nm = -1;
  door.license = "NOASSERTION";
  const fs::path folder = Written(door, "several");
  fs::remove(folder / kLeafMesh);
  fs::remove(folder / "meshes/collision/grip_1.obj");
  const ValidationReport report = ValidateDoor(folder);
  EXPECT_EQ(CodesOf(report),
            (std::set<std::string>{"MSH001", "MEC003", "MEC008", "URD009", "LIC002"}))
      << Describe(report);
  EXPECT_EQ(report.errors, 6);
  EXPECT_EQ(report.warnings, 1);
}

TEST(ValidateDoor, LeavesPhysicalRulesToThePhysicsProfile) {
  DoorAsset door = BoxDoor();
  door.hinge.upper_rad = 0.5;
  const fs::path folder = Written(door, "profile");
  EXPECT_EQ(ValidateDoor(folder, ValidationProfile::kPhysics).errors, 1);
  EXPECT_EQ(ValidateDoor(folder, ValidationProfile::kUrdf).errors, 0);
}

TEST(ValidateDoor, RefusesAFolderWithoutARecord) {
  fs::create_directories(FolderOf("empty"));
  try {
    FindRecords(FolderOf("empty"));
    FAIL() << "expected an Error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kMissing);
  }
  EXPECT_THROW(ValidateDoor(FolderOf("empty")), Error);
}

TEST(ValidateDoor, FindsAllDoorsBelowAFolder) {
  Written(BoxDoor(), "many/a");
  Written(BoxDoor(), "many/sub/b");
  const std::vector<fs::path> found = FindRecords(FolderOf("many"));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].filename(), "a");
  EXPECT_EQ(found[1].filename(), "b");
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
  for (const char* key : {"folder", "code", "severity", "where", "measured", "allowed", "fix"})
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
    StagedFolder staged(FolderOf(name), Existing::kReplace);
    WritePart(part, staged.path());
    staged.Commit();
    return ValidatePart(FolderOf(name));
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
  for (const ValidationRule& rule : ValidationRules()) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%.4g", rule.limit);
    std::string allowed(rule.allowed);
    if (const auto at = allowed.find("{}"); at != std::string::npos) allowed.replace(at, 2, limit);
    expected.insert("| `" + std::string(rule.code) + "` | " + std::string(NameOf(rule.severity)) +
                    " | " + std::string(rule.text) + " | " + allowed + " | " +
                    std::string(rule.fix) + " |");
  }
  EXPECT_EQ(listed, expected);
}

}  // namespace
}  // namespace doorforge
