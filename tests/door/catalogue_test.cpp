// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/catalogue/catalogue.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <regex>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/compose/compose.h"
#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/parts/grasp.h"
#include "doorforge/schemas/door_draw.h"
#include "doorforge/schemas/part_identity.h"
#include "doorforge/schemas/split.h"
#include "doorforge/validate/validate_door.h"

#include "catalogue_parts.h"
#include "scratch_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Eigen::AlignedBox3d BoundsOfPiece(const PartPiece& piece) {
  return MeasureTopology(piece.mesh).bounds;
}

Eigen::AlignedBox3d BoundsOfPart(const Part& part) {
  Eigen::AlignedBox3d bounds;
  for (const PartPiece& piece : part.pieces) bounds.extend(BoundsOfPiece(piece));
  return bounds;
}

// Number of triangles that the line along x through (y, z) crosses.
int CrossingsAlongX(const TriangleMesh& mesh, double y, double z) {
  int crossings = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    double area[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[k])];
      const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
      area[k] = (a.y() - y) * (b.z() - z) - (a.z() - z) * (b.y() - y);
    }
    crossings +=
        (area[0] > 0 && area[1] > 0 && area[2] > 0) || (area[0] < 0 && area[1] < 0 && area[2] < 0);
  }
  return crossings;
}

bool Inside(const TriangleMesh& hull, const Eigen::Vector3d& point, double margin_m) {
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    if ((point - a).dot((b - a).cross(c - a).normalized()) > margin_m) return false;
  }
  return true;
}

// A folder with one recipe in the place of a body or handle.
fs::path WithRecipe(const std::string& name, const std::string& place, const std::string& text) {
  const fs::path data = ScratchFolder("catalogue") / name;
  fs::remove_all(data);
  CommitFile(data / "catalog" / place, text);
  return data;
}

std::string Head(const std::string& id, const std::string& family) {
  return "schema: doorforge.recipe\nschema_version: 1\nid: " + id + "\nfamily: " + family +
         "\nlicense: CC0-1.0\nparameters:\n";
}

std::string MessageOf(const std::function<void()>& call, ErrorCode expected) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), expected) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "expected an Error";
  return {};
}

TEST(Catalogue, HasAtLeastThreeBodiesAndFourHandlesOfEachKind) {
  std::map<std::string, int> count;
  for (const CatalogueEntry& entry : ListCatalogue(DataOfSource()))
    ++count[std::string(NameOf(entry.category)) + " " + std::string(NameOf(entry.role)) + " " +
            std::string(NameOf(entry.mechanism))];
  EXPECT_GE(count["interior body none"], 3);
  EXPECT_GE(count["interior handle lever"], 4);
  EXPECT_GE(count["interior handle round"], 4);
  EXPECT_GE(count["storagefurniture body none"], 3);
  EXPECT_GE(count["storagefurniture handle round"], 4);
  EXPECT_GE(count["storagefurniture handle none"], 4);
}

// How many parts a cell such as "60 levers of 9 families, 36 round knobs of 8" speaks of.
int PartsTold(const std::string& cell) {
  static const std::regex kNumber(R"((of )?(\d+))");
  int parts = 0;
  for (std::sregex_iterator at(cell.begin(), cell.end(), kNumber), end; at != end; ++at) {
    if (!(*at)[1].matched) parts += std::stoi((*at)[2]);
  }
  return parts;
}

// The two pages that count the parts: who adds recipes is told here which line is out of date.
TEST(Catalogue, IsAsLargeAsThePagesSay) {
  const fs::path source(DOORFORGE_SOURCE_DIR);
  std::map<std::string, std::array<int, 2>> told;  // by category: bodies, handles
  static const std::regex kRow(R"(\n\| (\w+) \| ([^|\n]*) \| ([^|\n]*) \|(?=\n))");
  const std::string page = ReadFile(source / "docs/catalogue.md");
  const std::string table = page.substr(page.find("| category | bodies | handles |"));
  const std::string rows = table.substr(0, table.find("\n\n") + 1);
  for (std::sregex_iterator at(rows.begin(), rows.end(), kRow), end; at != end; ++at)
    told[(*at)[1]] = {PartsTold((*at)[2]), PartsTold((*at)[3])};
  std::map<std::string, std::array<int, 2>> count;
  for (const CatalogueEntry& entry : ListCatalogue(DataOfSource()))
    ++count[std::string(NameOf(entry.category))].at(entry.role == PartRole::kBody ? 0 : 1);
  EXPECT_EQ(told, count) << "docs/catalogue.md, \"What is in it\"";
  int bodies = 0;
  int handles = 0;
  int doors = 0;
  for (const auto& [category, parts] : count) {
    bodies += parts[0];
    handles += parts[1];
    doors += parts[0] * parts[1];
  }
  const std::string thousands = std::to_string(doors / 1000) + "," + std::to_string(doors % 1000);
  const std::string readme = ReadFile(source / "README.md");
  for (const std::string& line :
       {std::to_string(bodies) + " bodies and " + std::to_string(handles) + " handles",
        thousands + " doors"})
    EXPECT_NE(readme.find(line), std::string::npos) << "README.md: " << line;
}

