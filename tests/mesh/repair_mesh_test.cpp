// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/repair_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"

#include "repair/collapse_edges.h"
#include "repair/separate_pieces.h"
#include "repair/solid_shells.h"
#include "repair/surface_operations.h"
#include "shapes.h"

namespace doorforge {
namespace {

RepairResult Repaired(const TriangleMesh& mesh, const RepairConfig& config = {}) {
  return RepairMesh(mesh, config);
}

// A wrap of few triangles, which is quick to make.
RepairConfig Coarse() {
  RepairConfig config;
  config.alpha_fraction = 0.05;
  config.offset_fraction = 0.005;
  return config;
}

double VolumeAfter(const RepairResult& result) { return result.report.after.volume_m3; }

TEST(RepairMesh, LeavesAClosedMeshAsItIs) {
  const RepairResult result = Repaired(UnitBox());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kAlreadyClosed);
  ASSERT_TRUE(result.mesh);
  EXPECT_EQ(result.mesh->mesh().triangles.size(), 12U);
  EXPECT_NEAR(VolumeAfter(result), 1, 1e-15);
  EXPECT_LT(result.report.output_to_input.max_m, 1e-12);
  EXPECT_FALSE(result.report.self_intersects);
}

TEST(RepairMesh, KeepsACavityOfAClosedMesh) {
  const RepairResult result = Repaired(Together(
      UnitBox(), InsideOut(Box(Eigen::Vector3d(0.2, 0.2, 0.2), Eigen::Vector3d(0.7, 0.7, 0.7)))));
  EXPECT_EQ(result.report.outcome, RepairOutcome::kAlreadyClosed);
  EXPECT_NEAR(VolumeAfter(result), 1 - 0.125, 1e-12);
}

TEST(RepairMesh, TurnsAPieceThatIsInsideOut) {
  const RepairResult result = Repaired(Together(
      UnitBox(), InsideOut(Box(Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(2.5, 0.5, 0.5)))));
  EXPECT_NEAR(VolumeAfter(result), 1.125, 1e-12);
}

TEST(RepairMesh, MakesOneSurfaceOfLooseTurnedAndDoubledTriangles) {
  TriangleMesh soup = Unwelded(Torus(1, 0.3, 30, 15));
  for (std::size_t i = 0; i < soup.triangles.size(); i += 3)
    std::swap(soup.triangles[i][0], soup.triangles[i][1]);
  for (std::size_t i = 0; i < 100; i += 2) soup.triangles.push_back(soup.triangles[i]);
  soup.triangles.emplace_back(5, 5, 6);
  const RepairResult result = Repaired(soup);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_EQ(result.report.after.components, 1);
  EXPECT_EQ(result.mesh->mesh().triangles.size(), 900U);
  EXPECT_NEAR(VolumeAfter(result), MeasureTopology(Torus(1, 0.3, 30, 15)).volume_m3, 1e-9);
}

TEST(RepairMesh, FillsASmallHole) {
  TriangleMesh mesh = Torus(1, 0.3, 120, 60);
  mesh.triangles.erase(mesh.triangles.begin() + 100, mesh.triangles.begin() + 104);
  const RepairResult result = Repaired(mesh);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_EQ(result.report.holes_filled, 1);
  EXPECT_LT(result.report.output_to_input.max_m, 0.02);
}

// A long bar without one end: the end is 1/40 of the area, and its middle 50 mm from the border.
TriangleMesh BarWithoutEnd() {
  TriangleMesh bar = Box(Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0.1, 0.1));
  bar.triangles.resize(10);
  return bar;
}

TEST(RepairMesh, FillsAFlatHoleThatIsSmallBesideItsPieceWhereCapsMayBeFar) {
  RepairConfig config;
  config.max_cap_fraction = 1;
  const RepairResult result = Repaired(BarWithoutEnd(), config);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_NEAR(VolumeAfter(result), 0.01, 1e-15);
}

TEST(RepairMesh, MakesWallsWhereACapWouldLieFarFromTheSurface) {
  const RepairResult result = Repaired(BarWithoutEnd());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_EQ(result.report.holes_filled, 0);
  EXPECT_EQ(result.report.sheets_thickened, 1);
  const double half = result.report.before.bounds.diagonal().norm() / 1200;
  EXPECT_LT(result.report.output_to_input.max_m, 2 * half);
  // four sides and one end, 0.41 m2
  EXPECT_NEAR(VolumeAfter(result), 0.41 * 2 * half, 0.02 * 0.41 * 2 * half);
}

