// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace doorforge {

/// It is that of `losses.json`, which a training writes beside its policy.
inline constexpr int kLossesSchemaVersion = 1;

/// A loss over the epochs; `validation` may hold NaN (null in the file).
struct TrainingCurve {
  std::string name;  ///< Such as "actor.position_m".
  std::vector<double> epoch;
  std::vector<double> train;
  std::vector<double> validation;
};

/// Writes `losses.json` (schema doorforge.losses).
void WriteTrainingCurves(const std::filesystem::path& folder,
                         const std::vector<TrainingCurve>& curves);

/// Reads `losses.json`. Throws Error(kMissing or kFormat).
std::vector<TrainingCurve> ReadTrainingCurves(const std::filesystem::path& folder);

}  // namespace doorforge
