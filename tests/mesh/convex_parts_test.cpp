// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/convex_parts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "convex/convex_region.h"
#include "convex/cover_parts.h"
#include "shapes.h"

namespace doorforge {
namespace {

ClosedMesh Closed(const TriangleMesh& mesh) { return *ClosedMesh::From(mesh); }

bool IsInAPart(const std::vector<TriangleMesh>& parts, const Eigen::Vector3d& point) {
  return std::any_of(parts.begin(), parts.end(), [&](const TriangleMesh& part) {
    return std::all_of(part.triangles.begin(), part.triangles.end(), [&](const auto& t) {
      const Eigen::Vector3d& a = part.vertices[static_cast<std::size_t>(t[0])];
      const Eigen::Vector3d& b = part.vertices[static_cast<std::size_t>(t[1])];
      const Eigen::Vector3d& c = part.vertices[static_cast<std::size_t>(t[2])];
      return (b - a).cross(c - a).dot(point - a) <= 0;
    });
  });
}

// A lever before a rose: neck along x, grip along y, 45 mm of air between grip and rose.
TriangleMesh Lever() {
  return Together(
      Together(Box(Eigen::Vector3d(0, -0.025, -0.025), Eigen::Vector3d(0.01, 0.025, 0.025)),
               Box(Eigen::Vector3d(0.005, -0.01, -0.01), Eigen::Vector3d(0.06, 0.01, 0.01))),
      Box(Eigen::Vector3d(0.055, -0.01, -0.01), Eigen::Vector3d(0.07, 0.13, 0.01)));
}

TEST(ConvexParts, OfABoxAreTheBox) {
  const auto parts = ConvexParts(Closed(UnitBox()), {});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].vertices.size(), 8U);
  EXPECT_NEAR(MeasureTopology(parts[0]).volume_m3, 1, 1e-12);
}

TEST(ConvexParts, OfADoorFrameAreItsFourBars) {
  const ClosedMesh frame = Closed(RectangularRing(1.0, 2.1, 0.06, 0.1));
  const auto parts = ConvexParts(frame, {.max_concavity_m = 0.01});
  EXPECT_EQ(parts.size(), 4U);
  EXPECT_FALSE(IsInAPart(parts, {0.5, 0.05, 1.0}));
  const ConvexPartsFit fit = MeasureConvexParts(frame, parts);
  EXPECT_LT(fit.protrusion_m, 1e-9);
  EXPECT_LT(fit.uncovered_m, 1e-9);
}

TEST(ConvexParts, OfALeverLeaveTheFingerGapFree) {
  const ClosedMesh lever = Closed(Lever());
  const auto parts = ConvexParts(lever, {.max_concavity_m = 0.003});
  EXPECT_LE(parts.size(), 4U);
  const ConvexPartsFit fit = MeasureConvexParts(lever, parts);
  EXPECT_LE(fit.protrusion_m, 0.003);
  EXPECT_LE(fit.uncovered_m, 0.0003);
  for (double y = 0.03; y < 0.13; y += 0.01) {
    for (double x = 0.014; x < 0.051; x += 0.004) EXPECT_FALSE(IsInAPart(parts, {x, y, 0}));
  }
  EXPECT_TRUE(IsInAPart(parts, {0.06, 0.12, 0}));
}

// The grid's bound lets the neck's hull reach into the gap; what is measured does not.
TEST(ConvexParts, AreCutFurtherWhereTheyMeasureMore) {
  const ClosedMesh lever = Closed(Lever());
  const auto coarse = ConvexParts(lever, {.max_concavity_m = 0.02});
  EXPECT_GT(MeasureConvexParts(lever, coarse).protrusion_m, 0.01);
  const auto fine = ConvexParts(lever, {.max_concavity_m = 0.02, .max_protrusion_m = 0.003});
  EXPECT_GT(fine.size(), coarse.size());
  const ConvexPartsFit fit = MeasureConvexParts(lever, fine);
  EXPECT_LE(fit.protrusion_m, 0.003);
  EXPECT_LE(fit.uncovered_m, 0.0005);
  // no room for more
  const auto few =
      ConvexParts(lever, {.max_parts = 2, .max_concavity_m = 0.02, .max_protrusion_m = 0.003});
  EXPECT_EQ(few.size(), coarse.size());
}

