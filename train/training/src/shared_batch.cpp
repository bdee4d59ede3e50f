// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "shared_batch.h"

#include <algorithm>
#include <utility>

namespace doorforge::internal {

BatchFeatures GatherFeatures(ProcessGroup& group, std::span<const float> own) {
  if (group.size() == 1) return {{own.begin(), own.end()}, 0, own.size()};
  const auto own_size = static_cast<float>(own.size());  // below 2^24: exact
  const std::vector<float> sizes = group.Gather(std::span(&own_size, 1));
  const auto longest = static_cast<std::size_t>(*std::ranges::max_element(sizes));
  std::vector<float> padded(own.begin(), own.end());
  padded.resize(longest);
  const std::vector<float> gathered = group.Gather(padded);
  BatchFeatures features{{}, 0, own.size()};
  for (std::size_t rank = 0; rank < sizes.size(); ++rank) {
    if (std::cmp_equal(rank, group.rank())) features.own_begin = features.all.size();
    const auto begin = gathered.begin() + static_cast<std::ptrdiff_t>(rank * longest);
    features.all.insert(features.all.end(), begin,
                        begin + static_cast<std::ptrdiff_t>(sizes[rank]));
  }
  return features;
}

}  // namespace doorforge::internal