TEST(Catalogue, BuildsTheSameBytesTwiceAndInAnyNumberOfThreads) {
  constexpr std::size_t kStep = 3;  // of all parts a third, which has every family
  const std::vector<CatalogueEntry> entries = ListCatalogue(DataOfSource());
  std::vector<std::string> hashes(entries.size() / kStep);
  ParallelFor(hashes.size(), 3, [&](std::size_t i) {
    hashes[i] = ContentHash(BuildCataloguePart(entries[kStep * i]));
  });
  for (std::size_t i = 0; i < hashes.size(); ++i)
    EXPECT_EQ(hashes[i], ContentHash(AllParts()[kStep * i])) << entries[kStep * i].id;
}

TEST(Catalogue, PartsReadBackEqualAndBreakNoRule) {
  for (const Part& part : AllParts()) {
    const fs::path folder = ScratchFolder("catalogue") / part.id;
    StagedFolder staged(folder, kPartFolder, Existing::kReplace);
    WritePart(part, staged.path());
    staged.Commit();
    EXPECT_EQ(ContentHash(ReadPart(folder)), ContentHash(part)) << part.id;
    const ValidationReport report = ValidatePart(folder);
    EXPECT_TRUE(report.findings.empty()) << ToJson(std::span(&report, 1)).dump(2);
  }
}

TEST(Catalogue, EveryPartGoesIntoADoorThatBreaksNoRule) {
  // each body with one handle and each handle with one body of its category
  std::map<Category, std::vector<const Part*>> bodies;
  std::map<Category, std::vector<const Part*>> handles;
  for (const Part& part : AllParts())
    (part.role == PartRole::kBody ? bodies : handles)[part.category].push_back(&part);
  for (const auto& [category, some_handles] : handles) {
    for (std::size_t i = 0; i < some_handles.size(); ++i) {
      const Part& body = *bodies[category][i % bodies[category].size()];
      const DoorAsset door = ComposeDoor(body, *some_handles[i], {});
      const fs::path folder = ScratchFolder("catalogue") / door.id;
      WriteDoorFolder(door, folder, Existing::kReplace);
      const ValidationReport report = ValidateDoor(folder);
      EXPECT_TRUE(report.findings.empty()) << ToJson(std::span(&report, 1)).dump(2);
    }
  }
}

// UniDoorManip's measured ranges, see the table in docs/catalogue.md.
TEST(Catalogue, SizesLieWithinTheMeasuredRangesOfTheReleasedObjects) {
  for (const Part& part : AllParts()) {
    // the others have files of their own, such as furniture_catalogue_test.cpp
    if (part.category != Category::kInterior && part.category != Category::kStorageFurniture)
      continue;
    SCOPED_TRACE(part.id);
    const Eigen::Vector3d size = BoundsOfPart(part).sizes();
    if (part.role == PartRole::kHandle) {
      EXPECT_LE(size.x(), 0.103);
      EXPECT_LE(part.mechanism == Mechanism::kRound ? size.y() : 0, 0.068);
      if (part.mechanism == Mechanism::kLever) {
        EXPECT_GE(size.y(), 0.13);
        EXPECT_LE(size.y(), 0.17);
      }
      continue;
    }
    const double reach = part.part_from_mount.translation().y() - part.joint.origin_m.y();
    const bool interior = part.category == Category::kInterior;
    EXPECT_GE(size.z(), interior ? 1.70 : 0.594);
    EXPECT_LE(size.z(), interior ? 1.90 : 1.242);
    EXPECT_GE(reach, interior ? 0.510 : 0.474);
    EXPECT_LE(reach, interior ? 0.889 : 1.299);
    const double leaf_kg = FindPiece(part, "leaf")->mass.mass_kg;
    EXPECT_GE(leaf_kg, interior ? 8 : 5);
    EXPECT_LE(leaf_kg, 25);
    if (!interior) continue;
    const Eigen::AlignedBox3d leaf = BoundsOfPiece(*FindPiece(part, "leaf"));
    EXPECT_NEAR(leaf.max().y() - part.part_from_mount.translation().y(), 0.08, 1e-6);
    EXPECT_NEAR(part.part_from_mount.translation().z() - leaf.min().z(), 0.8, 1e-6);
  }
}