// The distance decides, not the size: the plate behind the hole keeps the cap near.
TEST(RepairMesh, FillsAHoleWhoseCapKeepsNearAnotherPiece) {
  const TriangleMesh plate =
      Box(Eigen::Vector3d(1.002, -0.1, -0.1), Eigen::Vector3d(1.1, 0.2, 0.2));
  const RepairResult result = Repaired(Together(BarWithoutEnd(), plate));
  EXPECT_EQ(result.report.holes_filled, 1);
  EXPECT_NEAR(VolumeAfter(result), 0.01 + 0.098 * 0.09, 1e-9);
}

// A box with one corner pulled out through the opposite sides.
TriangleMesh CrossingItself() {
  TriangleMesh mesh = UnitBox();
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    if (vertex.isApprox(Eigen::Vector3d::Ones())) vertex = {-0.5, 0.3, 0.2};
  }
  return mesh;
}

TEST(RepairMesh, MakesWallsOfAnOpenBoxWithoutClosingItsOpening) {
  TriangleMesh open = UnitBox();
  open.triangles.resize(10);
  const RepairResult result = Repaired(open, Coarse());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_EQ(result.report.sheets_thickened, 1);
  EXPECT_FALSE(result.report.self_intersects);
  // a box around less a box within, both cut off at the opening
  const double half = std::sqrt(3.0) * 0.005;
  const auto box = [](double by) { return std::pow(1 + 2 * by, 2) * (1 + by); };
  EXPECT_NEAR(VolumeAfter(result), box(half) - box(-half), 0.01 * box(half));
  EXPECT_LT(result.report.visible_input_to_output.max_m, 1.01 * half);
  EXPECT_FALSE(result.report.steps.empty());
}

TEST(RepairMesh, MakesOneSolidOfASurfaceThatCrossesItself) {
  const RepairResult result = Repaired(CrossingItself());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_FALSE(result.report.self_intersects);
  EXPECT_EQ(result.report.after.components, 1);
  const double half = result.report.before.bounds.diagonal().norm() / 1200;
  EXPECT_LT(result.report.visible_input_to_output.max_m, 3.1 * half);
  EXPECT_LT(result.report.output_to_input.max_m, 3.1 * half);
}

// A strip bent to an eight, open above and below: no sharp edge to cut it at.
TriangleMesh BentToAnEight() {
  TriangleMesh eight;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 2 * std::numbers::pi * (i + 0.5) / kSteps;
    for (const double z : {0.0, 0.5}) eight.vertices.emplace_back(std::sin(t), std::sin(2 * t), z);
    const int a = 2 * i;
    const int b = 2 * ((i + 1) % kSteps);
    eight.triangles.emplace_back(a, b, a + 1);
    eight.triangles.emplace_back(b, b + 1, a + 1);
  }
  return eight;
}

TEST(RepairMesh, MakesWallsOfASheetThatCrossesItself) {
  const RepairResult result = Repaired(BentToAnEight());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_FALSE(result.report.self_intersects);
  const double half = result.report.before.bounds.diagonal().norm() / 1200;
  const double area = result.report.before.area_m2;
  EXPECT_NEAR(VolumeAfter(result), 2 * half * area, 0.1 * half * area);
}

TEST(RepairMesh, UnitesPiecesThatOverlapOrOnlyTouch) {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double volume_m3;
  };
  using Eigen::Vector3d;
  const Case cases[] = {
      {"overlapping little",
       Together(UnitBox(), Box(Vector3d(0.99, 0.1, 0.1), Vector3d(1.99, 0.9, 0.9))),
       1 + 0.64 - 0.0064},
      {"overlapping much",
       Together(UnitBox(), Box(Vector3d(0.5, 0.1, 0.1), Vector3d(1.5, 0.9, 0.9))), 1.32},
      {"on top of each other, flush on two sides",
       Together(UnitBox(), Box(Vector3d(0, 0.1, 1), Vector3d(1, 0.9, 1.5))), 1.4},
      {"a corner shared", Together(UnitBox(), Box(Vector3d(0.5, 0.5, 0.5), Vector3d(1, 1, 1))), 1},
      {"edge to edge", Together(UnitBox(), Box(Vector3d(1, 1, 0), Vector3d(2, 2, 1))), 2}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    const RepairResult result = Repaired(one.mesh);
    EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
    EXPECT_FALSE(result.report.self_intersects);
    EXPECT_NEAR(VolumeAfter(result), one.volume_m3, 2e-3 * one.volume_m3);
    EXPECT_LT(result.report.visible_input_to_output.max_m, 1e-3);
    EXPECT_LT(result.report.output_to_input.max_m, 1e-3);
    // no triangle loses its area, or the mesh its closedness, at the precision of mesh files
    const TriangleMesh rounded = RoundedToFloat(result.mesh->mesh());
    EXPECT_TRUE(ClosedMesh::From(rounded));
    EXPECT_EQ(MeasureTopology(rounded).degenerate_triangles, 0);
  }
}

