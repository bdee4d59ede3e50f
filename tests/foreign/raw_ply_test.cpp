// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "read/raw_mesh.h"

namespace doorforge::foreign {
namespace {

std::string FaultOf(const std::string& ply) {
  try {
    ReadRawPly(ply);
  } catch (const RawMeshFault& fault) {
    return fault.what();
  }
  return "";
}

TEST(RawPly, AVertexWithoutPropertiesIsNoVertex) {
  // a line of 24 bytes stands for as many vertices as the file has bytes
  std::string ply = "ply\nformat binary_little_endian 1.0\n";
  for (int i = 0; i < 60; ++i) ply += "element vertex 1000000\n";
  ply += "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  ply += std::string(1'000'000, '\3');
  // the face names vertex 3, and there is none
  EXPECT_EQ(FaultOf(ply), "a face names vertex 3 of 0");
}

TEST(RawPly, AListOfNoLengthIsRefused) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty list double float x\nend_header\n";
  for (const char* count : {"1e300", "-1", "-1e300", "10001"})
    EXPECT_EQ(FaultOf(head + count + " 0\n"), "a list of more than the 10000 allowed") << count;
}

TEST(RawPly, AVertexBeyondAllNumbersIsNamedAsItIs) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar double "
      "vertex_indices\nend_header\n"
      "3 1e300 0 0\n";
  EXPECT_EQ(FaultOf(ply), "a face names vertex 1e+300 of 0");
}

}  // namespace
}  // namespace doorforge::foreign
