// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Objects of other people, from shared/assets beside the checkout; skipped without them.

#include <array>
#include <cstdlib>
#include <map>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "doorforge/compose/compose.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/importers/author_place.h"
#include "doorforge/importers/foreign_object.h"
#include "doorforge/importers/import_objects.h"

#include "small_object.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class ForeignAssets : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path shared = fs::path(DOORFORGE_SOURCE_DIR).parent_path() / "shared/assets";
    if (!fs::exists(shared / "unpack.sh"))
      GTEST_SKIP() << "no real assets beside the checkout (" << shared << ")";
    root_ = fs::path(DOORFORGE_BINARY_DIR) / "real_assets";
    const std::string command = "bash '" + (shared / "unpack.sh").string() + "' '" +
                                root_.string() + "' partnet_mobility loose_parts unidoormanip";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  fs::path root_;
};

// A joint of a URDF, read as plain text: nothing of the importer is in it.
struct TextJoint {
  std::string child;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double lower = 0;
  double upper = 0;
};

std::string Find(const std::string& text, const std::string& pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

Eigen::Vector3d VectorOf(const std::string& text) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  std::istringstream(text) >> v.x() >> v.y() >> v.z();
  return v;
}

// by the child's name
std::map<std::string, TextJoint> JointsOf(const fs::path& urdf) {
  const std::string text = ReadFile(urdf);
  std::map<std::string, TextJoint> joints;
  for (std::size_t at = 0; (at = text.find("<joint", at)) != std::string::npos; ++at) {
    const std::string block = text.substr(at, text.find("</joint>", at) - at);
    TextJoint joint;
    joint.child = Find(block, "<child link=\"([^\"]*)\"");
    joint.origin = VectorOf(Find(block, "<origin[^>]*xyz=\"([^\"]*)\""));
    joint.axis = VectorOf(Find(block, "<axis[^>]*xyz=\"([^\"]*)\""));
    joint.lower = std::atof(Find(block, "lower=\"([^\"]*)\"").c_str());
    joint.upper = std::atof(Find(block, "upper=\"([^\"]*)\"").c_str());
    joints[joint.child] = joint;
  }
  return joints;
}