TEST(RepairMesh, UnitesPiecesToTheSameBytesTwice) {
  const TriangleMesh boxes =
      Together(UnitBox(), Box(Eigen::Vector3d(0, 0.1, 1), Eigen::Vector3d(1, 0.9, 1.5)));
  const RepairResult a = Repaired(boxes);
  const RepairResult b = Repaired(boxes);
  EXPECT_EQ(a.mesh->mesh().vertices, b.mesh->mesh().vertices);
  EXPECT_EQ(a.mesh->mesh().triangles, b.mesh->mesh().triangles);
}

// CGAL orders some of what it makes by addresses; what was done before must not matter.
TEST(RepairMesh, UnitesPiecesToTheSameBytesOnAnotherHeap) {
  TriangleMesh crossing = Torus(1, 0.3, 24, 12);
  crossing.vertices[0] = {-2, 0.1, 0.1};
  const RepairResult a = Repaired(crossing);
  ASSERT_EQ(a.report.outcome, RepairOutcome::kRepaired) << a.report.reason;
  std::vector<std::vector<char>> blocks;
  for (std::size_t i = 0; i < 40000; ++i) blocks.emplace_back(24 + 40 * (i * i % 97));
  for (std::size_t i = 0; i < blocks.size(); i += 1 + i % 3) blocks[i] = {};
  const RepairResult b = Repaired(crossing);
  EXPECT_EQ(a.mesh->mesh().vertices, b.mesh->mesh().vertices);
  EXPECT_EQ(a.mesh->mesh().triangles, b.mesh->mesh().triangles);
}

// What is allocated while they are held lies among them, in another order for each seed.
std::vector<std::vector<char>> ScatteredBlocks(unsigned seed) {
  std::minstd_rand random(seed);
  std::vector<std::vector<char>> blocks;
  for (int i = 0; i < 2000; ++i) blocks.emplace_back(500 + random() % 20000);
  std::shuffle(blocks.begin(), blocks.end(), random);
  blocks.resize(1000);
  return blocks;
}

// Without its base, that a cap of many triangles fills, of which others are as good.
TriangleMesh TurnedCone(int sides) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  TriangleMesh cone{{{0, 0, -30}}, {}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    cone.vertices.push_back(turn * Eigen::Vector3d(25 * std::cos(angle), 25 * std::sin(angle), 0));
    cone.triangles.emplace_back(i + 1, (i + 1) % sides + 1, 0);
  }
  return cone;
}

TEST(RepairMesh, FillsAHoleWithTheSameTrianglesOnAnotherHeap) {
  const HoleLimits all = {.max_size_m = 100, .max_cap_distance_m = 100};
  for (const int sides : {12, 40}) {
    const TriangleMesh cone = TurnedCone(sides);
    const ClosedSoup first = CloseSoup(cone, all, cone);
    ASSERT_EQ(first.holes_filled, 1);
    ASSERT_EQ(static_cast<int>(first.mesh.triangles.size()), 2 * sides - 2);
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const auto held = ScatteredBlocks(seed);
      ASSERT_EQ(CloseSoup(cone, all, cone).mesh.triangles, first.mesh.triangles)
          << sides << ' ' << seed;
    }
  }
}

TEST(RepairMesh, DropsAPieceHiddenInsideAnother) {
  TriangleMesh mesh =
      Together(UnitBox(), Box(Eigen::Vector3d(0.2, 0.2, 0.2), Eigen::Vector3d(0.7, 0.7, 0.7)));
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);  // so that it is not closed already
  const RepairResult result = Repaired(mesh);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_EQ(result.report.components_dropped, 1);
  EXPECT_NEAR(VolumeAfter(result), 1, 1e-12);
}

