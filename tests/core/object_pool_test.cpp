// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/object_pool.h"

#include <atomic>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "doorforge/core/parallel_for.h"

namespace doorforge {
namespace {

TEST(ObjectPool, MakesAsManyAsAreInUseAtOnceAndLendsThemAgain) {
  int made = 0;
  ObjectPool<int> pool([&] { return ++made; });
  {
    const auto first = pool.Take();
    const auto second = pool.Take();
    EXPECT_EQ(*first, 1);
    EXPECT_EQ(*second, 2);
  }
  const auto one = pool.Take();
  const auto other = pool.Take();
  EXPECT_EQ((std::set<int>{*one, *other}), (std::set<int>{1, 2}));
  EXPECT_EQ(made, 2);
}

TEST(ObjectPool, AnObjectServesOneThreadAtATime) {
  struct Exclusive {
    std::unique_ptr<std::atomic<int>> users = std::make_unique<std::atomic<int>>(0);
  };
  ObjectPool<Exclusive> pool([] { return Exclusive{}; });
  std::atomic<int> shared = 0;
  ParallelFor(2000, 4, [&](std::size_t) {
    const auto object = pool.Take();
    if (++*object->users != 1) ++shared;
    --*object->users;
  });
  EXPECT_EQ(shared, 0);
}

TEST(ObjectPool, WhatCannotBeMadeIsTriedAgain) {
  int tried = 0;
  ObjectPool<int> pool([&] {
    if (++tried == 1) throw std::runtime_error("no");
    return tried;
  });
  EXPECT_THROW(pool.Take(), std::runtime_error);
  EXPECT_EQ(*pool.Take(), 2);
}

}  // namespace
}  // namespace doorforge
