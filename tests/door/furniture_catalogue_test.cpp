// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Safes, storage furniture and refrigerators of the catalogue.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/parts/grasp.h"

#include "catalogue_parts.h"
#include "scratch_folder.h"

namespace doorforge {
namespace {

const std::vector<CatalogueEntry>& Entries() {
  static const std::vector<CatalogueEntry> kEntries = [] {
    std::vector<CatalogueEntry> some;
    for (const CatalogueEntry& entry : ListCatalogue(DataOfSource())) {
      if (entry.category == Category::kSafe || entry.category == Category::kStorageFurniture ||
          entry.category == Category::kRefrigerator)
        some.push_back(entry);
    }
    return some;
  }();
  return kEntries;
}

// One part of every fourth recipe, so that each family is among them.
const std::vector<Part>& SomeParts() {
  static const std::vector<Part> kParts = [] {
    std::vector<Part> parts;
    std::set<std::string> families;
    for (std::size_t i = 0; i < Entries().size(); ++i) {
      if (families.insert(Entries()[i].family).second || i % 4 == 0)
        parts.push_back(PartNamed(Entries()[i].id));
    }
    return parts;
  }();
  return kParts;
}

// Depth of a point below the faces of a hull; negative outside.
double DepthIn(const TriangleMesh& hull, const Eigen::Vector3d& point) {
  double depth = 1e9;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() > 1e-12) depth = std::min(depth, -(point - a).dot(normal.normalized()));
  }
  return depth;
}

double DeepestIn(const PartPiece& piece, const Eigen::Vector3d& point) {
  double deepest = -1e9;
  for (const TriangleMesh& hull : piece.hulls) deepest = std::max(deepest, DepthIn(hull, point));
  return deepest;
}

struct SizeRange {
  Eigen::Vector3d least;
  Eigen::Vector3d most;
};

// Depth, width, height [m], see docs/catalogue.md.
SizeRange MeasuredRange(Category category, PartRole role) {
  const bool body = role == PartRole::kBody;
  if (category == Category::kSafe)
    return body ? SizeRange{{0.205, 0.356, 0.490}, {0.938, 0.910, 1.069}}
                : SizeRange{{0.009, 0.102, 0.061}, {0.080, 0.253, 0.212}};
  if (category == Category::kStorageFurniture)
    return body ? SizeRange{{0.309, 0.531, 0.594}, {0.950, 1.425, 1.242}}
                : SizeRange{{0.02, 0.01, 0.02}, {0.103, 0.068, 0.35}};
  return body ? SizeRange{{0.388, 0.450, 1.013}, {0.748, 1.020, 1.510}}
              : SizeRange{{0.038, 0.112, 0.040}, {0.059, 0.145, 0.070}};
}

TEST(FurnitureCatalogue, IsOfManyFamilies) {
  std::map<std::pair<Category, PartRole>, std::set<std::string>> families;
  for (const CatalogueEntry& entry : Entries()) {
    families[{entry.category, entry.role}].insert(entry.family);
  }
  const auto expect = [&](Category category, PartRole role, std::size_t least) {
    EXPECT_GE((families[{category, role}].size()), least);
  };
  expect(Category::kSafe, PartRole::kBody, 5);
  expect(Category::kSafe, PartRole::kHandle, 6);
  expect(Category::kStorageFurniture, PartRole::kBody, 8);
  expect(Category::kStorageFurniture, PartRole::kHandle, 4);
  expect(Category::kRefrigerator, PartRole::kBody, 4);
  expect(Category::kRefrigerator, PartRole::kHandle, 4);
}

TEST(FurnitureCatalogue, SizesLieWithinWhatWasMeasuredOnTheReleasedObjects) {
  for (const Part& part : SomeParts()) {
    SCOPED_TRACE(part.id);
    Eigen::AlignedBox3d bounds;
    for (const PartPiece& piece : part.pieces) bounds.extend(MeasureTopology(piece.mesh).bounds);
    const SizeRange range = MeasuredRange(part.category, part.role);
    EXPECT_TRUE((bounds.sizes().array() >= range.least.array() - 1e-3).all())
        << bounds.sizes().transpose();
    EXPECT_TRUE((bounds.sizes().array() <= range.most.array() + 1e-3).all())
        << bounds.sizes().transpose();
    if (part.role == PartRole::kHandle) continue;
    EXPECT_NEAR(bounds.min().z(), 0, 1e-3);
  }
}

