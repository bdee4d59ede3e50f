// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/stage_networks.h"
#include "doorforge/networks/training_sample.h"

namespace doorforge {

inline constexpr int kFamiliarSchemaVersion = 1;
/// What a policy sees, in numbers that do not depend on its weights: how the cloud lies about the
/// place at which it decides, docs/format-policy.md lists them. As many as SightSize() says.
using SightNumbers = std::vector<float>;
std::size_t SightSize(NetworkFamily family);

/// A cloud as a policy is given it.
struct SightCloud {
  std::span<const float> xyz;           ///< n x 3, world [m]; point 0 as in TrainingSample.
  std::span<const std::uint8_t> label;  ///< PointLabel, n; read where a grasp is chosen.
};

/// It is seen from the hand, or where a grasp is chosen from the middle of the handle's points,
/// which are then counted apart from the others as well.
///
/// @throws Error(kInvalidArgument) without a point, or a grasp's labels.
SightNumbers SightNumbersOf(const SightCloud& cloud, const Proprioception& proprioception,
                            NetworkFamily family);

/// How far a sight lies from those that a policy was trained on: the Mahalanobis distance of its
/// numbers (Lee et al., NeurIPS 2018, there of a network's features) under the mean and the
/// covariance of training samples, the latter shrunk as Ledoit and Wolf (2004) do, and where that
/// stands among validation samples, which had no part in either.
class Familiarity {
 public:
  /// About 1 for what is as in training; at least 0. [root mean square of whitened numbers]
  /// @throws Error(kInvalidArgument) on another number of numbers than `mean` has.
  double DistanceOf(const SightNumbers& numbers) const;
  /// How many of a hundred validation samples are less far, in [0, 100]; 100 beyond all of them.
  double PercentileOf(double distance) const;
  /// The distance that so many of a hundred validation samples stay below.
  double DistanceAt(double percentile) const;

  std::vector<float> mean;       ///< It has as many numbers as an input, n.
  std::vector<float> whitening;  ///< n x n, lower triangle, row by row.
  std::vector<float> distances;  ///< They are those of validation samples, ascending, at least 2.
};

/// Whether a policy was also shown the mirror images of its samples, see mirror.h.
enum class SampleSides { kAsSeen, kMirroredToo };

/// From at most 4096 training and 2048 validation samples, evenly taken; without validation samples
/// every tenth of the others stands for them and is left out of the rest. Equal samples give equal
/// numbers. With mirror images, every second sample that is taken is taken as its own.
///
/// @returns Nothing with fewer than 20 training samples.
std::optional<Familiarity> FitFamiliarity(std::span<const TrainingSample> train,
                                          std::span<const TrainingSample> validation,
                                          NetworkFamily family,
                                          SampleSides sides = SampleSides::kAsSeen);

/// Writes `familiar.safetensors` into a policy's folder; without one removes what an earlier
/// training may have left there.
void WriteFamiliarity(const std::filesystem::path& folder,
                      const std::optional<Familiarity>& familiarity,
                      const std::string& dataset_sha256);

/// Reads it; nothing if the folder has none.
///
/// @param dataset_sha256 Of the policy's record.
/// @throws Error(kFormat) if it is damaged, of another version, or was made from other data than
///     the policy.
std::optional<Familiarity> ReadFamiliarity(const std::filesystem::path& folder,
                                           const std::string& dataset_sha256, NetworkFamily family);

}  // namespace doorforge
