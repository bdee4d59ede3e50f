// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/dataset/describe_episodes.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

/// One tile a stage and category: a histogram of how far its doors were opened, over 0 to 120 deg,
/// with a thin line every 30 deg.
///
/// @throws Error(kMissing) if the dataset has no episodes.
Picture EpisodeCharts(const EpisodeDescription& description);

}  // namespace doorforge
