// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "doorforge/schemas/names.h"

namespace doorforge {

/// How a closed door lies about the hand that holds it, less how its mirror image lies about the
/// hand's: the difference of both SightNumbersOf() a motion. The mirror image of a door has the
/// same numbers with the opposite sign.
using SideNumbers = std::vector<float>;

/// @param door_xyz n x 3, world [m], without the robot, in any order.
/// @throws Error(kInvalidArgument) without a point.
SideNumbers SideNumbersOf(std::span<const float> door_xyz, const Eigen::Vector3f& hand_m);

/// A door that was seen closed, and where its hinge is.
struct SideExample {
  SideNumbers numbers;
  HingeSide side = HingeSide::kLeft;
};

inline constexpr int kSideSchemaVersion = 1;

/// Tells from a picture of the closed door on which side its hinge is. A logistic regression
/// without a bias, so that a door and its mirror image never get the same answer.
struct SideClassifier {
  std::vector<float> weight;  ///< As many as there are side numbers.

  /// The natural logarithm of p / (1 - p), with p the probability that the hinge is left.
  ///
  /// @throws Error(kInvalidArgument) on another number of numbers than there are weights.
  double LogOddsOfLeft(const SideNumbers& numbers) const;
};

/// Maximum likelihood with a ridge of weight 1 on numbers scaled by their root mean square. Equal
/// examples give equal bytes.
///
/// @returns Nothing with fewer than 20 examples.
std::optional<SideClassifier> FitSideClassifier(std::span<const SideExample> examples);

/// Writes `side.safetensors` into a policy's folder (docs/format-policy.md); without a classifier
/// removes what an earlier training may have left there. It belongs to doors, not to the policy's
/// weights, so it may come from other data than these.
///
/// @param dataset_sha256 What the examples were taken from, for the record.
void WriteSideClassifier(const std::filesystem::path& folder,
                         const std::optional<SideClassifier>& classifier,
                         const std::string& dataset_sha256);

/// Reads it; nothing if the folder has none.
///
/// @throws Error(kFormat) if it is damaged or of another version.
std::optional<SideClassifier> ReadSideClassifier(const std::filesystem::path& folder);

}  // namespace doorforge