TEST(Catalogue, PositiveAnglesOpenTowardsTheHandleSideAndLowerTheLeversTip) {
  for (const Part& part : AllParts()) {
    SCOPED_TRACE(part.id);
    const Eigen::AngleAxisd turn(0.1, part.joint.axis);
    if (part.role == PartRole::kBody) {
      const Eigen::Vector3d arm(0, 0.5, 0);
      EXPECT_GT((turn * arm).x(), 0.04);
    } else if (part.mechanism == Mechanism::kLever && part.category == Category::kInterior) {
      const Eigen::AlignedBox3d grip = BoundsOfPiece(*FindPiece(part, "grip"));
      const Eigen::Vector3d tip(0, grip.min().y(), 0);
      EXPECT_LT(tip.y(), -0.09) << "a lever points towards the hinge";
      EXPECT_LT((turn * tip).z(), -0.008);
    }
    if (part.role == PartRole::kHandle) {
      // UniDoorManip's overrides: 45 degrees, for cars 10
      const double range = std::numbers::pi / (part.category == Category::kCar ? 18 : 4);
      EXPECT_NEAR(part.joint.upper_rad, part.mechanism == Mechanism::kNone ? 0 : range, 1e-12);
    }
  }
}

TEST(Catalogue, AParallelGripperHoldsEveryHandleAtItsGraspFrame) {
  for (const Part& part : AllParts()) {
    if (part.role == PartRole::kBody) continue;
    TriangleMesh handle;
    for (const PartPiece& piece : part.pieces) {
      const int offset = static_cast<int>(handle.vertices.size());
      handle.vertices.insert(handle.vertices.end(), piece.mesh.vertices.begin(),
                             piece.mesh.vertices.end());
      for (const Eigen::Vector3i& t : piece.mesh.triangles)
        handle.triangles.emplace_back(t.array() + offset);
    }
    const GraspFit fit = MeasureGrasp(FindPiece(part, "grip")->mesh, handle, part.part_from_grasp);
    EXPECT_TRUE(fit.holds) << part.id << ": contact " << fit.contact << ", width " << fit.width_m
                           << ", free " << fit.fingers_free;
    EXPECT_LT(std::abs(fit.off_center_m), 0.002) << part.id;
    if (part.category == Category::kSafe) continue;  // grips stand at any angle
    // fingers close along y on an upright grip, along z on any other
    const bool upright = part.mechanism == Mechanism::kNone || part.category == Category::kWindow;
    const Eigen::Vector3d closing = part.part_from_grasp.linear().col(1);
    EXPECT_GT(upright ? closing.y() : closing.z(), 0.999) << part.id;
  }
}

TEST(Catalogue, CollisionShapesCoverTheMeshAndProtrudeLittle) {
  for (const Part& part : AllParts()) {
    for (const PartPiece& piece : part.pieces) {
      SCOPED_TRACE(part.id + " " + piece.name);
      EXPECT_LE(piece.hulls.size(), 32u);
      for (const TriangleMesh& hull : piece.hulls) EXPECT_LE(hull.vertices.size(), 64u);
      const ConvexPartsFit fit = MeasureConvexParts(*ClosedMesh::From(piece.mesh), piece.hulls);
      const bool handle = part.role == PartRole::kHandle;
      EXPECT_LE(fit.uncovered_m, handle ? 0.003 : 0.01);
      // the shell of a car may stand out farther in the arches of its wheels
      if (part.category == Category::kCar) continue;
      // an arch's inner side lies behind the chords of its hulls
      EXPECT_LE(fit.protrusion_m, handle ? 0.003 : 0.017);
    }
  }
}

