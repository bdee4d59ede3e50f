// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "doorforge/learn/training_sample.h"

namespace doorforge {

class DatasetReader;

/// The opening stage's samples of a data set. Clouds stay in the shards' memory maps, so the
/// samples are valid as long as this object.
struct OpeningDataset {
  std::vector<TrainingSample> train;
  std::vector<TrainingSample> validation;
  std::string content_sha256;  ///< Over both splits' shards.
  std::vector<std::unique_ptr<DatasetReader>> readers;

  OpeningDataset();
  ~OpeningDataset();
  OpeningDataset(OpeningDataset&&) noexcept;
  OpeningDataset& operator=(OpeningDataset&&) noexcept;
};

/// Reads `<folder>/open/train`, and `open/val` if there is one; otherwise the last
/// `validation_share` of the episodes, rounded up, are set aside (whole episodes; none if the share
/// is 0 or there is only one).
///
/// @throws Error(kMissing or kFormat) as DatasetReader, or if clouds do not hold 4096 points.
OpeningDataset ReadOpeningDataset(const std::filesystem::path& folder, double validation_share);

}  // namespace doorforge
