// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/compose/compose.h"
#include "doorforge/core/closed_mesh.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/validate/validate_door.h"

#include "catalogue_parts.h"
#include "scratch_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const std::vector<CatalogueEntry>& InteriorEntries() {
  static const std::vector<CatalogueEntry> kEntries = [] {
    std::vector<CatalogueEntry> interior;
    for (const CatalogueEntry& entry : ListCatalogue(DataOfSource())) {
      if (entry.category == Category::kInterior) interior.push_back(entry);
    }
    return interior;
  }();
  return kEntries;
}

std::vector<Part> PartsOf(const std::string& family) {
  std::vector<Part> parts;
  for (const CatalogueEntry& entry : InteriorEntries()) {
    if (entry.family == family) parts.push_back(PartNamed(entry.id));
  }
  return parts;
}

// Triangles that the line along x through (y, z) crosses, and whether it meets the mesh at all.
int CrossingsAlongX(const TriangleMesh& mesh, const Eigen::Vector2d& at) {
  int crossings = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    double area[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[k])];
      const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
      area[k] = (a.y() - at.x()) * (b.z() - at.y()) - (a.z() - at.y()) * (b.y() - at.x());
    }
    crossings +=
        (area[0] > 0 && area[1] > 0 && area[2] > 0) || (area[0] < 0 && area[1] < 0 && area[2] < 0);
  }
  return crossings;
}

// Share of a grid of lines along x over the middle of a leaf that pass it freely.
double OpenShare(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3d bounds = MeasureTopology(mesh).bounds;
  int open = 0;
  int all = 0;
  for (int i = 0; i < 23; ++i) {
    for (int j = 0; j < 47; ++j) {
      const Eigen::Vector2d share((i + 0.37) / 23, (j + 0.41) / 47);
      const Eigen::Vector2d low(bounds.min().y(), bounds.min().z());
      const Eigen::Vector2d size(bounds.sizes().y(), bounds.sizes().z());
      open += CrossingsAlongX(mesh, low + share.cwiseProduct(size)) == 0;
      ++all;
    }
  }
  return static_cast<double>(open) / all;
}

TriangleMesh Together(const std::vector<TriangleMesh>& hulls) {
  TriangleMesh all;
  for (const TriangleMesh& hull : hulls) {
    const int offset = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), hull.vertices.begin(), hull.vertices.end());
    for (const Eigen::Vector3i& t : hull.triangles) all.triangles.emplace_back(t.array() + offset);
  }
  return all;
}

TEST(InteriorCatalogue, IsOfManyFamilies) {
  std::map<std::string, std::set<std::string>> families;
  for (const CatalogueEntry& entry : InteriorEntries()) {
    const std::string kind =
        std::string(NameOf(entry.role)) + " " + std::string(NameOf(entry.mechanism));
    families[kind].insert(entry.family);
  }
  EXPECT_GE(families["body none"].size(), 8u);
  EXPECT_GE(families["handle lever"].size(), 8u);
  EXPECT_GE(families["handle round"].size(), 6u);
}

// What a ray passes a collision shape must not fill.
TEST(InteriorCatalogue, OpeningsGoThroughTheLeafAndItsCollisionShapes) {
  for (const char* family : {"interior_glazed", "interior_vision"}) {
    for (const Part& part : PartsOf(family)) {
      const PartPiece& leaf = *FindPiece(part, "leaf");
      const double open = OpenShare(leaf.mesh);
      EXPECT_GT(open, 0.015) << part.id;
      EXPECT_NEAR(OpenShare(Together(leaf.hulls)), open, 0.012) << part.id;
    }
  }
}

TEST(InteriorCatalogue, NothingIsSeenThroughFlushPlankedAndLouvredLeaves) {
  for (const char* family : {"interior_flush", "interior_planked", "interior_moulded"}) {
    for (const Part& part : PartsOf(family))
      EXPECT_EQ(OpenShare(FindPiece(part, "leaf")->mesh), 0) << part.id;
  }
}

TEST(InteriorCatalogue, SlatsOverlapAsSeenFromTheFrontAndLeaveOnlyASlitAtTheEnds) {
  for (const Part& part : PartsOf("interior_louvred"))
    EXPECT_LT(OpenShare(FindPiece(part, "leaf")->mesh), 0.03) << part.id;
}

TEST(InteriorCatalogue, AnArchedHeadIsHighestInTheMiddle) {
  int arched = 0;
  for (const Part& part : PartsOf("interior_arched")) {
    const TriangleMesh& leaf = FindPiece(part, "leaf")->mesh;
    const Eigen::AlignedBox3d bounds = MeasureTopology(leaf).bounds;
    double corner = 0;
    for (const Eigen::Vector3d& v : leaf.vertices)
      corner = v.y() < bounds.min().y() + 0.001 ? std::max(corner, v.z()) : corner;
    if (corner > bounds.max().z() - 0.01) continue;
    ++arched;
    EXPECT_NEAR(CrossingsAlongX(leaf, {bounds.min().y() + 0.01, bounds.max().z() - 0.01}), 0, 0)
        << part.id;
    EXPECT_GT(CrossingsAlongX(leaf, {bounds.center().y() + 0.0013, bounds.max().z() - 0.01}), 0)
        << part.id;
  }
  EXPECT_GE(arched, 1);
}

TEST(InteriorCatalogue, ADoubleDoorsSecondLeafStaysWithTheFrame) {
  for (const Part& part : PartsOf("interior_double")) {
    const double edge = MeasureTopology(FindPiece(part, "leaf")->mesh).bounds.max().y();
    // the fixed leaf's edge, 4 mm beyond the moving leaf's
    EXPECT_EQ(CrossingsAlongX(FindPiece(part, "frame")->mesh, {edge + 0.002, 0.81}), 0) << part.id;
    EXPECT_EQ(CrossingsAlongX(FindPiece(part, "frame")->mesh, {edge + 0.0413, 0.813}), 2)
        << part.id;
  }
}

TEST(InteriorCatalogue, ABodyOfEveryFamilyTakesAHandleOfEveryFamilyWithoutAFinding) {
  std::map<std::string, Part> bodies;
  std::vector<Part> handles;
  std::set<std::string> seen;
  for (const CatalogueEntry& entry : InteriorEntries()) {
    if (!seen.insert(entry.family).second) continue;
    if (entry.role == PartRole::kBody)
      bodies.emplace(entry.family, PartNamed(entry.id));
    else
      handles.push_back(PartNamed(entry.id));
  }
  std::size_t next = 0;
  for (const auto& [family, body] : bodies) {
    for (int k = 0; k < 2; ++k) {
      const Part& handle = handles[next++ % handles.size()];
      const DoorAsset door = ComposeDoor(body, handle, {});
      const fs::path folder = ScratchFolder("interior_catalogue") / door.id;
      WriteDoorFolder(door, folder, Existing::kReplace);
      const ValidationReport report = ValidateDoor(folder);
      EXPECT_TRUE(report.findings.empty()) << ToJson(std::span(&report, 1)).dump(2);
    }
  }
}

}  // namespace
}  // namespace doorforge