TEST(Catalogue, CollisionShapesKeepTheFingersGapFree) {
  for (const Part& part : AllParts()) {
    // a key's and a crank's own neck stands behind the grip
    if (part.role == PartRole::kBody || part.mechanism == Mechanism::kKey ||
        part.id.starts_with("window_crank"))
      continue;
    // behind the bar of a lever or a pull, half way to the leaf; beside a knob's neck
    Eigen::Vector3d gap = part.part_from_grasp.translation();
    gap.x() *= 0.5;
    if (part.mechanism == Mechanism::kRound) gap.z() += 0.03;
    // a crank's knob stands on its arm
    if (part.id.starts_with("window_crank")) gap.y() += 0.03;
    for (const PartPiece& piece : part.pieces) {
      for (const TriangleMesh& hull : piece.hulls)
        EXPECT_FALSE(Inside(hull, gap, 0.004)) << part.id << " " << piece.name;
    }
  }
}

TEST(Catalogue, GlazedLeavesHaveRealOpenings) {
  const Part& part = PartNamed("interior_half_glass_01");
  const TriangleMesh& leaf = FindPiece(part, "leaf")->mesh;
  EXPECT_EQ(CrossingsAlongX(leaf, 0.25, 1.2), 0);  // through an opening
  EXPECT_EQ(CrossingsAlongX(leaf, 0.25, 0.4), 2);  // through the lower panel
  for (const TriangleMesh& hull : FindPiece(part, "leaf")->hulls)
    EXPECT_FALSE(Inside(hull, {-0.02, 0.25, 1.2}, 0));
}

// The leaf never reaches into the frame on its way: no vertex of the open leaf lies in a hull of
// the frame.
TEST(Catalogue, LeavesSwingFreeOfTheirFrames) {
  for (const Part& part : AllParts()) {
    if (part.role != PartRole::kBody || FindPiece(part, "frame") == nullptr) continue;
    for (const double angle : {0.0, 0.02, 0.1, 0.5, 1.5}) {
      const RigidTransform swing = Translation(part.joint.origin_m) *
                                   RotationAbout(part.joint.axis, angle) *
                                   Translation(-part.joint.origin_m);
      int inside = 0;
      for (const Eigen::Vector3d& vertex : FindPiece(part, "leaf")->mesh.vertices) {
        for (const TriangleMesh& hull : FindPiece(part, "frame")->hulls)
          inside += Inside(hull, swing * vertex, -0.0005);
      }
      EXPECT_EQ(inside, 0) << part.id << " at " << angle << " rad";
    }
  }
}

TEST(Catalogue, AFlushLeafWeighsWhatItsBoxWeighs) {
  const Part& part = PartNamed("interior_flush_01");
  // 0.76 x 1.74 x 0.04 m of oak veneer at 340 kg/m3; rounding the edges takes 3 mm corners off
  const double box_kg = 0.76 * 1.74 * 0.04 * 340;
  const double mass_kg = FindPiece(part, "leaf")->mass.mass_kg;
  EXPECT_LT(mass_kg, box_kg);
  EXPECT_GT(mass_kg, box_kg * 0.9985);
}

TEST(Catalogue, ABarPullWeighsWhatItsRodWeighs) {
  const Part& part = PartNamed("storage_pull_bar_01");
  // a 12 mm rod of 6600 kg/m3: two legs of 44 mm and 192 mm between them, less the rounded corners
  const double corner = 2 * (2 - std::numbers::pi / 2) * 0.014;
  const double length = 2 * 0.044 + 0.192 - corner;
  const double rod_kg = std::numbers::pi * 0.006 * 0.006 * length * 6600;
  EXPECT_NEAR(FindPiece(part, "grip")->mass.mass_kg, rod_kg, 0.03 * rod_kg);
}

TEST(Catalogue, RefusesAnUnknownKeyAndNamesIt) {
  const fs::path data = WithRecipe("unknown_key", "interior/handles/a.yaml",
                                   Head("a", "lever_straight") + "  lenght_m: 0.12\n");
  const std::string message =
      MessageOf([&] { BuildCataloguePart(data, "a"); }, ErrorCode::kInvalidConfig);
  EXPECT_NE(message.find("lenght_m"), std::string::npos) << message;
  EXPECT_NE(message.find("length_m"), std::string::npos) << message;
}

