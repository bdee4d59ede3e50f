// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/urdf.h"

#include <ctime>
#include <numbers>

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// A door of two links with every kind of shape and joint that the writer knows.
UrdfModel EveryKind() {
  UrdfModel model;
  model.name = "every kind";
  UrdfLink base;
  base.name = "base";
  base.visuals.push_back({"shell", FromXyzRpy({0.1, -0.2, 1.0 / 3}, {0.1, -0.7, 2.5}),
                          UrdfMeshFile{"meshes/visual/shell.obj", {1, 2, 3}},
                          Eigen::Vector4d(0.1, 0.2, 0.3, 1)});
  base.collisions.push_back({"", RigidTransform::Identity(), UrdfBox{{0.1, 0.2, 0.3}}, {}});
  UrdfLink leaf;
  leaf.name = "leaf";
  leaf.inertial.emplace();
  leaf.inertial->mass_kg = 12.5;
  leaf.inertial->center_of_mass_m = {0.01, 0.4, 1.0 / 7};
  leaf.inertial->inertia_kg_m2 << 2, 0.1, 0.2, 0.1, 3, 0.3, 0.2, 0.3, 4;
  leaf.collisions.push_back(
      {"bar", Translation({0, 0, 1}), UrdfCylinder{0.01, std::numbers::pi}, {}});
  UrdfLink knob;
  knob.name = "knob";
  knob.collisions.push_back({"ball", Translation({0, 0, 1}), UrdfSphere{0.03}, {}});
  UrdfLink slider;
  slider.name = "slider";
  model.links = {base, leaf, knob, slider};

  UrdfJoint hinge;
  hinge.name = "hinge";
  hinge.type = UrdfJointType::kRevolute;
  hinge.parent = "base";
  hinge.child = "leaf";
  hinge.parent_from_joint = FromXyzRpy({0, -0.4, 0}, {0, 0, 0.5});
  hinge.axis = {0, 0, -1};
  hinge.upper = 1.5;
  hinge.effort = 200;
  hinge.velocity = 2.0 / 3;
  hinge.damping = 0.5;
  UrdfJoint turn = hinge;
  turn.name = "turn";
  turn.type = UrdfJointType::kContinuous;
  turn.parent = "leaf";
  turn.child = "knob";
  turn.upper = 0;
  turn.damping = 0;
  turn.mimic = UrdfMimic{"hinge", -1, 0.25};
  UrdfJoint slide = hinge;
  slide.name = "slide";
  slide.type = UrdfJointType::kPrismatic;
  slide.parent = "base";
  slide.child = "slider";
  slide.lower = -1;
  model.joints = {hinge, turn, slide};
  return model;
}

void ExpectSame(const RigidTransform& a, const RigidTransform& b) {
  EXPECT_TRUE(a.matrix().isApprox(b.matrix(), 1e-12)) << a.matrix() << "\n" << b.matrix();
}