// Four levers get as many parts as they need one by one, and no more: none may be left unused.
TEST(ConvexParts, AreAllSpentWhereTheyMeasureMore) {
  const ConvexPartsConfig one{.max_concavity_m = 0.02, .max_protrusion_m = 0.003};
  const std::size_t needed = 4 * ConvexParts(Closed(Lever()), one).size();
  TriangleMesh levers;
  for (int i = 0; i < 4; ++i) {
    TriangleMesh lever = Lever();
    for (Eigen::Vector3d& vertex : lever.vertices) vertex.z() += 0.2 * i;
    levers = Together(levers, lever);
  }
  ConvexPartsConfig all = one;
  all.max_parts = static_cast<int>(needed);
  const auto parts = ConvexParts(Closed(levers), all);
  EXPECT_EQ(parts.size(), needed);
  EXPECT_LE(MeasureConvexParts(Closed(levers), parts).protrusion_m, 0.003);
}

TEST(ConvexParts, OfATorusStayWithinTheConcavityAndCoverIt) {
  const ClosedMesh torus = Closed(Torus(0.05, 0.01, 48, 16));
  const auto parts = ConvexParts(torus, {.max_parts = 32, .max_concavity_m = 0.003});
  const ConvexPartsFit fit = MeasureConvexParts(torus, parts);
  EXPECT_LE(fit.protrusion_m, 0.003);
  EXPECT_LE(fit.uncovered_m, 0.001);
  EXPECT_FALSE(IsInAPart(parts, Eigen::Vector3d::Zero()));
}

// Bars across the panes of a window, 4 by 6.
TriangleMesh LatticeMesh() {
  constexpr double kBar = 0.03;
  TriangleMesh bars;
  for (int i = 0; i <= 4; ++i) {
    const double y = 0.25 * i - kBar / 2;
    bars = Together(bars, Box(Eigen::Vector3d(0, y, 0), Eigen::Vector3d(0.04, y + kBar, 1.63)));
  }
  for (int i = 0; i <= 6; ++i) {
    const double z = 1.6 / 6 * i;
    bars = Together(bars, Box(Eigen::Vector3d(0.002, -kBar / 2, z),
                              Eigen::Vector3d(0.038, 1 + kBar / 2, z + kBar)));
  }
  return bars;
}

// With so few parts the first cuts must be taken back, or some panes stay filled.
TEST(ConvexParts, OfALatticeLeaveItsPanesFree) {
  const ClosedMesh lattice = Closed(LatticeMesh());
  const auto parts = ConvexParts(lattice, {.max_parts = 15, .max_concavity_m = 0.01});
  EXPECT_LE(parts.size(), 15U);
  const ConvexPartsFit fit = MeasureConvexParts(lattice, parts);
  EXPECT_LE(fit.protrusion_m, 0.01);
  EXPECT_LE(fit.uncovered_m, 0.002);
}

// Twelve bars: of twelve parts the first cuts are taken back by a second search, of fourteen those
// are made that only measuring tells of. Without either the parts still cover all.
TEST(ConvexParts, OfASearchThatEndsEarlyCoverTheMeshAllTheSame) {
  const ClosedMesh lattice = Closed(LatticeMesh());
  for (const int max_parts : {12, 14}) {
    SCOPED_TRACE(max_parts);
    ConvexPartsConfig config{
        .max_parts = max_parts, .max_concavity_m = 0.02, .max_protrusion_m = 0.01};
    const auto parts = ConvexParts(lattice, config);
    config.max_search = 1000;
    EXPECT_EQ(ConvexParts(lattice, config).back().vertices, parts.back().vertices);
    config.max_search = 1;
    const auto early = ConvexParts(lattice, config);
    EXPECT_LE(early.size(), static_cast<std::size_t>(max_parts));
    const ConvexPartsFit fit = MeasureConvexParts(lattice, early);
    EXPECT_GT(fit.protrusion_m, 1.5 * MeasureConvexParts(lattice, parts).protrusion_m);
    EXPECT_LE(fit.uncovered_m, 0.005);
  }
}

