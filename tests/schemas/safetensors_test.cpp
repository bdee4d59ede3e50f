// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/safetensors.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

TensorFile Example() {
  TensorFile file;
  const std::array<float, 6> matrix = {1, -2.5F, 3, 4, 5, 1e-30F};
  const std::array<double, 1> scalar = {0.1};
  const std::array<std::uint8_t, 3> bytes = {0, 7, 255};
  const std::array<std::int64_t, 2> counts = {-1, 1LL << 60};
  file.tensors["b.matrix"] = MakeTensor<float>(matrix, {2, 3});
  file.tensors["a.bytes"] = MakeTensor<std::uint8_t>(bytes, {3});
  file.tensors["scalar"] = MakeTensor<double>(scalar, {});
  file.tensors["counts"] = MakeTensor<std::int64_t>(counts, {2, 1});
  file.tensors["empty"] = MakeTensor<float>({}, {0, 4});
  file.metadata = {{"note", "a \"quoted\" word"}, {"step", "7"}};
  return file;
}

// A file around a header written by hand.
std::string WithHeader(const std::string& header, const std::string& data) {
  std::string bytes;
  for (unsigned i = 0; i < 8; ++i)
    bytes.push_back(static_cast<char>(header.size() >> (8 * i) & 0xFFU));
  return bytes + header + data;
}