TEST(Urdf, WhatIsWrittenReadsBackTheSame) {
  const UrdfModel model = EveryKind();
  const UrdfModel back = ParseUrdf(ToUrdf(model), "test");
  EXPECT_EQ(back.name, model.name);
  ASSERT_EQ(back.links.size(), model.links.size());
  ASSERT_EQ(back.joints.size(), model.joints.size());
  const UrdfShape& shell = back.links[0].visuals.at(0);
  EXPECT_EQ(shell.name, "shell");
  ExpectSame(shell.link_from_shape, model.links[0].visuals[0].link_from_shape);
  EXPECT_EQ(std::get<UrdfMeshFile>(shell.geometry).filename, "meshes/visual/shell.obj");
  EXPECT_EQ(std::get<UrdfMeshFile>(shell.geometry).scale, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(*shell.color_rgba, Eigen::Vector4d(0.1, 0.2, 0.3, 1));
  EXPECT_EQ(std::get<UrdfBox>(back.links[0].collisions.at(0).geometry).size_m.z(), 0.3);
  EXPECT_EQ(std::get<UrdfCylinder>(back.links[1].collisions.at(0).geometry).length_m,
            std::numbers::pi);
  EXPECT_EQ(back.links[1].inertial->center_of_mass_m, model.links[1].inertial->center_of_mass_m);
  EXPECT_EQ(back.links[1].inertial->inertia_kg_m2, model.links[1].inertial->inertia_kg_m2);
  EXPECT_EQ(back.joints[0].velocity, 2.0 / 3);
  EXPECT_EQ(back.joints[0].damping, 0.5);
  EXPECT_EQ(back.joints[1].type, UrdfJointType::kContinuous);
  EXPECT_EQ(back.joints[1].mimic->offset, 0.25);
  EXPECT_EQ(back.joints[2].lower, -1);
  EXPECT_EQ(ToUrdf(back), ToUrdf(ParseUrdf(ToUrdf(back), "again")));
}

TEST(Urdf, UrdfdomReadsWhatIsWritten) {
  const UrdfModel model = EveryKind();
  const urdf::ModelInterfaceSharedPtr other = urdf::parseURDF(ToUrdf(model));
  ASSERT_NE(other, nullptr);
  EXPECT_EQ(other->getRoot()->name, RootLinkOf(model));
  const auto hinge = other->getJoint("hinge");
  ASSERT_NE(hinge, nullptr);
  EXPECT_EQ(hinge->type, urdf::Joint::REVOLUTE);
  EXPECT_NEAR(hinge->limits->upper, 1.5, 1e-5);
  EXPECT_NEAR(hinge->axis.z, -1, 1e-5);
  const auto leaf = other->getLink("leaf");
  EXPECT_NEAR(leaf->inertial->mass, 12.5, 1e-5);
  EXPECT_NEAR(leaf->inertial->iyz, 0.3, 1e-5);
  // roll, pitch and yaw in the order that everyone else understands
  const urdf::Pose& pose = other->getLink("base")->visual->origin;
  const Eigen::Quaterniond ours(model.links[0].visuals[0].link_from_shape.linear());
  const Eigen::Quaterniond theirs(pose.rotation.w, pose.rotation.x, pose.rotation.y,
                                  pose.rotation.z);
  EXPECT_LT(ours.angularDistance(theirs), 1e-5);
}

TEST(Urdf, AgreesWithUrdfdomOnAFileWithNamedMaterialsAndTurnedInertia) {
  const std::string text = R"(<?xml version="1.0"?>
<!-- a comment may say <!DOCTYPE> -->
<robot name="r">
  <material name="steel"><color rgba="0.5 0.5 0.6 1"/></material>
  <link name="a">
    <inertial><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><mass value="+2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></inertial>
    <visual><geometry><sphere radius="1e-1"/></geometry><material name="steel"/></visual>
  </link>
  <gazebo/>
</robot>)";
  const UrdfModel model = ParseUrdf(text, "test");
  const urdf::ModelInterfaceSharedPtr other = urdf::parseURDF(text);
  ASSERT_NE(other, nullptr);
  EXPECT_EQ(model.name, other->getName());
  EXPECT_NEAR((*model.links[0].visuals[0].color_rgba)[2],
              other->getLink("a")->visual->material->color.b, 1e-6);
  // a quarter turn about z swaps the inertias about x and y
  EXPECT_NEAR(model.links[0].inertial->inertia_kg_m2(0, 0), 2, 1e-12);
  EXPECT_NEAR(model.links[0].inertial->inertia_kg_m2(1, 1), 1, 1e-12);
  EXPECT_EQ(model.links[0].inertial->mass_kg, other->getLink("a")->inertial->mass);
}

// The message of the error that reading `text` gives; empty if it reads.
std::string ProblemOf(const std::string& text) {
  try {
    RootLinkOf(ParseUrdf(text, "door.urdf"));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    return error.what();
  }
  return {};
}

TEST(Urdf, RefusesWhatCouldHarmAndSaysWhere) {
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(contains(ProblemOf("<?xml version='1.0'?>\n<!DOCTYPE robot [<!ENTITY a 'b'>]>\n"
                                 "<robot><link name='a'/></robot>"),
                       "door.urdf:2: a DOCTYPE"));
  EXPECT_TRUE(contains(ProblemOf("<robot>\n<link name='a'>"), "not well-formed"));
  EXPECT_TRUE(contains(ProblemOf(""), "not well-formed"));
  EXPECT_TRUE(contains(ProblemOf("<sdf/>"), "not <robot>"));
  EXPECT_TRUE(contains(ProblemOf("<robot name='r'/>"), "no <link>"));
  EXPECT_TRUE(contains(ProblemOf("<robot>\n\n<link/></robot>"), "door.urdf:3"));
  EXPECT_TRUE(contains(ProblemOf("<robot><link name='a'/><link name='a'/></robot>"), "second one"));
  const std::string two = "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='";
  const std::string ends = "'><parent link='a'/><child link='b'/>";
  EXPECT_TRUE(contains(ProblemOf(two + "floating" + ends + "</joint></robot>"), "floating"));
  EXPECT_TRUE(contains(ProblemOf(two + "revolute" + ends + "<axis xyz='0 0 nan'/></joint></robot>"),
                       "door.urdf:2: <axis> of joint \"j\": xyz=\"0 0 nan\""));
  EXPECT_TRUE(contains(ProblemOf(two + "revolute" + ends + "<axis xyz='0 0 0'/></joint></robot>"),
                       "axis of zero length"));
  EXPECT_TRUE(
      contains(ProblemOf(two + "fixed'><parent link='a'/><child link='c'/></joint></robot>"),
               "\"c\", which does not exist"));
  EXPECT_EQ(ProblemOf(two + "fixed" + ends + "</joint></robot>"), "");
  std::string deep = "<robot><link name='a'>";
  for (int i = 0; i < 70; ++i) deep += "<x>";
  for (int i = 0; i < 70; ++i) deep += "</x>";
  EXPECT_TRUE(contains(ProblemOf(deep + "</link></robot>"), "64 levels"));
  EXPECT_TRUE(contains(ProblemOf(std::string(17 << 20, ' ')), "16 MiB"));
}