TEST(ConvexParts, OfAHollowBoxAreItsWalls) {
  const ClosedMesh hollow = Closed(Together(
      UnitBox(),
      InsideOut(Box(Eigen::Vector3d(0.05, 0.05, 0.05), Eigen::Vector3d(0.95, 0.95, 0.95)))));
  const auto parts = ConvexParts(hollow, {.max_concavity_m = 0.02});
  EXPECT_EQ(parts.size(), 6U);
  EXPECT_LE(MeasureConvexParts(hollow, parts).protrusion_m, 0.02);
  EXPECT_FALSE(IsInAPart(parts, {0.5, 0.5, 0.5}));
}

// Walls thinner than the search's grid and than the skin that a cut may shave off.
TEST(ConvexParts, KeepWallsThatAreThinnerThanTheConcavity) {
  const Eigen::Vector3d wall = Eigen::Vector3d::Constant(0.003);
  const Eigen::Vector3d size(0.6, 0.5, 0.8);
  const ClosedMesh hollow =
      Closed(Together(Box(Eigen::Vector3d::Zero(), size), InsideOut(Box(wall, size - wall))));
  const auto parts = ConvexParts(hollow, {.max_concavity_m = 0.02});
  const ConvexPartsFit fit = MeasureConvexParts(hollow, parts);
  EXPECT_LE(fit.uncovered_m, 0.002);
  EXPECT_LE(fit.protrusion_m, 0.02);
  EXPECT_FALSE(IsInAPart(parts, size / 2));
}

// A foil of a twentieth of a millimetre floats beside a lever, as it does in real handles.
TEST(ConvexParts, CoverASliverThatFloatsBesideTheRest) {
  const ClosedMesh lever = Closed(Together(
      Lever(), Box(Eigen::Vector3d(0.08, 0.10, -0.004), Eigen::Vector3d(0.08005, 0.13, 0.004))));
  for (const int max_parts : {32, 3}) {
    SCOPED_TRACE(max_parts);
    const auto parts = ConvexParts(lever, {.max_parts = max_parts, .max_concavity_m = 0.002});
    EXPECT_LE(parts.size(), static_cast<std::size_t>(max_parts));
    const ConvexPartsFit fit = MeasureConvexParts(lever, parts);
    EXPECT_LE(fit.uncovered_m, 0.001);
    if (max_parts == 32) {
      EXPECT_LE(fit.protrusion_m, 0.002);
    }
    // twice its volume is the area of a plate times its thickness
    for (const TriangleMesh& part : parts) {
      const MeshTopology topology = MeasureTopology(part);
      EXPECT_GE(2 * topology.volume_m3, 1.9e-4 * topology.area_m2);
    }
  }
}

TEST(ConvexParts, KeepToTheirNumberAndVertices) {
  const ClosedMesh torus = Closed(Torus(0.05, 0.01, 48, 16));
  const auto parts =
      ConvexParts(torus, {.max_parts = 5, .max_concavity_m = 0.002, .max_vertices = 20});
  EXPECT_LE(parts.size(), 5U);
  for (const TriangleMesh& part : parts) {
    EXPECT_LE(part.vertices.size(), 20U);
    EXPECT_TRUE(ClosedMesh::From(part));
  }
}

TEST(ConvexParts, AreTheSameTwice) {
  const ClosedMesh lever = Closed(Lever());
  const auto a = ConvexParts(lever, {});
  const auto b = ConvexParts(lever, {});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].vertices, b[i].vertices);
    EXPECT_EQ(a[i].triangles, b[i].triangles);
  }
}

TEST(ConvexParts, RefuseSettingsOutOfRange) {
  EXPECT_THROW(ConvexParts(Closed(UnitBox()), {.max_parts = 0}), Error);
  EXPECT_THROW(ConvexParts(Closed(UnitBox()), {.max_concavity_m = 0}), Error);
  EXPECT_THROW(ConvexParts(Closed(UnitBox()), {.max_protrusion_m = -1}), Error);
  EXPECT_THROW(ConvexParts(Closed(UnitBox()), {.max_vertices = 3}), Error);
}

