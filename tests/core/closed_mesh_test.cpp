// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/closed_mesh.h"

#include <limits>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "box_mesh.h"

namespace doorforge {
namespace {

TriangleMesh UnitBox() { return BoxMesh(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()); }

void Append(const TriangleMesh& more, TriangleMesh& mesh) {
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles)
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(offset));
}

TEST(MeshTopology, MeasuresABox) {
  const MeshTopology topology =
      MeasureTopology(BoxMesh(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 4, 6)));
  EXPECT_EQ(topology.boundary_edges, 0);
  EXPECT_EQ(topology.non_manifold_edges, 0);
  EXPECT_EQ(topology.non_manifold_vertices, 0);
  EXPECT_EQ(topology.inconsistent_edges, 0);
  EXPECT_EQ(topology.degenerate_triangles, 0);
  EXPECT_EQ(topology.components, 1);
  EXPECT_NEAR(topology.volume_m3, 6.0, 1e-14);
  EXPECT_NEAR(topology.area_m2, 22.0, 1e-13);
  EXPECT_EQ(topology.bounds.min(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(topology.bounds.max(), Eigen::Vector3d(2, 4, 6));
}

TEST(MeshTopology, CountsTheEdgesOfAMissingTriangleAsBoundary) {
  TriangleMesh mesh = UnitBox();
  mesh.triangles.pop_back();
  EXPECT_EQ(MeasureTopology(mesh).boundary_edges, 3);
}

TEST(MeshTopology, CountsTheEdgesOfATurnedTriangleAsInconsistent) {
  TriangleMesh mesh = UnitBox();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_EQ(MeasureTopology(mesh).inconsistent_edges, 3);
}

TEST(MeshTopology, CountsTheEdgesOfADoubledTriangleAsNonManifold) {
  TriangleMesh mesh = UnitBox();
  mesh.triangles.push_back(mesh.triangles[0]);
  EXPECT_EQ(MeasureTopology(mesh).non_manifold_edges, 3);
  EXPECT_FALSE(ClosedMesh::From(mesh));
}

TEST(MeshTopology, SeesTwoBoxesThatShareACornerAsTwoComponentsPinchedOnce) {
  TriangleMesh mesh = UnitBox();
  Append(BoxMesh(Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(2)), mesh);
  for (Eigen::Vector3i& t : mesh.triangles) {
    for (int& index : t) index = index == 8 ? 7 : index;
  }
  const MeshTopology topology = MeasureTopology(mesh);
  EXPECT_EQ(topology.components, 2);
  EXPECT_EQ(topology.non_manifold_vertices, 1);
  EXPECT_TRUE(ClosedMesh::From(mesh));
}

TEST(MeshTopology, CountsDegenerateTrianglesOfBothKinds) {
  TriangleMesh mesh = UnitBox();
  mesh.triangles.emplace_back(0, 0, 1);
  mesh.vertices.emplace_back(0.5, 0, 0);
  mesh.triangles.emplace_back(0, 8, 1);
  EXPECT_EQ(MeasureTopology(mesh).degenerate_triangles, 2);
}

TEST(MeshTopology, RefusesAnIndexOutOfRange) {
  TriangleMesh mesh = UnitBox();
  mesh.triangles[3][1] = 8;
  try {
    MeasureTopology(mesh);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_STREQ(error.what(), "triangle 3 of the mesh names vertex 8, allowed 0..7");
  }
}

TEST(MeshTopology, RefusesAVertexThatIsNotFinite) {
  TriangleMesh mesh = UnitBox();
  mesh.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(MeasureTopology(mesh), Error);
}

TEST(MeshTopology, OfNothingIsZero) {
  const MeshTopology topology = MeasureTopology({});
  EXPECT_EQ(topology.components, 0);
  EXPECT_EQ(topology.area_m2, 0);
  EXPECT_TRUE(topology.bounds.isEmpty());
  EXPECT_FALSE(ClosedMesh::From({}));
}

TEST(ClosedMesh, KeepsTheVolumeOfAMeshFarFromTheOrigin) {
  const Eigen::Vector3d far(1e6, -1e6, 1e6);
  EXPECT_NEAR(MeasureTopology(BoxMesh(far, far + Eigen::Vector3d::Ones())).volume_m3, 1.0, 1e-9);
}

TEST(ClosedMesh, AcceptsABoxAndRefusesItInsideOut) {
  TriangleMesh mesh = UnitBox();
  ASSERT_TRUE(ClosedMesh::From(mesh));
  EXPECT_EQ(ClosedMesh::From(mesh)->mesh().triangles.size(), 12U);
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(ClosedMesh::From(mesh));
}

TEST(ClosedMesh, RefusesABalancedEdgeOfFourTriangles) {
  // two boxes that share an edge: each direction is used twice
  TriangleMesh mesh = UnitBox();
  Append(BoxMesh(Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(2, 2, 1)), mesh);
  for (Eigen::Vector3i& t : mesh.triangles) {
    for (int& index : t) index = index == 8 ? 3 : index == 12 ? 7 : index;
  }
  EXPECT_EQ(MeasureTopology(mesh).non_manifold_edges, 1);
  EXPECT_FALSE(ClosedMesh::From(mesh));
}

TEST(ClosedMesh, AcceptsACavity) {
  TriangleMesh mesh = UnitBox();
  TriangleMesh hole = BoxMesh(Eigen::Vector3d::Constant(0.25), Eigen::Vector3d::Constant(0.75));
  for (Eigen::Vector3i& t : hole.triangles) std::swap(t[0], t[1]);
  Append(hole, mesh);
  ASSERT_TRUE(ClosedMesh::From(mesh));
  EXPECT_NEAR(MeasureTopology(mesh).volume_m3, 1 - 0.125, 1e-15);
}

}  // namespace
}  // namespace doorforge