TEST(RepairMesh, ThickensASheetByItsOffset) {
  const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const double offset = std::sqrt(2.0) * 0.005;
  const RepairResult wall = Repaired(sheet, Coarse());
  ASSERT_EQ(wall.report.outcome, RepairOutcome::kRepaired);
  EXPECT_EQ(wall.mesh->mesh().triangles.size(), 12U);
  EXPECT_NEAR(VolumeAfter(wall), 2 * offset, 0.01 * offset);
  RepairConfig config = Coarse();
  config.wrap = WrapUse::kAlways;
  const RepairResult wrap = Repaired(sheet, config);
  ASSERT_EQ(wrap.report.outcome, RepairOutcome::kWrapped);
  EXPECT_NEAR(wrap.report.after.bounds.sizes().z(), 2 * offset, 0.2 * offset);
  EXPECT_NEAR(wrap.report.output_to_input.mean_m, offset, 0.3 * offset);
}

// A sheet drawn with both its sides, without a common edge between their triangles.
TEST(RepairMesh, MakesAWallOfASheetWithTwoSides) {
  const RepairResult result = Repaired(FlatPillow(), Coarse());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_FALSE(result.report.self_intersects);
  const double half = std::sqrt(2.0) * 0.005;
  EXPECT_NEAR(VolumeAfter(result), 2 * half, 0.2 * half);
}

// Beside a sheet with two sides a strip that is closed like it, hardly wider than what is welded.
TEST(RepairMesh, DropsAClosedStripThatIsTooNarrowForAWall) {
  TriangleMesh strip = FlatPillow();
  for (Eigen::Vector3d& vertex : strip.vertices)
    vertex = Eigen::Vector3d(vertex.x(), 4e-6 * vertex.y(), 0.025);
  RepairConfig config = Coarse();
  config.offset_fraction = 0.02;
  const RepairResult result = Repaired(Together(FlatPillow(), strip), config);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_EQ(result.report.components_dropped, 1);
  const double half = result.report.before.bounds.diagonal().norm() * 0.02;
  EXPECT_NEAR(VolumeAfter(result), 2 * half, 0.2 * half);
}

// Two sheets that cross, so that each of their triangles becomes a wall, and on one a triangle
// without width whose middle vertex is on its longest edge.
TEST(RepairMesh, LeavesTrianglesWithoutWidthOutOfItsWalls) {
  TriangleMesh sheets{{{0, 0, 0},
                       {1, 0, 0},
                       {1, 1, 0},
                       {0, 1, 0},
                       {0.5, 1e-17, 0},
                       {0.5, 0.5, -0.5},
                       {0.5, 0.5, 0.5},
                       {0.5, -0.5, 0.5}},
                      {{0, 4, 1}, {0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
  const RepairResult result = Repaired(sheets, Coarse());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_FALSE(result.report.self_intersects);
  EXPECT_LT(result.report.visible_input_to_output.max_m, 0.01 * std::sqrt(2.5));
}

// Where three sheets meet in one edge, none of them is a surface with the others.
TEST(RepairMesh, UnitesSheetsThatMeetInOneEdge) {
  TriangleMesh sheets{{{0, 0, 0}, {1, 0, 0}}, {}};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    const Eigen::Vector3d out(0, std::cos(angle), std::sin(angle));
    const int first = static_cast<int>(sheets.vertices.size());
    sheets.vertices.push_back(out);
    sheets.vertices.push_back(Eigen::Vector3d::UnitX() + out);
    sheets.triangles.emplace_back(0, 1, first + 1);
    sheets.triangles.emplace_back(0, first + 1, first);
  }
  const RepairResult result = Repaired(sheets, Coarse());
  ASSERT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_FALSE(result.report.self_intersects);
  EXPECT_EQ(result.report.after.components, 1);
  const double half = result.report.before.bounds.diagonal().norm() * 0.005;
  EXPECT_NEAR(VolumeAfter(result), 3 * 2 * half, 0.1 * half);
}

// One vertex of it lies beyond the other side of its tube.
TriangleMesh PiercedTorus() {
  TriangleMesh torus = Torus(1, 0.3, 60, 30);
  const auto outermost = std::max_element(
      torus.vertices.begin(), torus.vertices.end(),
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.x() < b.x(); });
  outermost->x() = 0.6;
  return torus;
}

TEST(WithCrossingsMended, DrawsAnewOnlyWhatCrosses) {
  const TriangleMesh pierced = PiercedTorus();
  ASSERT_TRUE(SelfIntersects(pierced));
  const std::optional<TriangleMesh> mended = WithCrossingsMended(pierced);
  ASSERT_TRUE(mended);
  EXPECT_TRUE(ClosedMesh::From(*mended));
  EXPECT_FALSE(SelfIntersects(*mended));
  const double volume = VolumeOf(Torus(1, 0.3, 60, 30));
  EXPECT_NEAR(VolumeOf(*mended), volume, 0.01 * volume);
  const auto stays = [&](const Eigen::Vector3d& vertex) {
    return std::find(mended->vertices.begin(), mended->vertices.end(), vertex) !=
           mended->vertices.end();
  };
  const auto kept = std::count_if(pierced.vertices.begin(), pierced.vertices.end(), stays);
  EXPECT_GT(kept, static_cast<std::ptrdiff_t>(0.97 * pierced.vertices.size()));
}

TEST(WithCrossingsMended, IsTheSameOnAnotherHeap) {
  const TriangleMesh pierced = PiercedTorus();
  const std::optional<TriangleMesh> first = WithCrossingsMended(pierced);
  ASSERT_TRUE(first);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto held = ScatteredBlocks(seed);
    const std::optional<TriangleMesh> again = WithCrossingsMended(pierced);
    ASSERT_TRUE(again);
    ASSERT_EQ(again->vertices, first->vertices) << seed;
    ASSERT_EQ(again->triangles, first->triangles) << seed;
  }
}

