// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace doorforge::internal {

/// Values that are pure functions of their key, kept until they weigh more than `budget`; then the
/// oldest go. What Get() returns does not depend on what is kept, nor on the number of threads: two
/// that ask at once for the same may both make it.
template <class Value>
class Memo {
 public:
  explicit Memo(std::size_t budget) : budget_(budget) {}

  /// @param make Returns the Value of `key`. @param weigh Returns its weight.
  template <class Make, class Weigh>
  std::shared_ptr<const Value> Get(const std::string& key, const Make& make, const Weigh& weigh) {
    {
      const std::lock_guard lock(mutex_);
      const auto kept = values_.find(key);
      if (kept != values_.end()) return kept->second.first;
    }
    auto made = std::make_shared<const Value>(make());
    Keep(key, made, weigh(*made));
    return made;
  }

 private:
  void Keep(const std::string& key, const std::shared_ptr<const Value>& value, std::size_t weight) {
    const std::lock_guard lock(mutex_);
    if (!values_.try_emplace(key, value, weight).second) return;
    order_.push_back(key);
    weight_ += weight;
    while (weight_ > budget_ && order_.size() > 1) {
      const auto oldest = values_.find(order_.front());
      weight_ -= oldest->second.second;
      values_.erase(oldest);
      order_.pop_front();
    }
  }

  std::mutex mutex_;
  std::size_t budget_;
  std::size_t weight_ = 0;
  std::map<std::string, std::pair<std::shared_ptr<const Value>, std::size_t>> values_;
  std::deque<std::string> order_;
};

}  // namespace doorforge::internal