Part Unrepaired(const PartDraft& draft) {
  Part part = draft.facts;
  for (const RawPiece& raw : draft.pieces) {
    PartPiece piece;
    piece.name = raw.name;
    piece.mesh = raw.mesh;
    piece.mass = {1, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    part.pieces.push_back(piece);
  }
  return part;
}

// Where a door's lines lie as the source states them, in metres.
struct SourceLine {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
};

// link axes (x along the door, y up, z out) -> ours; a door that opens away from its own front is
// turned round, a mirrored one's y is reversed
SourceLine Ours(const ForeignObject& object, const Eigen::Vector3d& point,
                const Eigen::Vector3d& direction) {
  const double facing = object.name.find("8877") == std::string::npos ? 1 : -1;
  const auto turn = [&](const Eigen::Vector3d& v) {
    return Eigen::Vector3d(facing * v.z(), facing * (object.mirrored ? -v.x() : v.x()), v.y());
  };
  return {object.scale * turn(point), turn(direction).normalized()};
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

double Distance(const SourceLine& line, const Eigen::Vector3d& point) {
  return (point - line.point).cross(line.direction).norm();
}

// of a line, turned by the angle at which the source's limits shut an ajar leaf
SourceLine Shut(const TextJoint& hinge, double angle, const SourceLine& line) {
  const Eigen::AngleAxisd turn(angle, hinge.axis.normalized());
  return {turn * (line.point - hinge.origin) + hinge.origin, turn * line.direction};
}

// a part stands on the floor, the source's origin lies in its middle
double LiftOf(const PartDraft& body, const SourceLine& hinge) {
  return body.facts.joint.origin_m.z() - hinge.point.z();
}

void ExpectAxesOf(const ForeignObject& object, const TextJoint& hinge, const TextJoint* knob) {
  const PartDraft body = object.parts[0].load().draft;
  const SourceLine there = Ours(object, hinge.origin, hinge.axis);
  const bool level = std::abs(hinge.axis.y()) < 0.5;
  EXPECT_LT(Angle(body.facts.joint.axis, there.direction), 1e-4);
  const Eigen::Vector3d up(0, 0, LiftOf(body, there));
  if (!level) {
    EXPECT_LT(Distance({there.point + up, there.direction}, body.facts.joint.origin_m), 1e-4);
  }
  if (object.parts.size() < 2 || knob == nullptr) return;
  const PartDraft handle = object.parts[1].load().draft;
  // composed again; the leaf shut as its limits say
  const RigidTransform authored =
      Translation(body.facts.joint.origin_m + object.hinge_to_handle_m.value());
  const DoorAsset door = ComposeDoor(Unrepaired(body), Unrepaired(handle), {}, authored);
  const auto links = DoorFromLinks(door, 0, 0);
  const bool ajar = hinge.lower < -0.1;
  const SourceLine at_rest{hinge.origin + knob->origin, knob->axis};
  const SourceLine shut = Shut(hinge, ajar ? hinge.lower : 0, at_rest);
  const SourceLine expected = Ours(object, shut.point, shut.direction);
  EXPECT_LT(Distance({expected.point + up, expected.direction}, links[kHandleLink].translation()),
            1e-4);
  EXPECT_LT(Angle(links[kHandleLink].linear() * door.handle_joint.axis, expected.direction), 1e-4);
  EXPECT_LT(Distance({there.point + up, there.direction}, links[kLeafLink].translation()), 1e-4);
}

// "pm-101593" or "pm-9128-link_1" -> link of the leaf
std::string LeafLink(const ForeignObject& object, const std::string& only) {
  const std::size_t at = object.name.find("link_");
  return at == std::string::npos ? only : object.name.substr(at);
}

TEST_F(ForeignAssets, HingesAndKnobsOfPartNetSafesAndFurnitureAreThoseOfTheirUrdf) {
  // object -> the link of its leaf and of what turns on it, as a person reads its files
  const std::map<std::string, std::array<std::string, 2>> doors = {
      {"101593", {"link_0", "link_1"}}, {"101613", {"link_0", "link_1"}},
      {"101619", {"link_0", "link_1"}}, {"102301", {"link_0", "link_1"}},
      {"102387", {"link_0", "link_1"}}, {"101564", {"link_13", ""}},
      {"40147", {"link_0", ""}},        {"7304", {"link_1", ""}},
      {"8877", {"link_1", ""}},         {"11178", {"link_0", ""}},
      {"9128", {"link_1", ""}}};
  for (const auto& [id, links] : doors) {
    SCOPED_TRACE(id);
    const fs::path folder = root_ / "partnet_mobility" / id;
    const auto joints = JointsOf(folder / "mobility.urdf");
    for (const ForeignObject& object : ReadObjects({folder, "partnet-mobility"}, {})) {
      EXPECT_EQ(object.refusal, "");
      const TextJoint& hinge = joints.at(LeafLink(object, links[0]));
      ExpectAxesOf(object, hinge, links[1].empty() ? nullptr : &joints.at(links[1]));
    }
  }
}

TEST_F(ForeignAssets, EveryObjectOfPartNetAndGaPartNetImportsOrSaysWhyNot) {
  std::map<std::string, std::string> refused;
  int objects = 0;
  for (const ForeignSource& source : FindObjects(root_, "auto")) {
    if (source.format != "partnet-mobility" && source.format != "gapartnet") continue;
    SCOPED_TRACE(source.path.string());
    for (const ForeignObject& object : ReadObjects(source, {})) {
      ++objects;
      EXPECT_EQ(object.parts.empty(), !object.refusal.empty());
      if (!object.refusal.empty()) refused[source.path.filename().string()] = object.refusal;
    }
  }
  EXPECT_GE(objects, 18);
  // a box with a lid, and a washing machine that is filled from above
  ASSERT_EQ(refused.size(), 2U);
  EXPECT_NE(refused["47645"].find("lid"), std::string::npos) << refused["47645"];
  EXPECT_NE(refused["103508"].find("lid"), std::string::npos) << refused["103508"];
}

TEST_F(ForeignAssets, LoosePartsAndDoorGymHandlesImport) {
  int handles = 0;  // beside them lies a world in MJCF, which is an object of its own
  for (const ForeignSource& source : FindObjects(root_ / "doorgym", "doorgym")) {
    const ForeignObject object = ReadObjects(source, {}).at(0);
    EXPECT_LT(object.parts.at(0).load().box_deviation_m, 5e-4) << object.name;
    ++handles;
  }
  EXPECT_EQ(handles, 4);
  ReadConfig config{.category = "storagefurniture"};
  const auto count = [&](const std::string& folder) {
    int imported = 0;
    for (const ForeignSource& source : FindObjects(root_ / "urdformer_parts" / folder, "mesh"))
      imported += ReadObjects(source, config).at(0).refusal.empty() ? 1 : 0;
    return imported;
  };
  config.mesh.role = "handle";
  EXPECT_EQ(count("handles"), 18);
  config.mesh.mechanism = "round";
  EXPECT_EQ(count("knobs"), 8);
  config.mesh.role = "body";
  EXPECT_EQ(count("doorLs"), 5);
  config.mesh.hinge = "right";
  EXPECT_EQ(count("doorRs"), 5);
  EXPECT_EQ(count("drawers"), 0);
}

TEST_F(ForeignAssets, ObjectsOfTheReleaseThatLackOnlyTheirFrameImportWithoutIt) {
  int complete = 0;
  int without_frame = 0;
  for (const ForeignSource& source : FindObjects(root_ / "unidoormanip_objects")) {
    try {
      ReadObjects(source, {});
      ++complete;
      continue;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMissing) << error.what();
    }
    try {
      ReadObjects(source, {.allow_missing = "frame"});
      ++without_frame;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMissing) << error.what();
    }
  }
  EXPECT_EQ(complete, 83);
  // the one that lacks everything stays out
  EXPECT_EQ(without_frame, 13);
}