void ExpectRefused(const std::string& bytes, const std::string& why) {
  try {
    DecodeTensors(bytes, "some.safetensors");
    FAIL() << "accepted: " << why;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    EXPECT_NE(std::string(error.what()).find("some.safetensors"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(Safetensors, ComeBackAsTheyWereWritten) {
  const TensorFile file = Example();
  const std::string bytes = EncodeTensors(file);
  const TensorFile back = DecodeTensors(bytes, "memory");
  EXPECT_EQ(back.metadata, file.metadata);
  ASSERT_EQ(back.tensors.size(), file.tensors.size());
  for (const auto& [name, tensor] : file.tensors) {
    const Tensor& other = TensorNamed(back, name, "memory");
    EXPECT_EQ(other.type, tensor.type) << name;
    EXPECT_EQ(other.shape, tensor.shape) << name;
    EXPECT_EQ(other.bytes, tensor.bytes) << name;
  }
  EXPECT_EQ(EncodeTensors(back), bytes);
  EXPECT_EQ(ValuesOf<float>(TensorNamed(back, "b.matrix", "memory"), {2, 3}, "memory")[1], -2.5F);
}

TEST(Safetensors, DataBeginAtAMultipleOf64) {
  const std::string bytes = EncodeTensors(Example());
  std::uint64_t header = 0;
  for (std::size_t i = 8; i-- > 0;) header = header << 8U | static_cast<unsigned char>(bytes[i]);
  EXPECT_EQ((8 + header) % 64, 0U);
}

TEST(Safetensors, AreReadByNumpyAndWrittenByNumpy) {
  const auto folder = std::filesystem::path(DOORFORGE_BINARY_DIR) / "safetensors_test";
  std::filesystem::create_directories(folder);
  CommitFile(folder / "ours.safetensors", EncodeTensors(Example()));
  const std::string command =
      "/usr/bin/python3 " DOORFORGE_SOURCE_DIR "/tests/schemas/safetensors_check.py " +
      (folder / "ours.safetensors").string() + " " + (folder / "theirs.safetensors").string();
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT: fixed command
  const std::string path = (folder / "theirs.safetensors").string();
  const TensorFile theirs = ReadTensors(path);
  EXPECT_EQ(theirs.metadata.at("format"), "np");
  EXPECT_EQ(ValuesOf<float>(TensorNamed(theirs, "ramp", path), {2, 2}, path),
            (std::vector<float>{0, 1, 2, 3}));
  EXPECT_EQ(ValuesOf<std::int64_t>(TensorNamed(theirs, "count", path), {1}, path),
            std::vector<std::int64_t>{-5});
}

TEST(Safetensors, HalvesAreTheNearestOnesTiesToEven) {
  // 2049 lies between 2048 and 2050; 2051 between 2050 and 2052; 1e-8 below half the least number
  const std::vector<float> values = {1.0F, -2.5F, 2049.0F, 2051.0F, 65504.0F, 1e-8F, 6e-8F};
  const Tensor tensor = MakeHalfTensor(values, {7});
  EXPECT_EQ(tensor.bytes.size(), 14U);
  EXPECT_EQ(tensor.bytes.substr(0, 4), std::string("\x00\x3c\x00\xc1", 4));  // IEEE 754 binary16
  const std::vector<float> expected = {1, -2.5F, 2048, 2052, 65504, 0, std::ldexp(1.0F, -24)};
  EXPECT_EQ(FloatsOf(tensor, {7}, "some.safetensors"), expected);
  EXPECT_EQ(FloatsOf(MakeTensor<float>(values, {7}), {7}, "some.safetensors"), values);
  EXPECT_THROW(FloatsOf(tensor, {8}, "some.safetensors"), Error);
  EXPECT_THROW(MakeHalfTensor(std::vector<float>{70000.0F}, {1}), Error);
  EXPECT_THROW(MakeHalfTensor(values, {3}), Error);
}

TEST(Safetensors, RefuseFilesThatDoNotFollowTheFormat) {
  const std::string good = R"({"x":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})";
  EXPECT_NO_THROW(DecodeTensors(WithHeader(good, "abcd"), "x"));
  ExpectRefused("", "shorter than 8 bytes");
  ExpectRefused(std::string(8, '\xFF'), "header of");
  ExpectRefused(WithHeader("[]", ""), "begin with {");
  ExpectRefused(WithHeader("{\"x\":", ""), "not JSON");
  ExpectRefused(WithHeader(std::string("{}\0 {", 5), ""), "zero byte");
  ExpectRefused(WithHeader(good, "abcde"), "belong to no tensor");
  ExpectRefused(WithHeader(good, "abc"), "outside the data");
  ExpectRefused(WithHeader(R"({"x":{"dtype":"BF16","shape":[2],"data_offsets":[0,4]}})", "abcd"),
                "element type");
  ExpectRefused(WithHeader(R"({"x":{"dtype":"F32","shape":[2],"data_offsets":[0,4]}})", "abcd"),
                "does not fit");
  ExpectRefused(WithHeader(R"({"x":{"dtype":"F32","shape":[-1],"data_offsets":[0,4]}})", "abcd"),
                "counts");
  ExpectRefused(
      WithHeader(R"({"x":{"dtype":"U8","shape":[4294967296,4294967297],"data_offsets":[0,4]}})",
                 "abcd"),
      "does not fit");
  ExpectRefused(WithHeader(R"({"x":{"dtype":"U8","shape":[1],"data_offsets":[3,4]}})", "abcd"),
                "gap or an overlap");
  ExpectRefused(WithHeader(R"({"x":{"dtype":"U8","shape":[4],"data_offsets":[0,4]},)"
                           R"("y":{"dtype":"U8","shape":[2],"data_offsets":[2,4]}})",
                           "abcd"),
                "gap or an overlap");
  ExpectRefused(WithHeader(R"({"x":{"dtype":"U8","shape":[2],"data_offsets":[0,2]},)"
                           R"("x":{"dtype":"U8","shape":[2],"data_offsets":[2,4]}})",
                           "abcd"),
                "twice");
  ExpectRefused(WithHeader(R"({"__metadata__":{"a":1}})", ""), "text");
  ExpectRefused(WithHeader("{" + std::string(100000, '['), ""), "");
  ExpectRefused(WithHeader(R"({"x":[[[[[[[[1]]]]]]]]})", ""), "");
}

TEST(Safetensors, NeverCrashOnFlippedBytes) {
  const std::string good = EncodeTensors(Example());
  Rng rng(1, "test/safetensors");
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = good;
    const auto place = rng.Index(static_cast<std::uint32_t>(bytes.size()));
    bytes[place] = static_cast<char>(rng.NextUint32());
    if (rng.Index(4) == 0) bytes.resize(place);
    try {
      DecodeTensors(bytes, "flipped");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace doorforge