// With one vertex drawn through its tube.
TriangleMesh PiercedTorus(int around, int across) {
  TriangleMesh torus = Torus(1, 0.3, around, across);
  const Eigen::Vector3d ring = Eigen::Vector3d::UnitX();
  torus.vertices[0] = ring - 1.2 * (torus.vertices[0] - ring);
  return torus;
}

TEST(WithCrossingsMended, LeavesManyTrianglesToWhatIsQuicker) {
  EXPECT_TRUE(WithCrossingsMended(PiercedTorus(60, 30)));
  const TriangleMesh fine = PiercedTorus(240, 120);
  EXPECT_LE(CrossingTriangles(fine).size(), 50U);
  EXPECT_FALSE(WithCrossingsMended(fine));
}

TEST(WithCrossingsMended, LeavesSolidsThatGoThroughEachOtherToUnions) {
  TriangleMesh other = Torus(1, 0.3, 60, 30);
  for (Eigen::Vector3d& vertex : other.vertices) vertex.x() += 1;
  EXPECT_FALSE(WithCrossingsMended(Together(Torus(1, 0.3, 60, 30), other)));
}

TEST(RepairMesh, WrapsWhatMeetsInMorePairsOfTrianglesThanMayBeUnited) {
  const TriangleMesh boxes =
      Together(UnitBox(), Box(Eigen::Vector3d(0.2, 0.2, 0.5), Eigen::Vector3d(0.8, 0.8, 1.5)));
  RepairConfig config = Coarse();
  EXPECT_EQ(Repaired(boxes, config).report.outcome, RepairOutcome::kRepaired);
  config.max_pairs = 3;
  const RepairResult wrapped = Repaired(boxes, config);
  EXPECT_EQ(wrapped.report.outcome, RepairOutcome::kWrapped);
  EXPECT_NE(wrapped.report.reason.find("more than are left of max_pairs, which is 3"),
            std::string::npos)
      << wrapped.report.reason;
}

TEST(PairBudget, KeepsAnEighthMoreForWhatIsSmall) {
  PairBudget pairs(80);
  EXPECT_TRUE(pairs.Take(75));
  EXPECT_FALSE(pairs.Take(11));
  EXPECT_EQ(pairs.left(), 5u);
  EXPECT_TRUE(pairs.Take(6));
  EXPECT_FALSE(pairs.Take(6));
  EXPECT_TRUE(pairs.Take(5));
  EXPECT_TRUE(pairs.Take(4));
  EXPECT_FALSE(pairs.Take(1));
}

