// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/event_log.h"

#include <cstdio>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

// What TensorBoard 2's own RecordWriter and messages give for a version record and one scalar.
TEST(EventLog, GivesTheBytesOfTensorBoardsOwnWriter) {
  const std::string expected =
      "0f000000000000006d532b091a0d627261696e2e4576656e743a32fc985129"
      "1a00000000000000129bd82d090000000000c0724010ac022a0c0a0a0a03612f62150000003f38eab80b";
  const std::vector<ScalarEvent> events = {{300, "a/b", 0.5}};
  std::string hex;
  for (const char byte : TensorboardEvents(events)) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x",
                  static_cast<unsigned>(static_cast<unsigned char>(byte)));
    hex += digits;
  }
  EXPECT_EQ(hex, expected);
}

}  // namespace
}  // namespace doorforge
