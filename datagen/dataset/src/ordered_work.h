// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "doorforge/core/parallel_for.h"

namespace doorforge {

/// Makes items in parallel and hands them on one at a time in the order of their indices, with at
/// most a few items a thread in memory.
///
/// The first exception of `produce` or `consume` ends the work and is rethrown by Run().
template <class Item>
class OrderedWork {
 public:
  using Produce = std::function<Item(std::size_t)>;
  using Consume = std::function<void(std::size_t, Item)>;
  /// Polled before each item; true ends the work without an exception once the items that were
  /// begun are handed on.
  using Stop = std::function<bool()>;

  OrderedWork(Produce produce, Consume consume, Stop stop)
      : produce_(std::move(produce)), consume_(std::move(consume)), stop_(std::move(stop)) {}

  /// Items [0, count) on `threads` threads (0: all processors). Returns the number of items
  /// consumed: `count`, or less if stopped.
  std::size_t Run(std::size_t count, int threads) {
    count_ = count;
    const auto workers = static_cast<std::size_t>(ThreadCount(threads));
    ahead_ = 4 * workers;
    {
      std::vector<std::jthread> pool;
      for (std::size_t i = 1; i < workers; ++i) pool.emplace_back([this] { Work(); });
      Work();
    }
    if (failure_) std::rethrow_exception(failure_);
    return consumed_;
  }

 private:
  void Work() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return done_ || next_ < consumed_ + ahead_; });
      if (done_ || next_ >= count_) return;
      if (stop_()) {
        count_ = next_;
        changed_.notify_all();
        return;
      }
      const std::size_t index = next_++;
      lock.unlock();
      try {
        Item item = produce_(index);
        lock.lock();
        ready_.emplace(index, std::move(item));
        HandOn(lock);
      } catch (...) {
        if (!lock.owns_lock()) lock.lock();
        if (!failure_) failure_ = std::current_exception();
        return Finish();
      }
    }
  }

  // Called with the lock held, as Work() does.
  void Finish() {
    done_ = true;
    changed_.notify_all();
  }

  // Consumes what is next in order, unless another thread is at it.
  void HandOn(std::unique_lock<std::mutex>& lock) {
    if (consuming_) return;
    consuming_ = true;
    while (!done_ && !ready_.empty() && ready_.begin()->first == consumed_) {
      auto node = ready_.extract(ready_.begin());
      lock.unlock();
      consume_(node.key(), std::move(node.mapped()));
      lock.lock();
      ++consumed_;
      changed_.notify_all();
    }
    consuming_ = false;
  }

  Produce produce_;
  Consume consume_;
  Stop stop_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, Item> ready_;
  std::exception_ptr failure_;
  std::size_t count_ = 0;
  std::size_t ahead_ = 0;
  std::size_t next_ = 0;
  std::size_t consumed_ = 0;
  bool consuming_ = false;
  bool done_ = false;
};

}  // namespace doorforge
