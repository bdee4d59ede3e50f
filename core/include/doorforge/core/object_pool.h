// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace doorforge {

/// Lends objects that take long to make and serve one user at a time, such as policies: as many are
/// made as are ever in use at once. Safe to use from several threads.
template <class T>
class ObjectPool {
 public:
  /// @param make A new object; called while the pool is locked, so by one thread at a time.
  explicit ObjectPool(std::function<T()> make) : make_(std::move(make)) {}

  /// Puts the object back when it goes; the pool must outlive it.
  struct Return {
    ObjectPool* pool = nullptr;
    void operator()(T* object) const {
      const std::scoped_lock lock(pool->mutex_);
      pool->idle_.emplace_back(object);
    }
  };
  using Lease = std::unique_ptr<T, Return>;

  /// Throws as `make`.
  Lease Take() {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty()) return Lease(std::make_unique<T>(make_()).release(), {this});
    std::unique_ptr<T> object = std::move(idle_.back());
    idle_.pop_back();
    return Lease(object.release(), {this});
  }

 private:
  std::function<T()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> idle_;
};

}  // namespace doorforge
