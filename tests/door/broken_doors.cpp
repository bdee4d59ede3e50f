// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "broken_doors.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/schemas/mesh_file.h"

#include "box_door.h"
#include "scratch_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using EditFolder = std::function<void(const fs::path&)>;

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

void AddMutationsOfFiles(std::vector<BrokenDoor>& all) {
  all.push_back({"REC001", {}, [](const fs::path& f) { CommitFile(f / "door.json", "{"); }, ""});
  all.push_back({"REC002",
                 {},
                 [](const fs::path& f) {
                   InJson([](Json& j) { j["links"][0]["geometry"][0]["name"] = "leaf"; })(f);
                   InUrdf([](UrdfModel& m) {
                     UrdfLink& base = m.links[0];
                     std::get<UrdfMeshFile>(base.visuals[0].geometry).filename = kLeafMesh;
                     std::get<UrdfMeshFile>(base.collisions[0].geometry).filename =
                         "meshes/collision/leaf_0.obj";
                   })(f);
                 },
                 "2 times"});
  // a name that no file system takes, where the visual mesh should be
  all.push_back({"REC003",
                 {},
                 InJson([](Json& j) {
                   const Json file = {{"path", "meshes/" + std::string(300, 'a')},
                                      {"sha256", std::string(64, 'a')}};
                   Json visual = file;
                   visual["materials"] = file;
                   visual["textures"] = Json::array();
                   j["links"][0]["geometry"][0]["visual"] = visual;
                 }),
                 "could not be checked"});
  const auto named = [](const std::function<Json&(Json&)>& id, const char* name) {
    return InJson([=](Json& j) { id(j) = name; });
  };
  all.push_back({"REC004", {}, named([](Json& j) -> Json& { return j["id"]; }, "/etc"), "/etc"});
  all.push_back({"REC004", {}, named([](Json& j) -> Json& { return j["id"]; }, ""), "the id \"\""});
  all.push_back(
      {"REC004", {}, named([](Json& j) -> Json& { return j["body"]["id"]; }, "../x"), "../x"});
  all.push_back(
      {"REC004",
       {},
       named([](Json& j) -> Json& { return j["links"][1]["geometry"][0]["name"]; }, "-rf"),
       "-rf"});
  all.push_back({"MSH001", {}, [](const fs::path& f) { fs::remove(f / kLeafMesh); }, "missing"});
  all.push_back({"MSH002",
                 {},
                 [](const fs::path& f) { CommitFile(f / kLeafMesh, "v 0 nan 0\n"); },
                 "leaf.obj:1"});
  all.push_back({"MSH002",
                 {},
                 [](const fs::path& f) {
                   CommitFile(f / kLeafMesh, "v 0 0 0\nv 1 0 0\nv 0 -343598 0\nf 1 2 3\n");
                 },
                 "leaf.obj:3: a vertex at (0, -343598, 0) m, allowed are coordinates up to 100 m"});
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

void AddMutationsOfMeshes(std::vector<BrokenDoor>& all) {
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

void AddMutationsOfMass(std::vector<BrokenDoor>& all) {
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

void AddMutationsOfMechanics(std::vector<BrokenDoor>& all) {
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

void AddMutationsOfUrdf(std::vector<BrokenDoor>& all) {
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
                   UrdfShape shape = m.links[1].visuals[0];
                   std::get<UrdfMeshFile>(shape.geometry).filename = "../leaf.obj";
                   m.links[1].visuals.push_back(shape);
                 }),
                 "../leaf.obj"});
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

void SetGrip(DoorAsset& d, const TriangleMesh& neck, const TriangleMesh& bar) {
  Grip(d).mesh = SideBySide(neck, bar);
  Grip(d).hulls = {neck, bar};
}

void AddMutationsOfStance(std::vector<BrokenDoor>& all) {
  all.push_back({"HND009",
                 [](DoorAsset& d) {
                   SetGrip(d, BoxOf({0, -0.008, -0.008}, {0.121, 0.008, 0.008}),
                           BoxOf({0.12, -0.12, -0.01}, {0.132, 0.01, 0.01}));
                   d.handle_from_grasp.translation().x() = 0.126;
                 },
                 {},
                 "0.132 m"});
  all.push_back({"HND010", [](DoorAsset& d) { MoveHandle(d, {0.02, 0, 0}); }, {}, "0.02 m"});
  all.push_back({"HND011",
                 [](DoorAsset& d) {
                   // 30 degrees out of the leaf's plane
                   TriangleMesh bar = BoxOf({0.03, -0.12, -0.01}, {0.042, 0.01, 0.01});
                   for (Eigen::Vector3d& vertex : bar.vertices)
                     vertex.x() += std::tan(0.5236) * (0.01 - vertex.y()) / 1.1;
                   SetGrip(d, Grip(d).hulls[0], bar);
                   d.handle_from_grasp.translation().x() += std::tan(0.5236) * 0.08 / 1.1 - 0.01;
                 },
                 {},
                 "degrees"});
}

void AddMutationsOfHandle(std::vector<BrokenDoor>& all) {
  all.push_back({"HND001",
                 [](DoorAsset& d) {
                   MoveHandle(d, {-0.045, 0, 0});
                 },
                 {},
                 "% of the surface"});
  all.push_back({"HND002",
                 [](DoorAsset& d) {
                   const TriangleMesh plate = BoxOf({0, -0.12, -0.01}, {0.004, 0.01, 0.01});
                   d.links[kHandleLink].geometry.clear();
                   d.links[kHandleLink].mass = {};
                   AddGeometry({"grip", plate, {plate}, {1, 1, 1, 1}, PointLabel::kHandle}, 7000,
                               d.links[kHandleLink]);
                   d.handle_from_grasp.translation().x() = 0.002;
                 },
                 {},
                 "0.004 m"});
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
                 "-0.5"});
  all.push_back({"HND006", [](DoorAsset& d) { MoveHandle(d, {-0.036, 0, 0}); }, {}, "0.001 m"});
  all.push_back({"HND007",
                 [](DoorAsset& d) {
                   const TriangleMesh plate = BoxOf({0.04, -0.12, -0.04}, {0.052, 0.01, 0.04});
                   Grip(d).mesh = SideBySide(Grip(d).hulls[0], plate);
                   Grip(d).hulls[1] = plate;
                 },
                 {},
                 "0.08 m"});
  all.push_back({"HND008",
                 [](DoorAsset& d) {
                   const TriangleMesh block = BoxOf({0.02, 0.63, 0.855}, {0.06, 0.67, 0.87});
                   AddGeometry({"rose", block, {block}, {1, 1, 1, 1}, PointLabel::kHandle}, 7000,
                               d.links[kLeafLink]);
                 },
                 {},
                 "way not free"});
  AddMutationsOfStance(all);
  all.push_back({"LIC001", [](DoorAsset& d) { d.license.clear(); }, {}, "empty"});
  all.push_back({"LIC002", [](DoorAsset& d) { d.license = "NOASSERTION"; }, {}, "NOASSERTION"});
}

}  // namespace

std::vector<BrokenDoor> BrokenDoors() {
  std::vector<BrokenDoor> all;
  AddMutationsOfFiles(all);
  AddMutationsOfMeshes(all);
  AddMutationsOfMass(all);
  AddMutationsOfMechanics(all);
  AddMutationsOfUrdf(all);
  AddMutationsOfHandle(all);
  return all;
}

fs::path ValidationFolder(const std::string& name) { return ScratchFolder("validate") / name; }

fs::path Written(const DoorAsset& door, const std::string& name) {
  fs::remove_all(ValidationFolder(name));  // an earlier run's may be no door by now
  WriteDoorFolder(door, ValidationFolder(name), Existing::kRefuse);
  return ValidationFolder(name);
}

fs::path Written(const BrokenDoor& broken, const std::string& name) {
  DoorAsset door = BoxDoor();
  if (broken.edit_door) broken.edit_door(door);
  fs::path folder = Written(door, name);
  if (broken.edit_folder) broken.edit_folder(folder);
  return folder;
}

}  // namespace doorforge
