// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Nothing else of the room is used here: rounding_o3_test brings this source of it along.
#include <bit>
#include <cstdint>

#include <gtest/gtest.h>

#include "doorforge/core/mesh_transform.h"

namespace doorforge {
namespace {

// Through the bits of the double, so that no compiler takes it for two conversions: half of the
// lowest bit that a float keeps is added, less a little where that bit is even. For normal floats.
double NearestFloat(double number) {
  constexpr int kLost = 52 - 23;  // bits of the mantissa that a float lacks
  auto bits = std::bit_cast<std::uint64_t>(number);
  bits += (std::uint64_t{1} << (kLost - 1)) - 1 + ((bits >> kLost) & 1);
  return std::bit_cast<double>(bits >> kLost << kLost);
}

TEST(RoundedToFloat, TakesEveryCoordinateToTheNearestFloat) {
  // loops over whole vectors leave over what is no multiple of their width
  for (std::size_t count = 1; count <= 17; ++count) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = static_cast<double>(3 * i + 1);
      mesh.vertices.emplace_back(x / 7, -x / 11, 1e-3 * x / 13);
    }
    const TriangleMesh rounded = RoundedToFloat(mesh);
    ASSERT_EQ(rounded.vertices.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(rounded.vertices[i][axis], NearestFloat(mesh.vertices[i][axis]))
            << "axis " << axis << " of vertex " << i << " of " << count;
    }
  }
}

TEST(RoundedToFloat, TakesAMiddleToTheEvenFloatAndKeepsTheTriangles) {
  EXPECT_EQ(RoundedToFloat(1 + 0x1p-24), 1);
  EXPECT_EQ(RoundedToFloat(1 + 0x3p-24), 1 + 0x1p-22);
  EXPECT_EQ(RoundedToFloat(0.1), 0x1.99999ap-4);
  const TriangleMesh one{{{0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}, {{0, 1, 2}}};
  EXPECT_EQ(RoundedToFloat(one).triangles, one.triangles);
}

}  // namespace
}  // namespace doorforge
