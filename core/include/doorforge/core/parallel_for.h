// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace doorforge {

/// Number of threads that `requested` stands for: itself if positive, all processors if 0.
int ThreadCount(int requested);

/// Calls body(i) once for each i in [0, count) on up to `threads` threads (0: all processors).
///
/// Items are handed out in order; the caller keeps results apart by index, so that they do not
/// depend on the number of threads. The first exception by index is rethrown after all threads have
/// ended; later items may then not have run.
void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace doorforge
