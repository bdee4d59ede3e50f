// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/shape_descriptor.h"

#include <array>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "box_mesh.h"

namespace doorforge {
namespace {

// an L of two boxes, `foot` long
std::vector<TriangleMesh> Bracket(double foot) {
  return {BoxMesh({0, 0, 0}, {0.02, 0.03, 0.2}), BoxMesh({0.02, 0, 0}, {0.02 + foot, 0.03, 0.03})};
}

std::vector<TriangleMesh> Changed(std::vector<TriangleMesh> meshes, const Eigen::Vector3d& scale,
                                  const Eigen::Vector3d& shift) {
  for (TriangleMesh& mesh : meshes) {
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale) + shift;
    if (scale.prod() < 0) {
      for (Eigen::Vector3i& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
    }
  }
  return meshes;
}

TEST(ShapeDescriptor, OfABoxIsKnownInClosedForm) {
  const std::array boxes{BoxMesh({1, 2, 3}, {3, 4, 4})};
  const ShapeDescriptor numbers = DescribeShape(boxes);
  const double second = 1.0 / 12;  // of a unit cube about its centre
  const std::vector<double> expected = {2.0 / 3, 2.0 / 3, 1.0 / 3, 1,      0, 0,     0,
                                        second,  0,       0,       second, 0, second};
  ASSERT_EQ(numbers.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-6) << i;
}

TEST(ShapeDescriptor, CopiesAtAnotherSizeElsewhereOrMirroredAreTheSame) {
  const ShapeDescriptor shape = DescribeShape(Bracket(0.1));
  EXPECT_TRUE(SameShape(shape, DescribeShape(Changed(Bracket(0.1), {1.3, 1.3, 1.3}, {5, -2, 9}))));
  EXPECT_TRUE(SameShape(shape, DescribeShape(Changed(Bracket(0.1), {1, -1, 1}, {0, 0, 0}))));
}

TEST(ShapeDescriptor, OtherProportionsOrPartsAreAnotherShape) {
  const ShapeDescriptor shape = DescribeShape(Bracket(0.1));
  EXPECT_FALSE(SameShape(shape, DescribeShape(Changed(Bracket(0.1), {1, 1, 1.05}, {0, 0, 0}))));
  EXPECT_FALSE(SameShape(shape, DescribeShape(Bracket(0.104))));
  const std::array bounds{BoxMesh({0, 0, 0}, {0.12, 0.03, 0.2})};  // the same box around it
  EXPECT_FALSE(SameShape(shape, DescribeShape(bounds)));
}

TEST(ShapeDescriptor, AnUnknownShapeIsTheSameAsNone) {
  EXPECT_TRUE(DescribeShape({}).empty());
  EXPECT_FALSE(SameShape({}, {}));
  EXPECT_FALSE(SameShape({}, DescribeShape(Bracket(0.1))));
}

TEST(ShapeDescriptor, ARecordOfAnotherLengthIsRefused) {
  EXPECT_TRUE(ShapeOfRecord({{"id", "old"}}, "part").empty());
  EXPECT_EQ(ShapeOfRecord({{"shape", ShapeDescriptor(13, 0.5)}}, "part"), ShapeDescriptor(13, 0.5));
  EXPECT_THROW(ShapeOfRecord({{"shape", {1, 2, 3}}}, "part"), Error);
}

}  // namespace
}  // namespace doorforge