// Found by fuzzing: what is no comment to the parser hides the declaration behind it from the first
// look, and the second one read behind the text.
TEST(Urdf, ATextThatEndsInTheMiddleOfADeclarationIsRefused) {
  for (const std::string text : {R"(<robot name="<!--"/><!)", R"(<robot name="<!--"/><!-)", "<!"})
    EXPECT_THROW(ParseUrdf(text, "cut.urdf"), Error) << text;
}

TEST(Urdf, RefusesLinksThatAreNotOneTree) {
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child) {
    return "<joint name='" + name + "' type='fixed'><parent link='" + parent + "'/><child link='" +
           child + "'/></joint>";
  };
  const std::string links = "<robot><link name='a'/><link name='b'/><link name='c'/>";
  EXPECT_NE(ProblemOf(links + joint("1", "a", "b") + "</robot>"), "");
  EXPECT_NE(ProblemOf(links + joint("1", "b", "c") + joint("2", "c", "b") + "</robot>"), "");
  EXPECT_NE(ProblemOf(links + joint("1", "a", "b") + joint("2", "c", "b") + "</robot>"), "");
  EXPECT_EQ(ProblemOf(links + joint("1", "a", "b") + joint("2", "b", "c") + "</robot>"), "");
}

// In MJCF each body names the one around it: eight megabytes of a name, two thousand times.
TEST(Urdf, RefusesANameOfManyBytes) {
  const auto robot = [](std::size_t bytes) {
    return "<robot name='r'><link name='" + std::string(bytes, 'a') + "'/></robot>";
  };
  EXPECT_NO_THROW(ParseUrdf(robot(1024), "r.urdf"));
  EXPECT_THROW(ParseUrdf(robot(1025), "r.urdf"), Error);
}

TEST(Urdf, RefusesMoreLinksOrJointsThanAnyObjectHas) {
  std::string links;
  for (int i = 0; i < 2000; ++i) links += "<link name='" + std::to_string(i) + "'/>";
  EXPECT_EQ(ParseUrdf("<robot>" + links + "</robot>", "a.urdf").links.size(), 2000U);
  EXPECT_NE(ProblemOf("<robot>" + links + "<link name='x'/></robot>")
                .find("<link>: more than the 2000 allowed"),
            std::string::npos);
  std::string joints;
  for (int i = 0; i < 2001; ++i)
    joints += "<joint name='" + std::to_string(i) +
              "' type='fixed'><parent link='a'/><child link='b'/></joint>";
  EXPECT_NE(ProblemOf("<robot><link name='a'/><link name='b'/>" + joints + "</robot>")
                .find("<joint>: more than the 2000 allowed"),
            std::string::npos);
}

// A walk up from every link would take some 10^10 steps.
TEST(Urdf, FindsTheRootOfALongChainInOnePass) {
  constexpr int kLinks = 100'000;
  UrdfModel model;
  for (int i = 0; i < kLinks; ++i) {
    model.links.push_back({.name = "link" + std::to_string(i)});
    if (i == 0) continue;
    UrdfJoint& joint = model.joints.emplace_back();
    joint.parent = model.links[static_cast<std::size_t>(i) - 1].name;
    joint.child = model.links.back().name;
  }
  const std::clock_t begin = std::clock();
  EXPECT_EQ(RootLinkOf(model), "link0");
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10);
}

}  // namespace
}  // namespace doorforge
