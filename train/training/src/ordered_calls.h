// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <utility>

namespace doorforge::internal {

/// Runs calls one after the other, in the order of Start(), beside the caller. What a call throws
/// comes out of its future.
class OrderedCalls {
 public:
  /// @param aside False: calls are run within Start().
  explicit OrderedCalls(bool aside) : aside_(aside) {}

  /// `function` is called once; what it refers to must live until its future is ready.
  template <class Function>
  auto Start(Function function) -> std::future<decltype(function())> {
    if (!aside_) {
      std::packaged_task<decltype(function())()> task(std::move(function));
      task();
      return task.get_future();
    }
    std::promise<void> done;
    const std::shared_future<void> before = std::exchange(last_, done.get_future().share());
    return std::async(std::launch::async,
                      [function = std::move(function), before, done = std::move(done)]() mutable {
                        if (before.valid()) before.wait();
                        const Signal signal{&done};
                        return function();
                      });
  }

 private:
  struct Signal {
    std::promise<void>* done;
    ~Signal() { done->set_value(); }
  };

  bool aside_;
  std::shared_future<void> last_;
};

}  // namespace doorforge::internal