TEST(Catalogue, RefusesAValueOutOfRangeWithFoundAndAllowed) {
  const fs::path data = WithRecipe("range", "interior/handles/a.yaml",
                                   Head("a", "knob_ball") + "  diameter_m: 0.09\n");
  const std::string message =
      MessageOf([&] { BuildCataloguePart(data, "a"); }, ErrorCode::kInvalidConfig);
  for (const char* words : {"a.yaml", "diameter_m", "found 0.09", "0.03 to 0.066"})
    EXPECT_NE(message.find(words), std::string::npos) << message;
}

TEST(Catalogue, RefusesAWordThatASettingDoesNotHave) {
  const auto refusal = [](const char* name, const char* family, const char* settings) {
    const fs::path data = WithRecipe(name, "interior/handles/a.yaml", Head("a", family) + settings);
    return MessageOf([&] { BuildCataloguePart(data, "a"); }, ErrorCode::kInvalidConfig);
  };
  const std::string shape = refusal("word", "knob_ball", "  rose: {shape: squar}\n");
  EXPECT_NE(shape.find("rose.shape: found \"squar\", allowed round, square, octagon, oval, plate, "
                       "stadium, tablet, lens, none; did you mean \"square\"?"),
            std::string::npos)
      << shape;
  // of no matter for this rose, and refused all the same
  const std::string lock =
      refusal("unread_word", "knob_ball", "  rose: {shape: none, lock: yale}\n");
  EXPECT_NE(lock.find("rose.lock: found \"yale\""), std::string::npos) << lock;
}

TEST(Catalogue, RefusesUnknownFamiliesFinishesAndMisplacedRecipes) {
  const auto list = [](const fs::path& data) { return [data] { ListCatalogue(data); }; };
  std::string message = MessageOf(
      list(WithRecipe("family", "interior/handles/a.yaml", Head("a", "lever_strait") + "  {}\n")),
      ErrorCode::kInvalidConfig);
  EXPECT_NE(message.find("did you mean \"lever_straight\""), std::string::npos) << message;
  message = MessageOf(
      list(WithRecipe("role", "interior/bodies/a.yaml", Head("a", "knob_ball") + "  {}\n")),
      ErrorCode::kInvalidConfig);
  EXPECT_NE(message.find("the folder is for a body"), std::string::npos) << message;
  message = MessageOf(
      list(WithRecipe("id", "interior/handles/b.yaml", Head("a", "knob_ball") + "  {}\n")),
      ErrorCode::kInvalidConfig);
  EXPECT_NE(message.find("named for \"b\""), std::string::npos) << message;
  const fs::path data = WithRecipe("finish", "interior/handles/a.yaml",
                                   Head("a", "knob_ball") + "  finish: polished_bras\n");
  message = MessageOf([&] { BuildCataloguePart(data, "a"); }, ErrorCode::kInvalidConfig);
  EXPECT_NE(message.find("did you mean \"polished_brass\""), std::string::npos) << message;
}

TEST(Catalogue, BuildsAPartBesideARecipeThatIsBroken) {
  const fs::path data =
      WithRecipe("beside", "interior/handles/a.yaml", Head("a", "knob_ball") + "  {}\n");
  CommitFile(data / "catalog/interior/handles/b.yaml", "no recipe: [");
  EXPECT_EQ(BuildCataloguePart(data, "a").id, "a");
  MessageOf([&] { ListCatalogue(data); }, ErrorCode::kInvalidConfig);
}

TEST(Catalogue, ListsTheFilesOfWhatItsRecipesSay) {
  const std::vector<RecipeFile> files = ListRecipes(DataOfSource());
  const std::vector<CatalogueEntry> entries = ListCatalogue(DataOfSource());
  ASSERT_EQ(files.size(), entries.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(files[i].id, entries[i].id);
    EXPECT_EQ(ParseYaml(ReadFile(files[i].recipe), "")["id"], files[i].id);
  }
}

TEST(Catalogue, SuggestsTheNearestIdForAnUnknownOne) {
  const std::string message = MessageOf(
      [] { BuildCataloguePart(DataOfSource(), "interior_flush_1"); }, ErrorCode::kMissing);
  EXPECT_NE(message.find("interior_flush_01"), std::string::npos) << message;
}

