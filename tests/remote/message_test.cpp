// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "message.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

// MessagePack's array32 of so many nils.
std::string Nils(std::uint32_t count) {
  std::string message = "\xdd";
  for (int shift = 24; shift >= 0; shift -= 8) message += static_cast<char>(count >> shift & 0xff);
  return message + std::string(count, '\xc0');
}

TEST(Message, AListIsUnpackedAsItWasPacked) {
  const Value value = Unpacked(Nils(3));
  ASSERT_NE(value.As<Value::List>(), nullptr);
  EXPECT_EQ(value.As<Value::List>()->size(), 3U);
  EXPECT_EQ(Packed(value), Nils(3));
}

// A nil is a byte in the message and a hundred in memory: the 64 MiB that a server takes would be 6
// GiB.
TEST(Message, MoreValuesThanAnybodySendsAreRefused) {
  EXPECT_NO_THROW(Unpacked(Nils(99'999)));
  EXPECT_THROW(Unpacked(Nils(100'000)), Error);
  EXPECT_THROW(Unpacked(Nils(20'000'000)), Error);
}

}  // namespace
}  // namespace doorforge::internal
