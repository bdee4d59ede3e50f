// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "ordered_calls.h"

#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace doorforge::internal {
namespace {

TEST(OrderedCalls, RunInTheirOrderWhicheverIsAskedForFirst) {
  for (const bool aside : {false, true}) {
    OrderedCalls calls(aside);
    std::vector<int> order;  // one call at a time writes
    std::vector<std::future<int>> results;
    for (int i = 0; i < 8; ++i) {
      results.push_back(calls.Start([i, &order] {
        std::this_thread::sleep_for(std::chrono::milliseconds(8 - i));
        order.push_back(i);
        return 10 * i;
      }));
    }
    for (int i = 7; i >= 0; --i) EXPECT_EQ(results[static_cast<std::size_t>(i)].get(), 10 * i);
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
}

TEST(OrderedCalls, DoNotHoldTheCallerUp) {
  OrderedCalls calls(true);
  std::promise<void> from_caller;
  auto waits = calls.Start([&] { from_caller.get_future().wait(); });
  from_caller.set_value();  // is only reached if Start() returned
  waits.get();
}

TEST(OrderedCalls, PassOnWhatIsThrownAndGoOn) {
  for (const bool aside : {false, true}) {
    OrderedCalls calls(aside);
    auto fails = calls.Start([]() -> int { throw std::runtime_error("lost"); });
    auto works = calls.Start([] { return 1; });
    EXPECT_EQ(works.get(), 1);
    EXPECT_THROW(fails.get(), std::runtime_error);
  }
}

}  // namespace
}  // namespace doorforge::internal
