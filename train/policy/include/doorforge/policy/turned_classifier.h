// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/schemas/policy.h"

namespace doorforge {

/// How the hand has moved since it began to turn the handle, and how it will have after the action
/// that is about to be carried out. What a robot knows of itself; nothing of the door. Along the
/// world's axes, four vectors of three: turn so far (rotation vector [rad]), turn after the action,
/// way so far [m], way after the action.
using HandMotion = std::array<float, 12>;

/// @param first The proprioception at the stage's first decision.
/// @param now Before the action.
HandMotion HandMotionOf(const Proprioception& first, const Proprioception& now,
                        const ActionVector& action);

/// What it is in the mirror image of the scene, see mirror.h.
HandMotion MirroredSideways(const HandMotion& motion);
HandMotion MirroredUpright(const HandMotion& motion);

/// A decision of the handle policy's data.
struct TurnedExample {
  HandMotion motion{};
  bool turned = false;  ///< After the executed action the handle was "handle done".
};

inline constexpr int kTurnedSchemaVersion = 1;
inline constexpr std::size_t kTurnedInputs = 28;

/// Tells from the hand's motion whether the handle will be turned once the action has been carried
/// out: the flag that ends the handle policy's stage, where no simulator says so. A logistic
/// regression of the 12 numbers, their magnitudes, and the lengths of the four vectors.
struct TurnedClassifier {
  std::array<float, kTurnedInputs> mean{};
  std::array<float, kTurnedInputs> deviation{};  ///< > 0
  std::array<float, kTurnedInputs> weight{};     ///< They weigh (input - mean) / deviation.
  float bias = 0;

  /// In (0, 1).
  double Probability(const HandMotion& motion) const;
};

/// Maximum likelihood with a ridge of weight 1 by Newton's method in double precision: the one
/// minimum of a convex function, without draws or settings. Equal examples give equal bytes.
///
/// @returns Nothing unless there are examples of both kinds.
std::optional<TurnedClassifier> FitTurnedClassifier(std::span<const TurnedExample> examples);

/// It counts the examples that the classifier calls turned, and those that are.
struct TurnedAccuracy {
  int correct = 0;  ///< Called turned, and are.
  int called = 0;   ///< Called turned, by a probability of at least one half.
  int turned = 0;   ///< Are turned.
};
TurnedAccuracy MeasureTurned(const TurnedClassifier& classifier,
                             std::span<const TurnedExample> examples);

/// Writes `turned.safetensors` into a policy's folder (docs/format-policy.md); without a classifier
/// removes what an earlier training may have left there.
void WriteTurnedClassifier(const std::filesystem::path& folder,
                           const std::optional<TurnedClassifier>& classifier,
                           const std::string& dataset_sha256);

/// Reads it; nothing if the folder has none.
///
/// @param dataset_sha256 Of the policy's record.
/// @throws Error(kFormat) if it is damaged, of a newer version, has another number of inputs, or
///     was made from other data than the policy.
std::optional<TurnedClassifier> ReadTurnedClassifier(const std::filesystem::path& folder,
                                                     const std::string& dataset_sha256);

}  // namespace doorforge
