// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/compose/compose.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/schemas/door_words.h"
#include "doorforge/schemas/glb.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mjcf.h"
#include "doorforge/schemas/sdf.h"
#include "doorforge/schemas/urdf.h"
#include "doorforge/schemas/usda.h"

#include "scratch_folder.h"

// What is exported is read again and compared with the door, which has never seen the formats.

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct ReadFormat {
  const char* name;
  const char* file;
  UrdfModel (*read)(const fs::path& path, std::vector<UrdfFault>& faults);
  bool has_effort;  // MJCF and USD have no word for it
  bool has_hulls;   // glTF has none
  bool has_mimic;   // nor has it a bolt, and MJCF has a tendon
};

const ReadFormat kFormats[] = {
    {"urdf", "model.urdf",
     [](const fs::path& path, std::vector<UrdfFault>& faults) { return ReadUrdf(path, faults); },
     true, true, true},
    {"mjcf", "model.xml", ReadMjcf, false, true, false},
    {"sdf", "model.sdf", ReadSdf, true, true, true},
    {"glb", "model.glb", ReadGlb, true, false, false},
    {"usda", "model.usda", ReadUsda, false, true, true}};

const UrdfLink* LinkNamed(const UrdfModel& model, const std::string& name) {
  for (const UrdfLink& link : model.links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

const UrdfJoint* JointNamed(const UrdfModel& model, const std::string& name) {
  for (const UrdfJoint& joint : model.joints) {
    if (joint.name == name) return &joint;
  }
  return nullptr;
}

void ExpectJoint(const DoorJoint& joint, const UrdfModel& model, const ReadFormat& format) {
  const bool turns = joint.upper_rad > joint.lower_rad;
  const UrdfJoint* found = nullptr;
  for (const UrdfJoint& each : model.joints) {
    if (each.name == joint.name || (!turns && each.child == "handle")) found = &each;
  }
  ASSERT_NE(found, nullptr) << joint.name;
  EXPECT_LT((found->parent_from_joint.matrix() - joint.parent_from_child_at_zero.matrix()).norm(),
            1e-9);
  if (!turns) {
    EXPECT_EQ(found->type, UrdfJointType::kFixed);
    return;
  }
  ASSERT_EQ(found->type, UrdfJointType::kRevolute);
  EXPECT_LT((found->axis - joint.axis).norm(), 1e-9);
  EXPECT_NEAR(found->lower, joint.lower_rad, 1e-9);
  EXPECT_NEAR(found->upper, joint.upper_rad, 1e-9);
  EXPECT_NEAR(found->damping, joint.damping_nm_s, 1e-9);
  if (!format.has_effort) return;
  EXPECT_NEAR(found->effort.value_or(-1), joint.effort_limit_nm, 1e-9);
  EXPECT_NEAR(found->velocity.value_or(-1), joint.velocity_limit_rad_s, 1e-9);
}

void ExpectMass(const DoorLink& link, const UrdfLink& found) {
  ASSERT_TRUE(found.inertial.has_value()) << link.name;
  EXPECT_NEAR(found.inertial->mass_kg, link.mass.mass_kg, 1e-6);
  EXPECT_LT((found.inertial->center_of_mass_m - link.mass.center_of_mass_m).norm(), 1e-6);
  EXPECT_LT((found.inertial->inertia_kg_m2 - link.mass.inertia_kg_m2).norm(), 1e-6);
}

// The largest distance of corresponding vertices.
double Difference(const TriangleMesh& a, const UrdfShape& shape, const fs::path& folder) {
  const auto* triangles = std::get_if<UrdfTriangles>(&shape.geometry);
  const TriangleMesh b = triangles != nullptr
                             ? triangles->mesh
                             : ReadObj(folder / std::get<UrdfMeshFile>(shape.geometry).filename);
  if (a.vertices.size() != b.vertices.size()) return 1e9;
  double worst = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    worst = std::max(worst, (shape.link_from_shape * b.vertices[i] - a.vertices[i]).norm());
  return worst;
}

void ExpectShapes(const DoorLink& link, const UrdfLink& found, const ReadFormat& format,
                  const fs::path& folder) {
  ASSERT_EQ(found.visuals.size(), link.geometry.size()) << link.name;
  for (std::size_t i = 0; i < link.geometry.size(); ++i)
    EXPECT_LT(Difference(link.geometry[i].mesh, found.visuals[i], folder), 1e-4) << link.name;
  if (link.name == "base" || !format.has_hulls) return;  // the mortise is cut out of the frame's
  std::size_t at = 0;
  for (const DoorGeometry& geometry : link.geometry) {
    for (const TriangleMesh& hull : geometry.hulls) {
      ASSERT_LT(at, found.collisions.size()) << link.name;
      EXPECT_LT(Difference(hull, found.collisions[at++], folder), 1e-4) << link.name;
    }
  }
  EXPECT_EQ(at, found.collisions.size()) << link.name;
}

void ExpectLatch(const Latch& latch, const Latch& found) {
  EXPECT_EQ(found.type, latch.type);
  EXPECT_EQ(found.unlock_angle_rad, latch.unlock_angle_rad);
  EXPECT_EQ(found.handle_done_angle_rad, latch.handle_done_angle_rad);
  EXPECT_EQ(found.lock_effort_nm, latch.lock_effort_nm);
  EXPECT_EQ(found.hinge_spring_nm_per_rad, latch.hinge_spring_nm_per_rad);
  EXPECT_EQ(found.handle_spring_nm_per_rad, latch.handle_spring_nm_per_rad);
  EXPECT_EQ(found.relatch, latch.relatch);
  EXPECT_EQ(found.unlocks_ajar, latch.unlocks_ajar);
  EXPECT_EQ(found.bolt_throw_m, latch.bolt_throw_m);
}

void ExpectReadsBack(const DoorAsset& door, const ReadFormat& format, const fs::path& folder) {
  SCOPED_TRACE(door.id + " in " + format.name);
  std::vector<UrdfFault> faults;
  const UrdfModel model = format.read(folder / format.file, faults);
  for (const UrdfFault& fault : faults)
    EXPECT_EQ(fault.kind, UrdfFaultKind::kUnstated) << fault.line << ": " << fault.text;
  EXPECT_EQ(model.name, door.id);
  EXPECT_EQ(RootLinkOf(model), "base");
  for (const DoorLink& link : door.links) {
    const UrdfLink* found = LinkNamed(model, link.name);
    ASSERT_NE(found, nullptr) << link.name;
    ExpectMass(link, *found);
    ExpectShapes(link, *found, format, folder);
  }
  ExpectJoint(door.hinge, model, format);
  ExpectJoint(door.handle_joint, model, format);
  const auto latch = LatchFromWords(model.words, format.file);
  ASSERT_TRUE(latch.has_value());
  ExpectLatch(door.latch, *latch);
  EXPECT_EQ(model.words.at("door_category"), NameOf(door.category));
  EXPECT_EQ(model.words.at("door_mechanism"), NameOf(door.mechanism));
  if (!format.has_mimic || door.handle_joint.upper_rad == 0) return;
  const UrdfJoint* bolt = JointNamed(model, "bolt_joint");
  ASSERT_NE(bolt, nullptr);
  ASSERT_TRUE(bolt->mimic.has_value());
  EXPECT_EQ(bolt->mimic->joint, "handle_joint");
  const double throw_m = door.latch.type == LatchType::kBolt ? door.latch.bolt_throw_m : 0.012;
  EXPECT_NEAR(bolt->mimic->multiplier * door.latch.unlock_angle_rad, -throw_m, 1e-12);
}

// One body and handle of each category and mechanism.
std::vector<DoorAsset> SomeDoors() {
  std::map<Category, CatalogueEntry> bodies;
  std::map<std::pair<Category, std::string>, CatalogueEntry> handles;
  for (const CatalogueEntry& entry : ListCatalogue(DataFolder())) {
    if (entry.role == PartRole::kBody)
      bodies.emplace(entry.category, entry);
    else
      handles.emplace(std::pair(entry.category, entry.id.substr(0, entry.id.rfind('_'))), entry);
  }
  std::vector<DoorAsset> doors;
  for (const auto& [key, handle] : handles) {
    if (doors.size() % 3 == 0 && doors.size() > 12) break;
    ComposeConfig config;
    if (doors.size() % 2 == 0) config.latch = LatchChoice::kBolt;
    if (doors.size() % 3 == 1) config.hinge_side = HingeSide::kRight;
    const bool can_be_pushed = key.first == Category::kInterior || key.first == Category::kWindow;
    if (doors.size() % 4 == 2 && can_be_pushed) config.opening = Opening::kPush;
    const Part body = BuildCataloguePart(bodies.at(key.first));
    try {
      doors.push_back(ComposeDoor(body, BuildCataloguePart(handle), config));
    } catch (const Error&) {
      config.latch = LatchChoice::kAuto;  // a plain pull has no bolt
      doors.push_back(ComposeDoor(body, BuildCataloguePart(handle), config));
    }
  }
  return doors;
}

TEST(RoundTrip, EveryFormatGivesTheDoorBack) {
  for (const DoorAsset& door : SomeDoors()) {
    const fs::path folder = ScratchFolder("round_trip") / door.id;
    WriteExportedDoor(door, DoorFormats(), folder, Existing::kReplace);
    for (const ReadFormat& format : kFormats) ExpectReadsBack(door, format, folder);
    fs::remove_all(folder);
  }
}

TEST(ReadMjcf, DefaultsDegreesAnchorsAndSeveralJoints) {
  std::vector<UrdfFault> faults;
  const UrdfModel model = ParseMjcf(R"(<mujoco model="m"><compiler eulerseq="XYZ"/>
    <default><joint damping="2"/><default class="stiff"><joint damping="5" axis="0 1 0"/></default></default>
    <worldbody><geom type="box" size="1 2 3"/><body name="a" pos="1 0 0" euler="0 0 90">
      <inertial pos="0 0 1" mass="2" diaginertia="1 2 3"/>
      <joint name="j" pos="0.5 0 0" range="0 90"/><joint name="k" class="stiff" type="slide" range="0 1"/>
      <geom type="box" size="0.1 0.2 0.3" pos="0 1 0" contype="0" conaffinity="0"/></body></worldbody>
    </mujoco>)",
                                    "m.xml", faults);
  EXPECT_TRUE(faults.empty());
  ASSERT_EQ(model.joints.size(), 2U);
  const UrdfJoint& j = model.joints[0];
  EXPECT_EQ(j.parent, "world");
  EXPECT_NEAR(j.upper, 1.5707963267948966, 1e-12);
  EXPECT_EQ(j.damping, 2);
  // the body's x is the world's y
  EXPECT_LT((j.parent_from_joint.translation() - Eigen::Vector3d(1, 0.5, 0)).norm(), 1e-12);
  const UrdfJoint& k = model.joints[1];
  EXPECT_EQ(k.type, UrdfJointType::kPrismatic);
  EXPECT_EQ(k.upper, 1);  // no angle
  EXPECT_EQ(k.damping, 5);
  EXPECT_EQ(k.axis, Eigen::Vector3d(0, 1, 0));
  EXPECT_LT((k.parent_from_joint.translation() - Eigen::Vector3d(-0.5, 0, 0)).norm(), 1e-12);
  const UrdfLink* a = LinkNamed(model, "a");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(a->visuals.at(0).link_from_shape.translation(), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(std::get<UrdfBox>(a->visuals[0].geometry).size_m, Eigen::Vector3d(0.2, 0.4, 0.6));
}

TEST(ReadSdf, PosesFollowTheirFrames) {
  std::vector<UrdfFault> faults;
  const UrdfModel model = ParseSdf(R"(<sdf version="1.9"><model name="m">
    <frame name="f" attached_to="base"><pose>0 0 2 0 0 0</pose></frame>
    <link name="base"><pose>1 0 0 0 0 0</pose></link>
    <link name="leaf"><pose relative_to="f">0 1 0 0 0 1.5707963267948966</pose>
      <visual name="v"><pose>0.25 0 0 0 0 0</pose><geometry><box><size>1 2 3</size></box></geometry></visual></link>
    <joint name="hinge" type="revolute"><pose>0.5 0 0 0 0 0</pose><parent>base</parent><child>leaf</child>
      <axis><xyz expressed_in="__model__">0 1 0</xyz><limit><lower>0</lower><upper>1</upper></limit></axis></joint>
    </model></sdf>)",
                                   "m.sdf", faults);
  EXPECT_TRUE(faults.empty());
  ASSERT_EQ(model.joints.size(), 1U);
  // leaf is at (1, 1, 2), its x along y; the joint half a metre along it
  EXPECT_LT((model.joints[0].parent_from_joint.translation() - Eigen::Vector3d(0, 1.5, 2)).norm(),
            1e-12);
  EXPECT_LT((model.joints[0].axis - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT(
      (model.links[1].visuals.at(0).link_from_shape.translation() - Eigen::Vector3d(-0.25, 0, 0))
          .norm(),
      1e-12);
}

TEST(ReadModels, HostileTextsEndWithinTheirLimits) {
  std::vector<UrdfFault> faults;
  std::string deep = "<mujoco><worldbody>";
  for (int i = 0; i < 100000; ++i) deep += "<body>";
  EXPECT_THROW(ParseMjcf(deep, "deep.xml", faults), Error);
  EXPECT_THROW(ParseMjcf("<!DOCTYPE x [<!ENTITY a \"b\">]><mujoco/>", "entity.xml", faults), Error);
  EXPECT_THROW(ParseSdf("<!DOCTYPE x><sdf/>", "entity.sdf", faults), Error);
  EXPECT_THROW(ParseSdf("<sdf><model name='a'/></sdf>", "empty.sdf", faults), Error);
  std::string many = "<sdf><model name='m'>";
  for (int i = 0; i < 2100; ++i) many += "<link name='l" + std::to_string(i) + "'/>";
  EXPECT_THROW(ParseSdf(many + "</model></sdf>", "many.sdf", faults), Error);
  faults.clear();
  ParseSdf(
      "<sdf><model name='m'><link name='a'><pose relative_to='b'/></link><link name='b'><pose "
      "relative_to='a'/>"
      "</link><joint name='j' type='ball'><parent>a</parent><child>c</child></joint></model></sdf>",
      "circle.sdf", faults);
  EXPECT_GE(faults.size(), 3U);  // two links in a circle, a ball joint, a link that is not there
  faults.clear();
  ParseMjcf(
      "<mujoco><worldbody><body name='a' quat='0 0 0 0'><joint axis='nan 0 1'/><geom "
      "mesh='none'/></body>"
      "<include file='x'/></worldbody></mujoco>",
      "wrong.xml", faults);
  EXPECT_GE(faults.size(), 4U);
}

std::string Glb(const std::string& json, const std::string& binary) {
  const auto number = [](std::size_t n) {
    std::string bytes(4, '\0');
    for (std::size_t k = 0; k < 4; ++k) bytes[k] = static_cast<char>(n >> (8 * k) & 255U);
    return bytes;
  };
  return "glTF" + number(2) + number(28 + json.size() + binary.size()) + number(json.size()) +
         "JSON" + json + number(binary.size()) + std::string("BIN\0", 4) + binary;
}

TEST(ReadGlb, WhatLeadsOutOfTheFileIsRefused) {
  const std::string link =
      R"("nodes":[{"name":"a","mesh":0,"extras":{"joint":1,"mass":{"mass_kg":1,"center_of_mass_m":[0,0,0],
      "inertia_xx_yy_zz_kg_m2":[1,1,1],"inertia_xy_xz_yz_kg_m2":[0,0,0]}}}])";
  const auto refused = [](const std::string& json, const std::string& binary) {
    try {
      ParseGlb(Glb(json, binary), "a.glb");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  const std::string head = R"({"scenes":[{"nodes":[0]}],)";
  EXPECT_NE(refused(head + link + "}", ""), "taken");  // a joint that is a number
  const std::string mass =
      link.substr(0, link.find(R"("joint":1,)")) + link.substr(link.find(R"("joint":1,)") + 10);
  const auto mesh = [&](const std::string& accessors, const std::string& views) {
    return refused(
        head + mass +
            R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)" +
            accessors + R"(],"bufferViews":[)" + views + "]}",
        std::string(48, '\0'));
  };
  const std::string points = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";
  const std::string order = R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"})";
  const std::string views =
      R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12})";
  EXPECT_EQ(mesh(points + "," + order, views), "taken");
  EXPECT_NE(
      mesh(R"({"bufferView":0,"componentType":5126,"count":4000000000000000000})" + ("," + order),
           views),
      "taken");
  EXPECT_NE(
      mesh(R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)" + order, views),
      "taken");
  EXPECT_NE(
      mesh(R"({"bufferView":0,"componentType":5126,"count":3,"byteOffset":18446744073709551608},)" +
               order,
           views),
      "taken");
  EXPECT_NE(mesh(points + "," + order,
                 R"({"buffer":0,"byteOffset":40,"byteLength":36},{"buffer":0,"byteLength":3})"),
            "taken");
  EXPECT_NE(mesh(points + "," + order,
                 R"({"buffer":0,"byteLength":36,"byteStride":100000},{"buffer":0,"byteLength":3})"),
            "taken");
  EXPECT_NE(mesh(points + R"(,{"bufferView":1,"componentType":5126,"count":3})", views), "taken");
  EXPECT_NE(refused(R"({"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}]})", ""), "taken");
  EXPECT_NE(refused(R"({"scenes":[{"nodes":[7]}],"nodes":[]})", ""), "taken");
  EXPECT_NE(refused(R"({"scenes":7,"nodes":{}})", ""), "taken");
  EXPECT_NE(refused("[" + std::string(100000, '['), ""), "taken");
  EXPECT_THROW(ParseGlb("glTF", "short.glb"), Error);
}