TEST(QuickstartSplit, PutsEveryPartOnExactlyOneSide) {
  const fs::path path = DataOfSource() / "splits" / "quickstart.yaml";
  const auto split = ParseYaml(ReadFile(path), path.string());
  std::set<std::string> listed;
  std::map<std::string, std::set<std::string>> kinds;  // side -> "category role mechanism"
  for (const char* side : {"train", "test"}) {
    for (const auto& id : split.at(side)) {
      EXPECT_TRUE(listed.insert(id.get<std::string>()).second) << id << " is on both sides";
      const Part& part = PartNamed(id.get<std::string>());
      kinds[side].insert(std::string(NameOf(part.category)) + " " + std::string(NameOf(part.role)) +
                         " " + std::string(NameOf(part.mechanism)));
    }
  }
  EXPECT_EQ(kinds["train"], kinds["test"]) << "every kind is trained on and tested";
}

Split SplitNamed(const std::string& name) {
  return ReadSplit(DataOfSource() / "splits" / (name + ".yaml"));
}

Split FullSplit() { return SplitNamed("full"); }

// A category's bodies, or its handles of one mechanism.
std::string GroupOf(const Part& part) {
  return std::string(NameOf(part.category)) + " " + std::string(NameOf(part.role)) + " " +
         std::string(NameOf(part.mechanism));
}

// The generator of a part, as its recipe names it.
std::string FamilyOf(const std::string& id) {
  const Part& part = PartNamed(id);
  const fs::path path = DataOfSource() / "catalog" / std::string(NameOf(part.category)) /
                        (part.role == PartRole::kBody ? "bodies" : "handles") / (id + ".yaml");
  return ParseYaml(ReadFile(path), path.string()).at("family").get<std::string>();
}

std::set<std::string> FamiliesOf(const std::vector<std::string>& ids) {
  std::set<std::string> families;
  for (const std::string& id : ids) families.insert(FamilyOf(id));
  return families;
}

// Every body of a side with every handle of its category, as `compose --all` makes them.
std::map<Category, std::vector<DoorIdentity>> DoorsOf(const std::vector<std::string>& parts) {
  std::map<Category, std::vector<DoorIdentity>> doors;
  for (const std::string& body : parts) {
    if (PartNamed(body).role != PartRole::kBody) continue;
    for (const std::string& handle : parts) {
      const Part& grip = PartNamed(handle);
      if (grip.role != PartRole::kHandle || grip.category != PartNamed(body).category) continue;
      DoorIdentity door;
      door.id = body + "__" + handle;
      door.category = grip.category;
      door.mechanism = grip.mechanism;
      door.body.id = body;
      door.handle.id = handle;
      doors[grip.category].push_back(door);
    }
  }
  return doors;
}

// No body and no handle is tried more than once more often than another.
void ExpectEven(const std::vector<DoorIdentity>& doors, std::size_t count,
                const std::string& where) {
  std::map<std::string, int> bodies;
  std::map<std::string, int> handles;
  for (const DoorIdentity& door : doors) bodies[door.body.id] = handles[door.handle.id] = 0;
  const auto drawn = DrawDoors(doors, count);
  ASSERT_EQ(drawn.size(), count) << where;
  for (const std::size_t door : drawn) {
    ++bodies[doors[door].body.id];
    ++handles[doors[door].handle.id];
  }
  for (const auto& uses : {bodies, handles}) {
    const auto [least, most] =
        std::ranges::minmax_element(uses, {}, [](const auto& use) { return use.second; });
    ASSERT_LE(most->second - least->second, 1) << where << ", " << count << " doors";
  }
}

Part AtAnotherSize(Part part, double scale) {
  for (PartPiece& piece : part.pieces) {
    for (Eigen::Vector3d& vertex : piece.mesh.vertices) vertex *= scale;
  }
  part.id += "_copy";
  return part;
}

TEST(SplitFiles, HoldEveryPartOnceAndTheUnseenCategoriesApart) {
  const Split split = FullSplit();
  std::map<std::string, int> count;
  for (const std::string& id : PartsOf(split)) ++count[id];
  for (const std::string& id : SplitNamed("families").test) ++count[id];
  for (const Part& part : AllParts()) EXPECT_EQ(count[part.id], 1) << part.id;
  EXPECT_EQ(count.size(), AllParts().size());
  const auto unseen = [](const std::string& id) {
    const Category category = PartNamed(id).category;
    return category == Category::kStorageFurniture || category == Category::kRefrigerator;
  };
  const auto all_unseen =
      std::ranges::count_if(AllParts(), [&](const Part& part) { return unseen(part.id); });
  EXPECT_EQ(std::ranges::count_if(split.unseen_categories, unseen), all_unseen);
  EXPECT_EQ(std::ssize(split.unseen_categories), all_unseen);
  EXPECT_TRUE(std::ranges::none_of(split.train, unseen));
  EXPECT_TRUE(std::ranges::none_of(split.validation, unseen));
  EXPECT_TRUE(std::ranges::none_of(split.test, unseen));
}