// link axes -> ours
Eigen::Vector3d FromLink(const Eigen::Vector3d& v) { return {v.z(), v.x(), v.y()}; }

// hinge and handle axis as mobility.urdf states them, in our axes
struct StatedAxes {
  SourceLine hinge;
  SourceLine handle;
};

StatedAxes StatedIn(const fs::path& urdf) {
  const auto joints = JointsOf(urdf);
  const TextJoint& hinge = joints.at("link_1");
  // what lies below the leaf: one joint that turns, and maybe a fixed one
  Eigen::Vector3d mount = hinge.origin;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (const char* link : {"link_2", "link_3"}) {
    const auto joint = joints.find(link);
    if (joint == joints.end()) continue;
    mount += joint->second.origin;
    if (joint->second.axis.norm() > 0) axis = joint->second.axis;
  }
  return {{FromLink(hinge.origin), FromLink(hinge.axis).normalized()},
          {FromLink(mount), FromLink(axis).normalized()}};
}

void ExpectComposesAboutTheAxesOf(const ForeignSource& source) {
  const ForeignObject object = ReadObjects(source, {.allow_missing = "frame"}).at(0);
  const Part body = Unrepaired(object.parts[0].load().draft);
  const Part handle = Unrepaired(object.parts[1].load().draft);
  StatedAxes stated = StatedIn(source.path / "mobility.urdf");
  // the door stands on the floor, the source's base lies in its middle
  const Eigen::Vector3d up(0, 0, body.joint.origin_m.z() - stated.hinge.point.z());
  stated.hinge.point += up;
  stated.handle.point += up;
  const RigidTransform authored =
      Translation(body.joint.origin_m + object.hinge_to_handle_m.value());
  for (const HandlePlace place : {HandlePlace::kAuto, HandlePlace::kAuthor}) {
    const DoorAsset door = ComposeDoor(body, handle, {.place = place}, authored);
    const auto links = DoorFromLinks(door, 0, 0);
    EXPECT_LT(Distance(stated.hinge, links[kLeafLink].translation()), 1e-4);
    EXPECT_LT(Angle(links[kLeafLink].linear() * door.hinge.axis, stated.hinge.direction), 1e-4);
    EXPECT_LT(Distance(stated.handle, links[kHandleLink].translation()), 1e-4) << NameOf(place);
    EXPECT_LT(Angle(links[kHandleLink].linear() * door.handle_joint.axis, stated.handle.direction),
              1e-4);
    // slid along its axis, if at all; the surface is within a leaf's thickness
    const double off = (links[kHandleLink].translation() - stated.handle.point).norm();
    EXPECT_LT(off, place == HandlePlace::kAuthor ? 1e-4 : 0.1);
  }
}

