// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/usda_text.h"

#include <gtest/gtest.h>

namespace doorforge {
namespace {

std::string Repeated(const std::string& text, int count) {
  std::string whole;
  for (int i = 0; i < count; ++i) whole += text;
  return whole;
}

bool IsBeyondALimit(const std::string& usda) {
  try {
    ParseUsda(usda);
  } catch (const UsdaFault& fault) {
    return fault.limit;
  }
  return false;
}

// Each entry of metadata may have metadata: read by a function that calls itself.
TEST(UsdaText, MetadataIsReadToADepthOfSixtyFour) {
  const auto nested = [](int depth) {
    return "#usda 1.0\ndef \"a\" " + Repeated("(a ", depth) + Repeated(")", depth) + " {}\n";
  };
  EXPECT_EQ(ParseUsda(nested(64)).prims.size(), 1U);
  EXPECT_TRUE(IsBeyondALimit(nested(65)));
  EXPECT_TRUE(IsBeyondALimit(nested(300'000)));
  EXPECT_TRUE(IsBeyondALimit("#usda 1.0\ndef \"a\" (" + Repeated("a = @x@ (", 300'000)));
}

// Two hundred thousand prims below one whose name is eight megabytes: each has its whole path.
TEST(UsdaText, APathOfManyBytesIsRefused) {
  const std::string children = Repeated("def \"b\" {}\n", 3);
  const std::string head = "#usda 1.0\ndef \"";
  EXPECT_EQ(ParseUsda(head + std::string(1000, 'a') + "\" {\n" + children + "}\n").prims.size(),
            4U);
  EXPECT_TRUE(IsBeyondALimit(head + std::string(8'000'000, 'a') + "\" {\n" + children + "}\n"));
}

}  // namespace
}  // namespace doorforge