// A rack of 4 x 6 compartments, each of five boards of its own, flush with those beside them: more
// pairs of triangles than are drawn often.
TEST(RepairMesh, UnitesARackOfBoardsThatAreFlush) {
  constexpr double kWide = 0.3, kHigh = 0.25, kDeep = 0.4, kBoard = 0.01;
  TriangleMesh rack;
  const auto board = [&](double x, double z, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high) {
    const Eigen::Vector3d corner(x, 0, z);
    rack = Together(rack, Box(corner + low, corner + high));
  };
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 6; ++row) {
      const double x = column * kWide, z = row * kHigh;
      board(x, z, {0, 0, 0}, {kWide, kDeep, kBoard});
      board(x, z, {0, 0, kHigh - kBoard}, {kWide, kDeep, kHigh});
      board(x, z, {0, 0, kBoard}, {kBoard, kDeep, kHigh - kBoard});
      board(x, z, {kWide - kBoard, 0, kBoard}, {kWide, kDeep, kHigh - kBoard});
      board(x, z, {kBoard, kDeep - kBoard, kBoard}, {kWide - kBoard, kDeep, kHigh - kBoard});
    }
  }
  const RepairResult result = Repaired(rack, {.max_pairs = 14'000});
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_FALSE(result.report.self_intersects);
  const double inside = (kWide - 2 * kBoard) * (kDeep - kBoard) * (kHigh - 2 * kBoard);
  const double volume = 24 * (kWide * kDeep * kHigh - inside);
  EXPECT_NEAR(VolumeAfter(result), volume, 0.02 * volume);
}

// Two boxes that share a face, welded; `rest` besides.
TriangleMesh WeldedBoxes(const TriangleMesh& rest = {}) {
  TriangleMesh boxes = Together(UnitBox(), rest);
  const int first = static_cast<int>(boxes.vertices.size());
  const TriangleMesh other = Box({1, 0, 0}, {2, 1, 1});
  boxes.vertices.insert(boxes.vertices.end(), other.vertices.begin(), other.vertices.end());
  // its corners 0, 2, 4 and 6 are 1, 3, 5 and 7 of the unit box
  for (const Eigen::Vector3i& t : other.triangles)
    boxes.triangles.push_back(t.unaryExpr([&](int i) { return i % 2 == 0 ? i + 1 : first + i; }));
  return boxes;
}

TEST(SolidShells, PartsBoxesThatShareAFace) {
  const SolidShells apart = SolidShellsOf(WeldedBoxes(), 1e-6);
  ASSERT_EQ(apart.shells.size(), 2u);
  EXPECT_TRUE(apart.rest.triangles.empty());
  EXPECT_EQ(apart.split_vertices, 4);
  for (const TriangleMesh& shell : apart.shells) {
    EXPECT_TRUE(ClosedMesh::From(shell));
    EXPECT_DOUBLE_EQ(VolumeOf(shell), 1);
  }
}

TEST(SolidShells, LeavesASheetThatIsWeldedToOne) {
  // from an edge of the first box outwards
  const TriangleMesh sheet{{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {{0, 1, 2}}};
  TriangleMesh soup = WeldedBoxes(sheet);
  for (Eigen::Vector3i& t : soup.triangles)
    t = t.unaryExpr([](int i) { return i == 8 ? 0 : i == 9 ? 2 : i; }).eval();
  const SolidShells apart = SolidShellsOf(soup, 1e-6);
  EXPECT_EQ(apart.shells.size(), 2u);
  ASSERT_EQ(apart.rest.triangles.size(), 1u);
  EXPECT_EQ(apart.rest.triangles[0], Eigen::Vector3i(0, 2, 10));
}

// A solid to which only a sheet is welded: the sheet may stand for what the solid lacks elsewhere.
TEST(SolidShells, LeavesASolidThatSharesItsEdgesWithNone) {
  TriangleMesh soup = UnitBox();
  soup.vertices.emplace_back(-1, 0, 0);
  soup.triangles.emplace_back(0, 2, 8);
  const SolidShells none = SolidShellsOf(soup, 1e-6);
  EXPECT_TRUE(none.shells.empty());
  EXPECT_EQ(none.rest.triangles, soup.triangles);
}

TEST(SolidShells, LeavesWhatSharesNoEdgeAsItIs) {
  const TriangleMesh apart = Together(UnitBox(), Box({1, 0, 0}, {2, 1, 1}));
  const SolidShells none = SolidShellsOf(apart, 1e-6);
  EXPECT_TRUE(none.shells.empty());
  EXPECT_EQ(none.rest.triangles, apart.triangles);
}

// Each of its triangles twice, once either way round: no matter between, and none but outside.
TEST(SolidShells, TakesOfBoxesWithTwoSidesTheOuter) {
  TriangleMesh boxes = WeldedBoxes();
  for (const Eigen::Vector3i& t : WeldedBoxes().triangles)
    boxes.triangles.emplace_back(t[0], t[2], t[1]);
  const SolidShells apart = SolidShellsOf(boxes, 1e-6);
  ASSERT_EQ(apart.shells.size(), 2u);
  for (const TriangleMesh& shell : apart.shells) EXPECT_DOUBLE_EQ(VolumeOf(shell), 1);
  EXPECT_TRUE(apart.rest.triangles.empty());
}

TEST(SolidShells, LeavesASheetWithTwoSidesAsItIs) {
  TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                     {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}};
  EXPECT_TRUE(SolidShellsOf(sheet, 1e-6).shells.empty());
}

// The least `max_pairs` with which the mesh is repaired without a wrap.
int PairsNeeded(const TriangleMesh& mesh) {
  int low = 0, high = 20'000;  // not enough, and enough
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    const bool suffices =
        Repaired(mesh, {.wrap = WrapUse::kNever, .max_pairs = middle}).report.outcome ==
        RepairOutcome::kRepaired;
    (suffices ? high : low) = middle;
  }
  return high;
}

