// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "ordered_work.h"

#include <atomic>
#include <chrono>
#include <stdexcept>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

constexpr auto kNeverStopped = [] { return false; };

TEST(OrderedWork, HandsItemsOnInOrderForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::size_t> seen;
    OrderedWork<std::size_t> work(
        [](std::size_t i) {
          std::this_thread::sleep_for(std::chrono::microseconds(i % 5 * 100));
          return i * i;
        },
        [&](std::size_t i, std::size_t item) {
          EXPECT_EQ(item, i * i);
          seen.push_back(i);
        },
        kNeverStopped);
    EXPECT_EQ(work.Run(200, threads), 200U);
    ASSERT_EQ(seen.size(), 200U);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i);
  }
}

TEST(OrderedWork, KeepsOnlyAFewItemsInMemory) {
  std::atomic<int> alive{0};
  std::atomic<int> most{0};
  OrderedWork<int> work(
      [&](std::size_t i) {
        // the first item takes long: the others must wait for it
        if (i == 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
        const int now = ++alive;
        int before = most;
        while (before < now && !most.compare_exchange_weak(before, now)) {
        }
        return 0;
      },
      [&](std::size_t, int) { --alive; }, kNeverStopped);
  work.Run(500, 3);
  EXPECT_LE(most, 12);
}

TEST(OrderedWork, RethrowsWhatTheWorkersThrow) {
  OrderedWork<int> producing(
      [](std::size_t i) -> int {
        if (i == 30) throw std::runtime_error("produce");
        return 0;
      },
      [](std::size_t, int) {}, kNeverStopped);
  EXPECT_THROW(producing.Run(100, 3), std::runtime_error);
  OrderedWork<int> consuming([](std::size_t) { return 0; },
                             [](std::size_t i, int) {
                               if (i == 30) throw std::runtime_error("consume");
                             },
                             kNeverStopped);
  EXPECT_THROW(consuming.Run(100, 3), std::runtime_error);
}

TEST(OrderedWork, StopsWhenAsked) {
  std::atomic<int> made{0};
  std::size_t consumed = 0;
  OrderedWork<int> work([&](std::size_t) { return ++made; }, [&](std::size_t, int) { ++consumed; },
                        [&] { return made >= 20; });
  EXPECT_EQ(work.Run(1000, 2), consumed);
  EXPECT_LT(consumed, 30U);
}

TEST(OrderedWork, DoesNothingForNoItems) {
  OrderedWork<int> work([](std::size_t) { return 0; }, [](std::size_t, int) {}, kNeverStopped);
  EXPECT_EQ(work.Run(0, 4), 0U);
}

}  // namespace
}  // namespace doorforge
