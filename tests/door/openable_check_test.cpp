// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/openable/openable_check.h"

#include <functional>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/compose/compose.h"
#include "doorforge/exporters/export_urdf.h"

#include "box_door.h"
#include "scratch_folder.h"
#include "small_parts.h"

namespace doorforge {
namespace {

std::set<std::string> CodesOf(const std::vector<Finding>& findings) {
  std::set<std::string> codes;
  for (const Finding& finding : findings) codes.insert(finding.code);
  return codes;
}

std::string Describe(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += finding.code + " " + finding.where + ": " + finding.measured + "\n";
  return text;
}

/// A good door broken in one way.
struct Mutation {
  std::string code;
  std::function<void(DoorAsset&)> edit;
  std::string measured;  ///< Part of the finding's `measured`.
};

void AddFrame(const std::string& name, const TriangleMesh& box, DoorAsset& door) {
  AddGeometry({name, box, {box}, {1, 1, 1, 1}, PointLabel::kFrame}, 400, door.links[kBaseLink]);
}

std::vector<Mutation> AllMutations() {
  return {
      {"SWP001",
       [](DoorAsset& d) {
         AddFrame("stopper", BoxOf({0.3, 0.5, 0.4}, {0.35, 0.55, 0.6}), d);
       },
       "rad, handle 0 rad"},
      {"SWP002",
       [](DoorAsset& d) {
         AddFrame("rebate", BoxOf({-0.08, 0.7, 0.2}, {-0.02, 0.9, 1.6}), d);
       },
       "0.02 m at hinge 0 rad"},
      {"SWP003",
       [](DoorAsset& d) {  // the open leaf's back comes to y = 0.0075
         AddFrame("jamb", BoxOf({0.02, -0.05, 0.2}, {0.08, 0.02, 1.6}), d);
       },
       "handle 0 rad"},
      {"OPN001", [](DoorAsset& d) { d.latch.lock_effort_nm = 40; }, " rad"},
      {"OPN002", [](DoorAsset& d) { d.latch.handle_spring_nm_per_rad = 20; }, "handle at 0.3"},
      {"OPN003", [](DoorAsset& d) { d.latch.handle_spring_nm_per_rad = 0; }, " rad"},
      {"OPN004", [](DoorAsset& d) { d.latch.hinge_spring_nm_per_rad = 100; }, "after 10 s"},
      {"OPN005",
       [](DoorAsset& d) {
         d.links[kHandleLink].geometry[0].hulls[1] =
             BoxOf({0.04, -0.12, -0.05}, {0.052, 0.01, 0.05});
       },
       ""},
      {"OPN006", [](DoorAsset& d) { d.latch.handle_spring_nm_per_rad = 1e9; }, "diverged"},
      {"OPN007", [](DoorAsset& d) { d.latch.relatch = d.latch.unlocks_ajar = true; }, "choose"},
  };
}

TEST(OpenableCheck, FindsNothingAtAGoodDoor) {
  const std::vector<Finding> findings = OpenableCheck()(BoxDoor());
  EXPECT_TRUE(findings.empty()) << Describe(findings);
}

TEST(OpenableCheck, RaisesExactlyTheRuleThatAFaultBreaks) {
  const DoorValidator validator{OpenableCheck()};
  std::set<std::string> mutated;
  for (const Mutation& mutation : AllMutations()) {
    SCOPED_TRACE(mutation.code);
    DoorAsset door = BoxDoor();
    mutation.edit(door);
    const auto folder = ScratchFolder("openable") / mutation.code;
    WriteDoorFolder(door, folder, Existing::kReplace);
    const ValidationReport report = validator.Validate(folder);
    EXPECT_EQ(CodesOf(report.findings), std::set<std::string>{mutation.code})
        << Describe(report.findings);
    for (const Finding& finding : report.findings)
      EXPECT_NE(finding.measured.find(mutation.measured), std::string::npos) << finding.measured;
    mutated.insert(mutation.code);
  }
  std::set<std::string> rules;
  for (const ValidationRule& rule : ValidationRules()) {
    if (rule.code.starts_with("SWP") || rule.code.starts_with("OPN"))
      rules.insert(std::string(rule.code));
  }
  EXPECT_EQ(mutated, rules);
}

TEST(OpenableCheck, TellsCollisionShapesThatStandInTheWayFromMeshesThatDo) {
  DoorAsset door = BoxDoor();
  AddFrame("jamb", BoxOf({0.02, -0.05, 0.2}, {0.08, 0.005, 1.6}), door);
  EXPECT_TRUE(OpenableCheck()(door).empty());
  door.links[kBaseLink].geometry.back().hulls = {BoxOf({0.02, -0.05, 0.2}, {0.08, 0.02, 1.6})};
  EXPECT_EQ(CodesOf(OpenableCheck()(door)), std::set<std::string>{"SWP001"});
}

TEST(OpenableCheck, TriesABoltAsItDoesAnEffort) {
  DoorAsset door = BoxDoor();
  door.latch.type = LatchType::kBolt;
  door.latch.bolt_throw_m = 0.012;
  const std::vector<Finding> findings = OpenableCheck()(door);
  EXPECT_TRUE(findings.empty()) << Describe(findings);
  door.latch.handle_spring_nm_per_rad = 20;  // the hand cannot draw the bolt back
  EXPECT_EQ(CodesOf(OpenableCheck()(door)), std::set<std::string>{"OPN002"});
}

TEST(OpenableCheck, TriesDoorsOfEverySideAndOpening) {
  const OpenableCheck check;
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      SCOPED_TRACE(std::string(NameOf(side)) + " " + std::string(NameOf(opening)));
      ComposeConfig config;
      config.hinge_side = side;
      config.opening = opening;
      DoorAsset door = ComposeDoor(SmallBody(), SmallLever(), config);
      for (const Finding& finding : check(door)) EXPECT_NE(finding.code.substr(0, 3), "OPN");
      door.latch.lock_effort_nm = 1;
      EXPECT_TRUE(CodesOf(check(door)).contains("OPN001"));
    }
  }
}

}  // namespace
}  // namespace doorforge
