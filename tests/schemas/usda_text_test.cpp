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
    return "#usda 1.0\ndef \"a\" " + Repeated("(a = 1 ", depth) + Repeated(")", depth) + " {}\n";
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

TEST(UsdaText, WordsThatBeginNothingAreRefused) {
  const auto refused = [](const std::string& entry, const std::string& property) {
    try {
      ParseUsda("#usda 1.0\n(\n" + entry + "\n)\ndef Xform \"a\"\n{\n" + property + "\n}\n");
    } catch (const UsdaFault& fault) {
      return fault.line;
    }
    return 0;
  };
  for (const char* sound :
       {"uniform token a = \"b\"", "custom double a:b = 1", "prepend rel a = </b>", "rel a",
        "custom uniform float3[] a = [(1, 2, 3)]", "color3f inputs:a.connect = </b.c>",
        "reorder properties = [\"a\"]", "float a", "double b.timeSamples = { 0: 1 }"})
    EXPECT_EQ(refused("upAxis = \"Z\"", sound), 0) << sound;
  for (const char* wrong :
       {"floa", "nan float a = 1", "float a =\n1", "float a\n= 1", "tokenform token a"})
    EXPECT_GT(refused("upAxis = \"Z\"", wrong), 5) << wrong;
  for (const char* sound :
       {"prepend apiSchemas = [\"a\"]", "customLayerData = {\n}", "\"a comment\""})
    EXPECT_EQ(refused(sound, ""), 0) << sound;
  for (const char* wrong : {"upA", "nanpend apiSchemas = [\"a\"]", "a b c = 1", "upAxis\n= \"Z\""})
    EXPECT_GT(refused(wrong, ""), 2) << wrong;
}

}  // namespace
}  // namespace doorforge