TEST(ConvexPartsFit, MeasuresWhatProtrudesAndWhatIsLeftOut) {
  const std::vector<TriangleMesh> shifted{
      Box(Eigen::Vector3d(0.25, 0, 0), Eigen::Vector3d(1.125, 1, 1))};
  const ConvexPartsFit fit = MeasureConvexParts(Closed(UnitBox()), shifted);
  EXPECT_NEAR(fit.protrusion_m, 0.125, 1e-12);
  EXPECT_NEAR(fit.uncovered_m, 0.25, 1e-12);
}

TEST(ConvexPartsFit, RefusesAPartThatIsNotConvex) {
  const std::vector<TriangleMesh> parts{RectangularRing(1, 2, 0.1, 0.1)};
  EXPECT_THROW(MeasureConvexParts(Closed(UnitBox()), parts), Error);
  EXPECT_THROW(MeasureConvexParts(Closed(UnitBox()), {}), Error);
}

TEST(ConvexHull, OfAGridHasTheEightCorners) {
  std::vector<Eigen::Vector3d> grid;
  for (int i = 0; i < 64; ++i) grid.emplace_back(i % 4, i / 4 % 4, i / 16);
  const TriangleMesh hull = ConvexHull(grid);
  EXPECT_EQ(hull.vertices.size(), 8U);
  EXPECT_NEAR(MeasureTopology(hull).volume_m3, 27, 1e-12);
}

TEST(ConvexHull, OfPointsInAPlaneIsRefused) {
  const std::vector<Eigen::Vector3d> flat{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 0}};
  EXPECT_THROW(ConvexHull(flat), Error);
  EXPECT_THROW(ConvexHull({}), Error);
}

// A bar of 1 m x 1 mm whose ends alone are covered, beside a plate that takes all samples by area.
TEST(Covering, MissesNoStripBetweenCoveredCorners) {
  const TriangleMesh plate = Box({0, 0, 0}, {100, 100, 0.1});
  const TriangleMesh bar = Box({0, 0, 1}, {1, 0.001, 1.001});
  const ClosedMesh mesh = Closed(Together(plate, bar));
  const std::vector<TriangleMesh> parts = {plate, Box({0, 0, 1}, {0.01, 0.001, 1.001}),
                                           Box({0.99, 0, 1}, {1, 0.001, 1.001})};
  const CoverLimits limits{
      .tolerance_m = 0.005, .allowed_m = 0.01, .max_parts = 32, .max_vertices = 64};
  const std::vector<TriangleMesh> covering = Covering(parts, mesh, DistanceGrid(mesh, 0.5), limits);
  const Eigen::Vector3d middle(0.5, 0.0005, 1.0005);
  EXPECT_TRUE(std::any_of(covering.begin(), covering.end(), [&](const TriangleMesh& part) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : part.vertices) box.extend(vertex);
    return box.exteriorDistance(middle) < 0.005 && box.sizes().y() < 1;
  }));
}

// Two halves of a plate of 4 m^2, of which 12 mm between them are left out.
TEST(Covering, MissesNoGapThatIsNarrowBesideALargePlate) {
  const ClosedMesh mesh = Closed(Box({0, 0, 0}, {2, 1, 0.02}));
  const std::vector<TriangleMesh> halves = {Box({0, 0, 0}, {1.0051, 1, 0.02}),
                                            Box({1.0171, 0, 0}, {2, 1, 0.02})};
  const CoverLimits limits{
      .tolerance_m = 0.0005, .allowed_m = 0.006, .max_parts = 32, .max_vertices = 64};
  const std::vector<TriangleMesh> covering =
      Covering(halves, mesh, DistanceGrid(mesh, 0.02), limits);
  std::vector<std::vector<HalfSpace>> faces;
  for (const TriangleMesh& part : covering) faces.push_back(HalfSpacesOf(part));
  int covered = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d point(1.0111, 0.0025 * i + 0.00125, 0.02);
    covered += std::any_of(faces.begin(), faces.end(), [&](const std::vector<HalfSpace>& part) {
      return std::all_of(part.begin(), part.end(), [&](const HalfSpace& face) {
        return face.normal.dot(point) <= face.offset + 0.001;
      });
    });
  }
  EXPECT_GE(covered, 390);
}

}  // namespace
}  // namespace doorforge
