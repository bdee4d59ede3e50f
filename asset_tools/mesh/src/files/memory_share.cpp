// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "files/memory_share.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace doorforge {
namespace {

struct Shares {
  std::mutex mutex;
  std::condition_variable changed;
  std::uint64_t free_bytes = MemoryShare::kTotalBytes;
  std::uint64_t next_ticket = 0;
  std::uint64_t served = 0;  // tickets; the next one is waited for, so that who wants much gets it
};

Shares& TheShares() {
  static Shares shares;
  return shares;
}

}  // namespace

MemoryShare::MemoryShare(std::uint64_t bytes) : bytes_(std::min(bytes, kTotalBytes)) {
  Shares& shares = TheShares();
  std::unique_lock lock(shares.mutex);
  const std::uint64_t ticket = shares.next_ticket++;
  shares.changed.wait(lock, [&] { return shares.served == ticket && shares.free_bytes >= bytes_; });
  shares.free_bytes -= bytes_;
  ++shares.served;
  shares.changed.notify_all();
}

MemoryShare::~MemoryShare() {
  Shares& shares = TheShares();
  const std::lock_guard lock(shares.mutex);
  shares.free_bytes += bytes_;
  shares.changed.notify_all();
}

}  // namespace doorforge