TEST_F(ForeignAssets, EveryObjectOfTheReleaseComposesAgainAboutTheAxesOfItsUrdf) {
  int count = 0;
  for (const ForeignSource& source : FindObjects(root_ / "unidoormanip_objects")) {
    SCOPED_TRACE(source.path.string());
    if (source.path.filename() == "99690189969517") continue;  // lacks all its meshes
    ExpectComposesAboutTheAxesOf(source);
    ++count;
  }
  EXPECT_EQ(count, 96);
}

// Few and rough collision shapes: they take most of an import's time, and no place or axis depends
// on them.
MakePartConfig RoughCollisionShapes() {
  const ConvexPartsConfig rough{.max_parts = 2, .max_grid_cells = 60'000};
  return {.frame_convex = rough, .leaf_convex = rough, .handle_convex = rough};
}

// Imports with repair take minutes for all objects; these only where they are asked for.
bool AskedForAll() {
  const char* all = std::getenv("DOORFORGE_IMPORT_ALL");
  return all != nullptr && std::string(all) == "1";
}

TEST_F(ForeignAssets, ImportedDoorsComposeAgainAboutTheAxesOfTheirUrdf) {
  const fs::path out = TestFolder("imported_doors");
  // a handle that overhangs its leaf; seating would move it
  const fs::path objects = root_ / "unidoormanip_objects";
  const std::vector<ForeignSource> sources =
      FindObjects(AskedForAll() ? objects : objects / "Window/99690189969519");
  ImportConfig config{.read = {.allow_missing = "frame"}};
  if (!AskedForAll()) config.make = RoughCollisionShapes();
  const ImportReport report = ImportObjects(sources, out, config, Existing::kRefuse);
  int imported = 0;
  for (const ImportedObject& object : report.objects) {
    SCOPED_TRACE(object.name + ": " + object.message);
    if (object.outcome == ImportOutcome::kIncomplete) continue;
    ASSERT_EQ(object.outcome, ImportOutcome::kImported);
    const Part body = ReadPart(out / object.body_id);
    const Part handle = ReadPart(out / object.handle_id);
    const AuthorPlaces places = ReadAuthorPlaces(out / object.body_id);
    const DoorAsset door = ComposeDoor(body, handle, {}, places.at(handle.source_sha256));
    const auto links = DoorFromLinks(door, 0, 0);
    StatedAxes stated = StatedIn(object.source.path / "mobility.urdf");
    const Eigen::Vector3d up(0, 0, body.joint.origin_m.z() - stated.hinge.point.z());
    stated.hinge.point += up;
    stated.handle.point += up;
    EXPECT_LT(Distance(stated.hinge, links[kLeafLink].translation()), 1e-4);
    EXPECT_LT(Distance(stated.handle, links[kHandleLink].translation()), 1e-4);
    ++imported;
  }
  EXPECT_EQ(imported, AskedForAll() ? 96 : 1);
}

}  // namespace
}  // namespace doorforge
