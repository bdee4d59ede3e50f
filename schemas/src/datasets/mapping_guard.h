// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace doorforge::internal {

struct GuardedSlot;

/// Keeps a mapped file from ending the process when a part of it cannot be read: when the file was
/// cut by another program while it is mapped, or its disk fails. Without it the system answers such
/// a read with SIGBUS.
///
/// The process's handler of SIGBUS, set when the first range is guarded, puts zeros in the place of
/// what cannot be read, from the page at hand to the end of the range, and notes the damage here.
/// Whoever reads asks IsDamaged() afterwards, before anything that was computed is given away. A
/// SIGBUS of another address goes to the handler that was there before. Ranges may be guarded and
/// read from any number of threads at once.
class MappingGuard {
 public:
  /// @param begin, size The range as mmap() gave it; it stays mapped as long as this lives.
  MappingGuard(const void* begin, std::size_t size);
  ~MappingGuard();
  MappingGuard(const MappingGuard&) = delete;
  MappingGuard& operator=(const MappingGuard&) = delete;

  bool IsDamaged() const;

 private:
  GuardedSlot* slot_;
};

}  // namespace doorforge::internal
