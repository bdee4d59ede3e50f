// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/repair_mesh.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

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

TEST(RepairMesh, FillsAFlatHoleThatIsSmallBesideItsPiece) {
  // a long bar without one end: the end is 1/40 of the area
  TriangleMesh bar = Box(Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0.1, 0.1));
  bar.triangles.resize(10);
  const RepairResult result = Repaired(bar);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kRepaired);
  EXPECT_NEAR(VolumeAfter(result), 0.01, 1e-15);
}

TEST(RepairMesh, WrapsAnOpenBoxWithoutClosingItsOpening) {
  TriangleMesh open = UnitBox();
  open.triangles.resize(10);
  const RepairResult result = Repaired(open, Coarse());
  EXPECT_EQ(result.report.outcome, RepairOutcome::kWrapped);
  EXPECT_EQ(result.report.reason, "1 piece of 1 could not be closed");
  // five walls of twice the offset, not the box
  const double thickness = 2 * std::sqrt(3.0) * 0.005;
  EXPECT_NEAR(VolumeAfter(result), 5 * thickness, 0.5 * 5 * thickness);
  EXPECT_LT(result.report.visible_input_to_output.max_m, 0.1);
  EXPECT_FALSE(result.report.steps.empty());
}

TEST(RepairMesh, KeepsPiecesThatBarelyOverlapAndWrapsThoseThatShareMuch) {
  const auto overlapping = [](double by) {
    return Together(UnitBox(),
                    Box(Eigen::Vector3d(1 - by, 0.1, 0.1), Eigen::Vector3d(2 - by, 0.9, 0.9)));
  };
  const RepairResult little = Repaired(overlapping(0.01));
  EXPECT_EQ(little.report.outcome, RepairOutcome::kAlreadyClosed);
  EXPECT_TRUE(little.report.self_intersects);
  EXPECT_NEAR(little.report.overlap_fraction, 0.0064 / 1.64, 2e-4);
  const RepairResult much = Repaired(overlapping(0.5), Coarse());
  EXPECT_EQ(much.report.outcome, RepairOutcome::kWrapped);
  EXPECT_EQ(much.report.after.components, 1);
  EXPECT_NEAR(VolumeAfter(much), 1.32, 0.1);
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
  const RepairResult result = Repaired(sheet, Coarse());
  ASSERT_EQ(result.report.outcome, RepairOutcome::kWrapped);
  const double offset = std::sqrt(2.0) * 0.005;
  EXPECT_NEAR(result.report.after.bounds.sizes().z(), 2 * offset, 0.2 * offset);
  EXPECT_NEAR(result.report.output_to_input.mean_m, offset, 0.3 * offset);
}

TEST(RepairMesh, SaysWhyItFailsWhereItMayNotWrap) {
  RepairConfig config;
  config.wrap = "never";
  TriangleMesh open = UnitBox();
  open.triangles.resize(10);
  const RepairResult result = Repaired(open, config);
  EXPECT_EQ(result.report.outcome, RepairOutcome::kFailed);
  EXPECT_FALSE(result.mesh);
  EXPECT_EQ(result.report.reason, "1 piece of 1 could not be closed");
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

TEST(RepairMesh, WrapsAndSimplifiesToTheSameBytesTwice) {
  TriangleMesh open = Torus(1, 0.3, 24, 12);
  open.triangles.resize(400);
  RepairConfig config = Coarse();
  config.max_triangles = 500;
  const RepairResult a = Repaired(open, config);
  const RepairResult b = Repaired(open, config);
  ASSERT_EQ(a.report.outcome, RepairOutcome::kWrapped);
  EXPECT_EQ(ToJson(a.report).dump(), ToJson(b.report).dump());
  EXPECT_EQ(a.mesh->mesh().vertices, b.mesh->mesh().vertices);
  EXPECT_EQ(a.mesh->mesh().triangles, b.mesh->mesh().triangles);
}

TEST(RepairMesh, RefusesSettingsOutOfRange) {
  RepairConfig config;
  config.wrap = "sometimes";
  EXPECT_THROW(Repaired(UnitBox(), config), Error);
  config = {};
  config.alpha_fraction = 0;
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
