// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "files/memory_share.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

constexpr std::uint64_t kGiB = 1ULL << 30;

TEST(MemoryShare, ALoneOneMayHaveAllOfIt) {
  EXPECT_EQ(MemoryShare(2 * kGiB).bytes(), 2 * kGiB);
  EXPECT_EQ(MemoryShare(100 * kGiB).bytes(), 2 * kGiB);
}

TEST(MemoryShare, AllTogetherNeverHaveMoreThanThereIs) {
  std::atomic<std::uint64_t> held{0};
  std::atomic<std::uint64_t> most{0};
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t t = 0; t < 12; ++t) {
      threads.emplace_back([&held, &most, t] {
        for (std::uint64_t i = 0; i < 40; ++i) {
          const MemoryShare share((1 + (t + i) % 5) * kGiB / 2);
          const std::uint64_t now = held += share.bytes();
          std::uint64_t before = most;
          while (before < now && !most.compare_exchange_weak(before, now)) {
          }
          std::this_thread::sleep_for(std::chrono::microseconds(200));
          held -= share.bytes();
        }
      });
    }
  }
  EXPECT_LE(most, 2 * kGiB);
  EXPECT_GT(most, kGiB);  // they did share it
}

// Small ones that keep coming may not leave the one that wants all of it waiting for ever.
TEST(MemoryShare, WhoWantsMuchGetsItsTurn) {
  std::atomic<bool> served{false};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&served] {
      for (int i = 0; i < 20'000 && !served; ++i) {
        const MemoryShare share(kGiB / 2);
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
    });
  }
  {
    const MemoryShare all(2 * kGiB);
    served = true;
  }
  EXPECT_TRUE(served);
}

}  // namespace
}  // namespace doorforge
