// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "doorforge/training/process_group.h"

// What processes that share a batch tell each other about it.

namespace doorforge::internal {

/// Features of the whole batch, of which this process has encoded own_size from own_begin on.
struct BatchFeatures {
  std::vector<float> all;
  std::size_t own_begin = 0;
  std::size_t own_size = 0;
};

/// `own` may have another length in each process, and be empty; below 2^24.
BatchFeatures GatherFeatures(ProcessGroup& group, std::span<const float> own);

}  // namespace doorforge::internal
