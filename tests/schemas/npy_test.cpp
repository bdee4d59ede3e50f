// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/npy.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

std::span<const std::byte> Bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string MessageOf(const std::string& bytes) {
  try {
    ParseNpyHeader(Bytes(bytes), "x.npy");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    return error.what();
  }
  return "";
}

TEST(Npy, WritesTheHeaderThatNumpyWrites) {
  // numpy.save of numpy.zeros((2, 3), '<f4'), 1.24
  const std::string expected = std::string("\x93NUMPY\x01\x00v\x00", 10) +
                               "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }" +
                               std::string(58, ' ') + "\n";
  EXPECT_EQ(MakeNpyHeader("<f4", {2, 3}), expected);
}

TEST(Npy, AlignsTheDataTo64Bytes) {
  for (std::size_t length = 1; length < 1000000000000; length *= 7)
    EXPECT_EQ(MakeNpyHeader("|u1", {length, length, 3}).size() % 64, 0U);
}

TEST(Npy, ReadsBackWhatItWrote) {
  const std::vector<float> values = {1, 2.5F, -3, 4, 5, 6};
  alignas(64) static char buffer[512];
  const std::string file = MakeNpy<float>(values, {2, 3});
  std::copy(file.begin(), file.end(), buffer);
  const auto bytes = std::as_bytes(std::span(buffer, file.size()));
  const NpyView<float> view = ViewNpy<float>(bytes, "x.npy");
  EXPECT_EQ(view.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(std::vector<float>(view.values.begin(), view.values.end()), values);
  EXPECT_THROW(ViewNpy<std::uint8_t>(bytes, "x.npy"), Error);
}

TEST(Npy, HandlesScalarsAndEmptyArrays) {
  const std::string scalar = MakeNpy<double>(std::vector<double>{7}, {});
  EXPECT_TRUE(ParseNpyHeader(Bytes(scalar), "s").shape.empty());
  const std::string empty = MakeNpy<std::uint8_t>({}, {0, 5});
  EXPECT_EQ(ParseNpyHeader(Bytes(empty), "e").shape, (std::vector<std::size_t>{0, 5}));
  EXPECT_THROW(MakeNpy<float>(std::vector<float>(5), {2, 3}), Error);
}

TEST(Npy, NamesWhatIsWrongWithAFile) {
  const std::string good = MakeNpy<float>(std::vector<float>(6), {2, 3});
  EXPECT_EQ(MessageOf("x.npy"), "x.npy: not an .npy file of version 1.0");
  EXPECT_EQ(MessageOf(good.substr(0, 60)), "x.npy: npy header is cut off");
  EXPECT_EQ(MessageOf(good.substr(0, good.size() - 4)),
            "x.npy: 20 bytes of data, the shape (2, 3) needs 24");
  std::string type = good;
  type.replace(type.find("<f4"), 3, ">f4");
  EXPECT_EQ(MessageOf(type), "x.npy: element type >f4, allowed <f4, <f8, <i8, <u2, |i1, |u1");
  std::string order = good;
  order.replace(order.find("False"), 5, "True ");
  EXPECT_NE(MessageOf(order).find("fortran_order"), std::string::npos);
  std::string huge = good;
  huge.replace(huge.find("(2, 3)"), 6, "(9999999999999999999, 9999999999999999999)");
  EXPECT_NE(MessageOf(huge), "");
}

// numpy refuses what is left over behind the shape and the dictionary.
TEST(Npy, ReadsAHeaderToItsEnd) {
  const auto file = [](const std::string& end) {
    std::string head = "{'descr': '|u1', 'fortran_order': False, 'shape': (2,)" + end;
    head.resize(117, ' ');
    return std::string("\x93NUMPY\x01\x00v\x00", 10) + head + "\n" + "ab";
  };
  for (const char* end : {", }", ",}", "}", " }"})
    EXPECT_EQ(MessageOf(file(end)).empty(), std::string_view(end) != " }") << end;
  EXPECT_EQ(MessageOf(file("1111, }")),
            "x.npy: npy header: expected \"}\" before \"1111, }         \"");
  EXPECT_EQ(MessageOf(file(", }  !")), "x.npy: npy header: more than blanks behind its \"}\"");
}

TEST(Npy, NeverReadsOutsideDamagedHeaders) {
  const std::string good = MakeNpy<float>(std::vector<float>(6), {2, 3});
  for (std::size_t i = 0; i < 128; ++i) {
    for (const char value : {'\0', '\xff', '(', '9'}) {
      std::string damaged = good;
      damaged[i] = value;
      MessageOf(damaged);  // no crash; run under the sanitizers in the dev preset
    }
  }
}

}  // namespace
}  // namespace doorforge
