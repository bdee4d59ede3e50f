// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "doorforge/schemas/names.h"

namespace doorforge {

/// Where the middle of a closed door lies beside the hand that holds it: the mean of y of what is
/// within 0.12, 0.3 and 0.8 m of the hand, from the hand, in these units; 0 where nothing is. The
/// mirror image of a door has the same numbers with the opposite sign. More numbers tell the sides
/// of known categories apart better and those of others worse
/// (docs/design/notes/2026-11-25-both-sides.md).
using SideNumbers = std::array<float, 3>;

/// @param door_xyz n x 3, world [m], without the robot, in any order.
/// @throws Error(kInvalidArgument) without a point.
SideNumbers SideNumbersOf(std::span<const float> door_xyz, const Eigen::Vector3f& hand_m);

/// A door that was seen closed, and where its hinge is.
struct SideExample {
  SideNumbers numbers{};
  HingeSide side = HingeSide::kLeft;
};

inline constexpr int kSideSchemaVersion = 1;

/// Tells from a picture of the closed door on which side its hinge is. A logistic regression
/// without a bias, so that a door and its mirror image never get the same answer.
struct SideClassifier {
  SideNumbers weight{};

  /// The natural logarithm of p / (1 - p), with p the probability that the hinge is left.
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