TEST(SplitFiles, TestAndValidateEveryGroupThatIsTrainedOn) {
  const Split split = FullSplit();
  std::map<std::string, std::array<std::size_t, 3>> groups;  // trained on, validated, tested
  for (const std::string& id : split.train) ++groups[GroupOf(PartNamed(id))][0];
  for (const std::string& id : split.validation) ++groups[GroupOf(PartNamed(id))][1];
  for (const std::string& id : split.test) ++groups[GroupOf(PartNamed(id))][2];
  EXPECT_EQ(groups.size(), 10u);  // 4 categories of bodies, 6 kinds of handles
  for (const auto& [name, sides] : groups) {
    const std::size_t rest = sides[0] + sides[1];
    EXPECT_EQ(sides[2], (rest + sides[2]) / 3) << name;
    EXPECT_EQ(sides[1], (rest + 2) / 6) << name;
    EXPECT_GE(sides[1], 1u) << name;
  }
}

TEST(SplitFiles, FamiliesAreHeldOutWhole) {
  const Split full = FullSplit();
  const Split families = SplitNamed("families");
  EXPECT_EQ(families.train, full.train) << "one policy is judged by both";
  EXPECT_EQ(families.validation, full.validation);
  const std::set<std::string> held_out = FamiliesOf(families.test);
  for (const auto* side : {&full.train, &full.validation, &full.test}) {
    for (const std::string& family : FamiliesOf(*side))
      EXPECT_FALSE(held_out.contains(family)) << family;
  }
  std::map<std::string, std::set<std::string>> groups;  // all families of a group
  for (const Part& part : AllParts()) groups[GroupOf(part)].insert(FamilyOf(part.id));
  for (const std::string& id : full.train) {
    const auto& group = groups.at(GroupOf(PartNamed(id)));
    const auto count = std::ranges::count_if(
        group, [&](const std::string& family) { return held_out.contains(family); });
    EXPECT_EQ(count, group.size() > 2 ? 1 : 0) << GroupOf(PartNamed(id));
  }
}

TEST(SplitFiles, AnyNumberOfDoorsOfAnySideIsDrawnEvenly) {
  std::vector<std::pair<std::string, std::vector<std::string>>> sides;
  for (const char* name : {"full", "families"}) {
    const Split split = SplitNamed(name);
    for (const auto& [side, parts] : SidesOf(split)) {
      if (!parts->empty()) sides.emplace_back(std::string(name) + ":" + side, *parts);
    }
  }
  EXPECT_EQ(sides.size(), 4u + 3u);
  for (const auto& [name, parts] : sides) {
    for (const auto& [category, doors] : DoorsOf(parts)) {
      for (std::size_t n = 1; n <= std::min<std::size_t>(doors.size(), 120); ++n)
        ExpectEven(doors, n, name + ", " + std::string(NameOf(category)));
      ExpectEven(doors, doors.size() / 2, name);
      ExpectEven(doors, doors.size() - 1, name);
    }
  }
}

TEST(SplitFiles, NoSideHasACopyOfAnotherSidesPartEvenAtAnotherSize) {
  const Split split = FullSplit();
  std::vector<std::pair<int, PartIdentity>> sided;
  const Split families = SplitNamed("families");
  const std::vector<const std::vector<std::string>*> sides = {
      &split.train, &split.validation, &split.test, &split.unseen_categories, &families.test};
  for (std::size_t side = 0; side < sides.size(); ++side) {
    for (const std::string& id : *sides[side])
      sided.emplace_back(static_cast<int>(side), IdentityOf(PartNamed(id)));
  }
  for (std::size_t i = 0; i < sided.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (sided[i].first == sided[j].first) continue;
      EXPECT_FALSE(sided[i].second.SameAs(sided[j].second))
          << sided[i].second.id << " and " << sided[j].second.id;
    }
  }
  // a copy would be found
  const Part& part = PartNamed(split.train.front());
  EXPECT_TRUE(IdentityOf(AtAnotherSize(part, 1.37)).SameAs(IdentityOf(part)));
}

}  // namespace
}  // namespace doorforge