// One is a sheet that becomes a union of walls, the other a box with pegs, united later, of more
// pairs than are kept for small unions.
TEST(RepairMesh, CountsThePairsOfAllItsUnionsTogether) {
  TriangleMesh pegs = UnitBox();
  for (const double x : {0.1, 0.4, 0.7}) {
    pegs = Together(pegs, Box(Eigen::Vector3d(x, 0.2, 0.5), Eigen::Vector3d(x + 0.2, 0.4, 1.5)));
    pegs = Together(pegs, Box(Eigen::Vector3d(x, 0.6, 0.5), Eigen::Vector3d(x + 0.2, 0.8, 1.5)));
  }
  for (Eigen::Vector3d& vertex : pegs.vertices) vertex.x() += 2;
  const int of_pegs = PairsNeeded(pegs);
  const int of_both = PairsNeeded(Together(BentToAnEight(), pegs));
  EXPECT_GT(of_pegs, of_both / 8);
  // its walls are as thick as the whole is large
  TriangleMesh sheet =
      Together(BentToAnEight(), Box(Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(3, 1, 1.5)));
  EXPECT_EQ(of_both, PairsNeeded(sheet) + of_pegs);
}

TEST(RepairMesh, SaysWhyItFailsWhereItMayNotWrap) {
  RepairConfig config;
  config.wrap = WrapUse::kNever;
  TriangleMesh crossing = Torus(1, 0.3, 60, 60);
  crossing.vertices[0] = {-2, 0.1, 0.1};
  const RepairResult result = Repaired(crossing, config);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kFailed);
  EXPECT_FALSE(result.mesh);
  EXPECT_EQ(result.report.reason, "a piece of 7200 triangles crosses itself");
}

