// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace doorforge {

/// A part of the memory that the reading processes of this process may take together. The
/// constructor waits until that much is free, first come, first served; the destructor gives it
/// back. One thread holds no more than one, or it might wait for itself.
class MemoryShare {
 public:
  static constexpr std::uint64_t kTotalBytes = 2ULL << 30;

  /// More than kTotalBytes is all of it.
  explicit MemoryShare(std::uint64_t bytes);
  ~MemoryShare();
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint64_t bytes_;
};

}  // namespace doorforge