TEST(FurnitureCatalogue, LeavesWeighFiveKilogramsOrMore) {
  for (const Part& part : SomeParts()) {
    if (part.role == PartRole::kHandle) continue;
    EXPECT_GE(FindPiece(part, "leaf")->mass.mass_kg, 5) << part.id;
  }
}

TEST(FurnitureCatalogue, CollisionShapesLeaveTheRoomBehindTheLeafFree) {
  for (const Part& part : SomeParts()) {
    if (part.role != PartRole::kBody) continue;
    const Eigen::AlignedBox3d leaf = MeasureTopology(FindPiece(part, "leaf")->mesh).bounds;
    int free = 0;
    // shelves may be in the way of some
    for (const double up : {0.3, 0.42, 0.58, 0.7}) {
      // no divider is at 0.61 of the width
      const Eigen::Vector3d inside(leaf.min().x() - 0.06, leaf.min().y() + 0.61 * leaf.sizes().y(),
                                   leaf.min().z() + up * leaf.sizes().z());
      free += DeepestIn(*FindPiece(part, "frame"), inside) < 0;
    }
    EXPECT_GE(free, 2) << part.id;
  }
}

TEST(FurnitureCatalogue, LeavesSwingOpenWithoutMeetingTheirFrames) {
  constexpr double kTouchM = 5e-4;
  for (const Part& part : SomeParts()) {
    if (part.role != PartRole::kBody) continue;
    const PartPiece& leaf = *FindPiece(part, "leaf");
    double deepest = -1e9;
    for (const double degrees : {0.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 86.0}) {
      const RigidTransform turn = Translation(part.joint.origin_m) *
                                  RotationAbout(part.joint.axis, degrees * 3.14159265358979 / 180) *
                                  Translation(-part.joint.origin_m);
      for (const TriangleMesh& hull : leaf.hulls) {
        for (const Eigen::Vector3d& vertex : hull.vertices)
          deepest = std::max(deepest, DeepestIn(*FindPiece(part, "frame"), turn * vertex));
      }
    }
    EXPECT_LE(deepest, kTouchM) << part.id;
  }
}

TEST(FurnitureCatalogue, TheSpacesBetweenAWheelsSpokesStayOpen) {
  int wheels = 0;
  for (const Part& part : SomeParts()) {
    if (part.id.find("safe_wheel") == std::string::npos) continue;
    ++wheels;
    const PartPiece& grip = *FindPiece(part, "grip");
    const Eigen::Vector3d on_rim = part.part_from_grasp.translation();
    // beside the seam of two shapes
    EXPECT_GE(DeepestIn(grip, on_rim + Eigen::Vector3d(0, 0, 0.005)), 0.003)
        << "the grasp lies in the rim";
    const Eigen::Vector3d hub(on_rim.x(), 0, 0);
    for (const double share : {0.45, 0.6, 0.75}) {
      EXPECT_LE(DeepestIn(grip, hub + share * (on_rim - hub)), -0.004) << part.id << ' ' << share;
    }
  }
  EXPECT_GE(wheels, 1);
}

TEST(FurnitureCatalogue, AParallelGripperHoldsEveryHandleAtItsGraspFrame) {
  for (const Part& part : SomeParts()) {
    if (part.role != PartRole::kHandle) continue;
    TriangleMesh handle;
    for (const PartPiece& piece : part.pieces) {
      const int offset = static_cast<int>(handle.vertices.size());
      handle.vertices.insert(handle.vertices.end(), piece.mesh.vertices.begin(),
                             piece.mesh.vertices.end());
      for (const Eigen::Vector3i& t : piece.mesh.triangles)
        handle.triangles.emplace_back(t.array() + offset);
    }
    const GraspFit fit = MeasureGrasp(FindPiece(part, "grip")->mesh, handle, part.part_from_grasp);
    EXPECT_TRUE(fit.holds) << part.id;
    EXPECT_LE(fit.width_m, 0.076) << part.id;
  }
}

// The frame of a cabinet with this carcass: 0.5 m deep, its leaf 0.6 m wide and 0.7 m high.
TriangleMesh FrameWith(const std::string& carcass) {
  const std::filesystem::path data = ScratchFolder("furniture") / "data";
  std::filesystem::remove_all(data);
  CommitFile(data / "catalog/storagefurniture/bodies/a.yaml",
             "schema: doorforge.recipe\nschema_version: 1\nid: a\nfamily: storage_slab\n"
             "license: CC0-1.0\nparameters: {leaf_width_m: 0.6, leaf_height_m: 0.7, thickness_m: "
             "0.03, mount_height_m: 0.35, carcass: {depth_m: 0.5, " +
                 carcass + "}}\n");
  return FindPiece(BuildCataloguePart(data, "a"), "frame")->mesh;
}