// Beside an open sheet, of which a wall would be made.
TriangleMesh HopelessBesideASheet() {
  TriangleMesh crossing = Torus(1, 0.3, 60, 60);
  crossing.vertices[0] = {-2, 0.1, 0.1};
  const TriangleMesh sheet{{{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  return Together(crossing, sheet);
}

TEST(RepairMesh, MakesNoWallsWhereAPieceCrossesItselfHopelessly) {
  const RepairResult result = Repaired(HopelessBesideASheet(), {.wrap = WrapUse::kNever});
  EXPECT_EQ(result.report.outcome, RepairOutcome::kFailed);
  EXPECT_EQ(result.report.reason, "a piece of 7200 triangles crosses itself");
  for (const std::string& step : result.report.steps)
    EXPECT_EQ(step.find("made walls"), std::string::npos) << step;
}

TEST(RepairMesh, DropsAHiddenPieceHoweverItCrossesItself) {
  const TriangleMesh mesh = Together(
      Box(Eigen::Vector3d::Constant(-2.5), Eigen::Vector3d::Constant(2.5)), HopelessBesideASheet());
  const RepairResult result = Repaired(mesh, {.wrap = WrapUse::kNever});
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired) << result.report.reason;
  EXPECT_EQ(result.report.components_dropped, 1);
  EXPECT_EQ(result.report.sheets_thickened, 1);
}

TEST(RepairMesh, FailsOnAMeshWithoutAnArea) {
  EXPECT_EQ(Repaired({}).report.outcome, RepairOutcome::kFailed);
  const TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(Repaired(line).report.outcome, RepairOutcome::kFailed);
}

TEST(RepairMesh, KeepsToItsTriangleBudget) {
  const TriangleMesh fine = Torus(1, 0.3, 120, 60);
  RepairConfig config;
  config.max_triangles = 2000;
  const RepairResult result = Repaired(fine, config);
  EXPECT_LE(result.mesh->mesh().triangles.size(), 2000U);
  EXPECT_NEAR(VolumeAfter(result), 2 * std::numbers::pi * std::numbers::pi * 0.09, 0.03);
  config.max_triangles = 0;
  EXPECT_EQ(Repaired(fine, config).mesh->mesh().triangles.size(), 14400U);
}

// A torus within a torus that faces inwards: a wall much thinner than the triangles of a coarse
// mesh.
TriangleMesh ThinTorus(double wall, int around, int across) {
  TriangleMesh wall_mesh = Torus(1, 0.3, around, across);
  const TriangleMesh inner = Torus(1, 0.3 - wall, around, across);
  const auto first = static_cast<int>(wall_mesh.vertices.size());
  wall_mesh.vertices.insert(wall_mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const Eigen::Vector3i& t : inner.triangles)
    wall_mesh.triangles.emplace_back(first + t[0], first + t[2], first + t[1]);
  return wall_mesh;
}

TEST(ReducedWithoutCrossings, KeepsTheSidesOfAThinWallApart) {
  const TriangleMesh wall = ThinTorus(2e-3, 80, 40);
  ASSERT_FALSE(SelfIntersects(wall));
  constexpr int kTarget = 6000;
  ASSERT_TRUE(SelfIntersects(Reduced(wall, kTarget, 0)));  // else this shows nothing
  const TriangleMesh simple = ReducedWithoutCrossings(wall, kTarget, 0);
  EXPECT_TRUE(ClosedMesh::From(simple).has_value());
  EXPECT_FALSE(SelfIntersects(simple));
  EXPECT_LE(simple.triangles.size(), static_cast<std::size_t>(kTarget));
  EXPECT_EQ(simple.vertices, ReducedWithoutCrossings(wall, kTarget, 0).vertices);
}

TEST(ReducedWithoutCrossings, StopsWhereEveryCollapseWouldCross) {
  const TriangleMesh wall = ThinTorus(1e-3, 60, 30);
  const TriangleMesh simple = ReducedWithoutCrossings(wall, 16, 0);
  EXPECT_FALSE(SelfIntersects(simple));
  EXPECT_TRUE(ClosedMesh::From(simple).has_value());
}

// A wall that cannot be had with 100 triangles keeps its form, with more.
TEST(RepairMesh, KeepsNearTheInputWhereFewerTrianglesWouldCross) {
  const TriangleMesh wall = ThinTorus(1e-3, 60, 30);
  RepairConfig config;
  config.wrap = WrapUse::kNever;
  config.max_triangles = 100;
  const RepairResult result = Repaired(wall, config);
  ASSERT_TRUE(result.mesh);
  EXPECT_FALSE(result.report.self_intersects);
  EXPECT_LE(result.mesh->mesh().triangles.size(), 3 * wall.triangles.size() + 5000);
  const double diagonal_m = MeasureTopology(wall).bounds.diagonal().norm();
  EXPECT_LT(result.report.output_to_input.max_m, 0.01 * diagonal_m);
  EXPECT_LT(result.report.visible_input_to_output.max_m, 0.01 * diagonal_m);
}

TEST(RepairMesh, WrapsAndSimplifiesToTheSameBytesTwice) {
  TriangleMesh open = Torus(1, 0.3, 24, 12);
  open.triangles.resize(400);
  RepairConfig config = Coarse();
  config.wrap = WrapUse::kAlways;
  config.max_triangles = 500;
  const RepairResult a = Repaired(open, config);
  const RepairResult b = Repaired(open, config);
  ASSERT_EQ(a.report.outcome, RepairOutcome::kWrapped);
  EXPECT_FALSE(a.report.self_intersects);
  EXPECT_EQ(ToJson(a.report).dump(), ToJson(b.report).dump());
  EXPECT_EQ(a.mesh->mesh().vertices, b.mesh->mesh().vertices);
  EXPECT_EQ(a.mesh->mesh().triangles, b.mesh->mesh().triangles);
}

TEST(RepairMesh, RefusesSettingsOutOfRange) {
  RepairConfig config;
  config.alpha_fraction = 0;
  EXPECT_THROW(Repaired(UnitBox(), config), Error);
  config = {};
  config.max_pairs = -1;
  EXPECT_THROW(Repaired(UnitBox(), config), Error);
}

TEST(RepairMesh, RefusesAVertexThatIsNotFinite) {
  TriangleMesh mesh = UnitBox();
  mesh.vertices[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Repaired(mesh), Error);
}

TEST(RepairReport, ComesBackFromJson) {
  const auto json = ToJson(Repaired(Together(UnitBox(), Unwelded(Torus(3, 0.4, 12, 8)))).report);
  EXPECT_EQ(ToJson(RepairReportFromJson(json, "report")).dump(), json.dump());
}

TEST(RepairReport, OfANewerVersionIsRefused) {
  auto json = ToJson(RepairReport{});
  json["schema_version"] = 2;
  EXPECT_THROW(RepairReportFromJson(json, "report"), Error);
}

}  // namespace
}  // namespace doorforge