TEST(ReadUsda, WorldsOfOthersBecomeOneTreeInMetresWithZUp) {
  std::vector<UrdfFault> faults;
  const UrdfModel model = ParseUsdaModel(R"(#usda 1.0
(
    metersPerUnit = 0.01
    upAxis = "Y"
)
def Xform "a" (prepend apiSchemas = ["PhysicsRigidBodyAPI"])
{
    double3 xformOp:translate = (100, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Cube "block"
    {
        double size = 2
        double3 xformOp:scale = (10, 20, 30)
        uniform token[] xformOpOrder = ["xformOp:scale"]
    }
}
def Xform "b" (prepend apiSchemas = ["PhysicsRigidBodyAPI"])
{
    double3 xformOp:translate = (100, 50, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
def PhysicsRevoluteJoint "hinge"
{
    rel physics:body0 = </a>
    rel physics:body1 = </b>
    point3f physics:localPos0 = (0, 40, 0)
    point3f physics:localPos1 = (0, -10, 0)
    uniform token physics:axis = "Y"
    float physics:lowerLimit = 0
    float physics:upperLimit = 90
    float drive:angular:physics:damping = 2
}
)",
                                         "m.usda", faults);
  for (const UrdfFault& fault : faults) ADD_FAILURE() << fault.text;
  EXPECT_EQ(RootLinkOf(model), "world");
  const UrdfJoint* hinge = JointNamed(model, "hinge");
  ASSERT_NE(hinge, nullptr);
  EXPECT_LT((hinge->parent_from_joint.translation() - Eigen::Vector3d(0, 0.4, 0)).norm(), 1e-12);
  EXPECT_LT((hinge->axis - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(hinge->upper, 1.5707963267948966, 1e-12);
  EXPECT_NEAR(hinge->damping, 2 * 57.29577951308232, 1e-9);
  const UrdfJoint* root = JointNamed(model, "a_to_world");
  ASSERT_NE(root, nullptr);
  // the stage's y is up: its z points to the world's -y
  EXPECT_LT(
      (root->parent_from_joint * Eigen::Vector3d(0, 0.4, 0) - Eigen::Vector3d(1, 0, 0.4)).norm(),
      1e-12);
  const UrdfLink* a = LinkNamed(model, "a");
  ASSERT_NE(a, nullptr);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex :
       std::get<UrdfTriangles>(a->visuals.at(0).geometry).mesh.vertices)
    box.extend(vertex);
  EXPECT_LT((box.sizes() - Eigen::Vector3d(0.2, 0.4, 0.6)).norm(), 1e-12);
}

}  // namespace
}  // namespace doorforge