// Where the line along an axis crosses the mesh; `at`: its place on the next two axes.
std::vector<double> Crossings(const TriangleMesh& mesh, int along, const Eigen::Vector2d& at) {
  const int u = (along + 1) % 3;
  const int v = (along + 2) % 3;
  std::vector<double> places;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    std::array<double, 3> areas{};  // each opposite to the corner before its edge
    double place = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[k])];
      const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
      const double area = (a[u] - at.x()) * (b[v] - at.y()) - (a[v] - at.y()) * (b[u] - at.x());
      areas.at(static_cast<std::size_t>(k)) = area;
      place += area * mesh.vertices[static_cast<std::size_t>(t[(k + 2) % 3])][along];
    }
    const auto [least, most] = std::ranges::minmax(areas);
    if (least > 0 || most < 0) places.push_back(place / (areas[0] + areas[1] + areas[2]));
  }
  std::ranges::sort(places);
  return places;
}

// How often the line through (x, z) along y crosses the frame, and that through (y, z) along x.
std::pair<int, int> CrossingsOfFrame(const std::string& carcass) {
  const TriangleMesh frame = FrameWith("shelves: 0, " + carcass);
  const auto count = [&](int along, const Eigen::Vector2d& at) {
    return static_cast<int>(Crossings(frame, along, at).size());
  };
  // off the middle, where no triangle has an edge
  return {count(1, {0.4321, -0.2718}), count(0, {0.2917, 0.4321})};
}

TEST(FurnitureCatalogue, OpenSidesAndBacksOfCabinetsCanBeLookedThrough) {
  // two walls, two surfaces each; one back
  EXPECT_EQ(CrossingsOfFrame("sides: panel"), std::pair(4, 2));
  EXPECT_EQ(CrossingsOfFrame("sides: open"), std::pair(0, 2));
  EXPECT_EQ(CrossingsOfFrame("sides: open, back: false"), std::pair(0, 0));
  EXPECT_EQ(CrossingsOfFrame("sides: panel, back: false"), std::pair(4, 0));
}

TEST(FurnitureCatalogue, ShelvesAndDividersStandWhereTheRecipeSays) {
  const Eigen::Vector2d at_rear(-0.4321, 0.2917);  // x, y
  const double low = 0.09 + 0.003;                 // the leaf, above the base
  const auto heights = [](const TriangleMesh& frame, const Eigen::Vector2d& at) {
    std::vector<double> inside;
    for (const double z : Crossings(frame, 2, at)) {
      if (z > 0.13 && z < 0.76) inside.push_back(z);  // not of bottom and top
    }
    return inside;
  };
  const TriangleMesh graded = FrameWith("shelves: 2, shelf_grading: 1.5, shelf_depth: 0.5");
  const std::vector<double> faces = heights(graded, at_rear);
  ASSERT_EQ(faces.size(), 4U);
  EXPECT_NEAR((faces[0] + faces[1]) / 2, low + 0.7 * std::pow(1.0 / 3, 1.5), 1e-6);
  EXPECT_NEAR((faces[2] + faces[3]) / 2, low + 0.7 * std::pow(2.0 / 3, 1.5), 1e-6);
  EXPECT_TRUE(heights(graded, {-0.1234, 0.2917}).empty()) << "half as deep as the room";
  const TriangleMesh divided = FrameWith("shelves: 1, dividers: 2");
  EXPECT_EQ(Crossings(divided, 1, {0.2718, -0.4321}).size(), 8U) << "sides and dividers";
  EXPECT_EQ(Crossings(divided, 1, {0.6543, -0.4321}).size(), 4U) << "above the shelf, sides alone";
}

TEST(FurnitureCatalogue, SafesAreUnlockedByAKeyOrAValveAndRefrigeratorsByALever) {
  for (const CatalogueEntry& entry : Entries()) {
    if (entry.role != PartRole::kHandle) continue;
    if (entry.category == Category::kSafe) {
      EXPECT_TRUE(entry.mechanism == Mechanism::kKey || entry.mechanism == Mechanism::kValve)
          << entry.id;
    } else if (entry.category == Category::kRefrigerator) {
      EXPECT_EQ(entry.mechanism, Mechanism::kLever) << entry.id;
    }
  }
}

}  // namespace
}  // namespace doorforge
