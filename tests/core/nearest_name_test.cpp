// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/nearest_name.h"

#include <gtest/gtest.h>

namespace doorforge {
namespace {

TEST(NearestName, FindsTheOneWithTheFewestEdits) {
  EXPECT_EQ(NearestName("compse", {"eval", "compose", "composer"}), "compose");
  EXPECT_EQ(NearestName("anything", {}), "");
}

}  // namespace
}  // namespace doorforge
