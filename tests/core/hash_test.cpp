// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/hash.h"

#include <vector>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

std::span<const std::byte> Bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST(Hash, Sha256GivesTheDigestsOfFips180) {
  EXPECT_EQ(Sha256Hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256Hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256Hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Hash, Sha256DoesNotDependOnHowTheInputIsCut) {
  const std::string text(1000, 'x');
  Sha256 hash;
  for (std::size_t begin = 0; begin < text.size(); begin += 37)
    hash.Update(std::string_view(text).substr(begin, 37));
  EXPECT_EQ(hash.HexDigest(), Sha256Hex(text));
}

TEST(Hash, Crc32cGivesTheVectorsOfRfc3720) {
  EXPECT_EQ(Crc32c(Bytes(std::string(32, '\0'))), 0x8A9136AAU);
  EXPECT_EQ(Crc32c(Bytes(std::string(32, '\xff'))), 0x62A8AB43U);
  EXPECT_EQ(Crc32c(Bytes("123456789")), 0xE3069283U);
}

// The definition, bit by bit: division by the polynomial 0x1EDC6F41, reflected.
std::uint32_t CrcByDivision(std::string_view text) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ (0x82F63B78U & (0U - (crc & 1U)));
  }
  return ~crc;
}

TEST(Hash, Crc32cOfLongTextsIsThatOfTheDefinition) {
  std::string text;
  std::uint32_t state = 1;
  while (text.size() < 20000) {
    state = state * 1664525U + 1013904223U;
    text += static_cast<char>(state >> 24U);
  }
  // around the three streams of 1024 bytes that are read side by side
  for (const std::size_t size : {1023U, 3071U, 3072U, 3073U, 6143U, 6144U, 6151U, 9216U, 20000U}) {
    const std::string_view part = std::string_view(text).substr(0, size);
    EXPECT_EQ(Crc32c(std::as_bytes(std::span(part))), CrcByDivision(part)) << size;
  }
}

TEST(Hash, Crc32cCanBeContinued) {
  EXPECT_EQ(Crc32c(Bytes("56789"), Crc32c(Bytes("1234"))), Crc32c(Bytes("123456789")));
}

}  // namespace
}  // namespace doorforge
