// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/mass_properties.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "box_mesh.h"

namespace doorforge {
namespace {

ClosedMesh Box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return *ClosedMesh::From(BoxMesh(low, high));
}

ClosedMesh CornerTetrahedron() {
  return *ClosedMesh::From(
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
}

// Prism over a regular polygon, axis z, centred at the origin.
ClosedMesh Prism(int sides, double radius, double height) {
  TriangleMesh mesh;
  for (int i = 0; i < 2 * sides; ++i) {
    const double angle = 2 * std::numbers::pi * (i % sides) / sides;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                               (i < sides ? -0.5 : 0.5) * height);
  }
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    mesh.triangles.emplace_back(i, j, sides + j);
    mesh.triangles.emplace_back(i, sides + j, sides + i);
    if (i >= 1 && i + 1 < sides) {
      mesh.triangles.emplace_back(0, i + 1, i);
      mesh.triangles.emplace_back(sides, sides + i, sides + i + 1);
    }
  }
  return *ClosedMesh::From(mesh);
}

void ExpectNear(const MassProperties& a, const MassProperties& b, double tolerance) {
  EXPECT_NEAR(a.mass_kg, b.mass_kg, tolerance * b.mass_kg);
  EXPECT_LT((a.center_of_mass_m - b.center_of_mass_m).norm(), tolerance);
  EXPECT_LT((a.inertia_kg_m2 - b.inertia_kg_m2).norm(), tolerance * b.inertia_kg_m2.norm());
}

TEST(MassProperties, OfABoxFollowTheFormula) {
  const MassProperties body =
      MassPropertiesOf(Box(Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(3, 4, 5)), 10);
  MassProperties expected{10 * 24.0, {2, 2.5, 3}, Eigen::Matrix3d::Zero()};
  expected.inertia_kg_m2.diagonal() << 9 + 16, 4 + 16, 4 + 9;
  expected.inertia_kg_m2 *= 240.0 / 12;
  ExpectNear(body, expected, 1e-14);
}

TEST(MassProperties, OfACornerTetrahedronFollowTheFormula) {
  const MassProperties body = MassPropertiesOf(CornerTetrahedron(), 6);  // 1 kg
  MassProperties expected{1, Eigen::Vector3d::Constant(0.25), Eigen::Matrix3d::Zero()};
  // about the origin: 2/10 on the diagonal, -1/20 off it; then to the centre
  expected.inertia_kg_m2 =
      Eigen::Matrix3d::Constant(-1.0 / 20 + 1.0 / 16) +
      Eigen::Matrix3d::Identity() * (2.0 / 10 - 2.0 / 16 + 1.0 / 20 - 1.0 / 16);
  ExpectNear(body, expected, 1e-14);
}

TEST(MassProperties, OfAPrismFollowTheFormula) {
  // polygon of n sides: I_z = m r^2 / 2 (1 - 2/3 sin^2(pi / n)), I_x = I_z / 2 + m h^2 / 12
  const int n = 7;
  const double r = 0.3;
  const double h = 2;
  const MassProperties body = MassPropertiesOf(Prism(n, r, h), 1000);
  const double mass = 1000 * h * n * r * r * std::sin(2 * std::numbers::pi / n) / 2;
  const double sine = std::sin(std::numbers::pi / n);
  const double about_z = mass * r * r / 2 * (1 - 2.0 / 3 * sine * sine);
  MassProperties expected{mass, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  expected.inertia_kg_m2.diagonal() << about_z / 2 + mass * h * h / 12,
      about_z / 2 + mass * h * h / 12, about_z;
  ExpectNear(body, expected, 1e-13);
}

TEST(MassProperties, KeepTheirDigitsFarFromTheOrigin) {
  const Eigen::Vector3d far(1e4, 0, 0);
  const MassProperties body = MassPropertiesOf(Box(far, far + Eigen::Vector3d::Ones()), 6);
  EXPECT_NEAR(body.inertia_kg_m2(1, 1), 1, 1e-9);
}

TEST(MassProperties, OfTwoHalvesCombineToTheWhole) {
  const std::array halves{
      MassPropertiesOf(Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)), 700),
      MassPropertiesOf(Box(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(3, 1, 1)), 700)};
  ExpectNear(Combined(halves),
             MassPropertiesOf(Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 1, 1)), 700), 1e-14);
}

TEST(MassProperties, OfNothingAreZero) { EXPECT_EQ(Combined({}).mass_kg, 0); }

TEST(MassProperties, TurnWithTheBody) {
  const RigidTransform a_from_b = FromXyzRpy({0.3, -2, 1}, {0.4, 0.9, -1.7});
  const ClosedMesh tetrahedron = CornerTetrahedron();
  TriangleMesh moved = tetrahedron.mesh();
  for (Eigen::Vector3d& vertex : moved.vertices) vertex = a_from_b * vertex;
  ExpectNear(Transformed(MassPropertiesOf(tetrahedron, 5), a_from_b),
             MassPropertiesOf(*ClosedMesh::From(moved), 5), 1e-13);
}

TEST(MassProperties, NeedAPositiveDensity) {
  EXPECT_THROW(MassPropertiesOf(CornerTetrahedron(), 0), Error);
}

}  // namespace
}  // namespace doorforge
