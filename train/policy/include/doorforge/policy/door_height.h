// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace doorforge {

/// How tall what the camera sees of a door is [m]: from the lowest to the highest of its points but
/// for one in fifty at either end, which may be noise.
///
/// @param door_xyz n x 3, world [m], without the robot, in any order.
/// @throws Error(kInvalidArgument) without a point.
double HeightInView(std::span<const float> door_xyz);

inline constexpr int kHeightsSchemaVersion = 1;

/// The heights of the doors that a policy has learned, so that one that has learned to push is not
/// tried on what is nothing like them: a safe has no way in.
struct LearnedHeights {
  double least_m = 0;
  double most_m = 0;

  /// A tenth of a height beyond either end is as good as learned.
  bool Knows(double height_m) const {
    return height_m >= 0.9 * least_m && height_m <= 1.1 * most_m;
  }
};

/// The second and the ninety-eighth of a hundred heights.
///
/// @returns Nothing with fewer than 20.
std::optional<LearnedHeights> FitHeights(std::span<const double> heights_m);

/// Writes `heights.safetensors` into a policy's folder (docs/format-policy.md); without heights
/// removes what an earlier training may have left there.
///
/// @param dataset_sha256 What the doors were taken from, for the record.
void WriteHeights(const std::filesystem::path& folder, const std::optional<LearnedHeights>& heights,
                  const std::string& dataset_sha256);

/// Reads them; nothing if the folder has none.
///
/// @throws Error(kFormat) if the file is damaged or of another version.
std::optional<LearnedHeights> ReadHeights(const std::filesystem::path& folder);

}  // namespace doorforge
