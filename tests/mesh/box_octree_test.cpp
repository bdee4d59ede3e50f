// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/box_octree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

Eigen::Vector3d PointIn(double half, Rng& rng) {
  return {rng.Uniform(-half, half), rng.Uniform(-half, half), rng.Uniform(-half, half)};
}

// They have all sizes; some are as thin as a sheet, and some lie beyond the bounds.
Eigen::AlignedBox3d RandomBox(Rng& rng) {
  const Eigen::Vector3d corner = PointIn(1.2, rng);
  const double size = std::pow(10.0, rng.Uniform(-6, 0.3));
  Eigen::Vector3d sides = PointIn(size, rng).cwiseAbs();
  if (rng.Uniform(0, 1) < 0.3) sides[2] = 0;
  return {corner, corner + sides};
}

TEST(BoxOctree, FindsTheBoxesThatOverlapWhileTheyChange) {
  constexpr std::size_t kCount = 300;
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
  BoxOctree octree(bounds, kCount);
  std::map<std::size_t, Eigen::AlignedBox3d> present;
  Rng rng(1, "tests/box_octree");
  std::size_t found_in_all = 0;
  for (int step = 0; step < 4000; ++step) {
    const auto number = static_cast<std::size_t>(rng.Index(kCount));
    if (rng.Uniform(0, 1) < 0.3) {
      octree.Remove(number);
      present.erase(number);
    } else {
      present[number] = RandomBox(rng);
      octree.Put(number, present[number]);
    }
    const Eigen::AlignedBox3d asked = RandomBox(rng);
    std::vector<std::size_t> expected;
    for (const auto& [n, box] : present) {
      if (box.intersects(asked)) expected.push_back(n);
    }
    std::vector<std::size_t> found;
    octree.Find(asked, found);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected) << "step " << step;
    found_in_all += found.size();
  }
  EXPECT_GT(found_in_all, 1000U);
}

}  // namespace
}  // namespace doorforge
