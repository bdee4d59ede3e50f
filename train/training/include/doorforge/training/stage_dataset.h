// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/networks/training_sample.h"
#include "doorforge/policy/side_classifier.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/schemas/seen_parts.h"

namespace doorforge {

class DatasetReader;

/// What samples are read as.
struct SampleOptions {
  bool colors = false;  ///< Samples have the colours of their points as well.
  /// Decisions are those of the mirror image that MirroringPolicy shows: at the stages "handle" and
  /// "open" of doors hinged right; at the stage "handle", in a level mirror, of handles that unlock
  /// the other way, whose way is the usual one then. No sense where a network reads the arm's
  /// joints, since the mirror image of an arm is another arm.
  bool shows_mirrored = false;
};

/// A stage's samples of one or more data sets. Clouds stay in the shards' memory maps, so the
/// samples are valid as long as this object.
struct StageDataset {
  std::vector<TrainingSample> train;
  std::vector<TrainingSample> validation;
  /// The stage "handle" has one for each sample, in its order.
  std::vector<TurnedExample> turned_train;
  std::vector<TurnedExample> turned_validation;
  /// The stage "open" has one for each episode that is trained from: the closed door of its first
  /// decision, without the robot's points.
  std::vector<SideExample> sides;
  std::vector<double> heights_m;  ///< Likewise, HeightInView().
  SeenParts parts;                ///< They are those of the doors of all data sets.
  std::string content_sha256;     ///< StageContentSha256() gives it.
  SampleOptions options;
  std::vector<std::unique_ptr<DatasetReader>> readers;

  StageDataset();
  ~StageDataset();
  StageDataset(StageDataset&&) noexcept;
  StageDataset& operator=(StageDataset&&) noexcept;

  /// Throws Error(kIo), naming the file, if another program has cut a shard since: what is computed
  /// from the samples then is worth nothing.
  void RequireWhole() const;
};

/// Reads of every folder `provenance.json`, `<stage>/train`, and `<stage>/val` if there is one;
/// otherwise the last `validation_share` of the episodes, rounded up, are set aside (whole
/// episodes; none if the share is 0 or there is only one). Several data sets: the samples of the
/// first, then the second's.
///
/// @throws Error(kMissing or kFormat) as DatasetReader, or if clouds do not hold 4096 points;
///     Error(kInvalidArgument) without a folder, or where clouds have no colours that are asked
///     for.
StageDataset ReadStageDataset(std::span<const std::filesystem::path> folders,
                              std::string_view stage, double validation_share,
                              const SampleOptions& options = {});

}  // namespace doorforge
