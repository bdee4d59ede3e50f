// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace doorforge {

/// The stage of a policy that both turns and opens, trained from the data of both stages: the
/// paper's ablation without disentangling. It is no stage of an episode or of a data set.
inline constexpr std::string_view kMotionStage = "motion";

/// The stage of a finder of handles, trained from looks at closed doors, which are data of the
/// stage "grasp".
inline constexpr std::string_view kFindStage = "find";

/// Whether a policy that was trained for one stage acts at another: at its own; one of kMotionStage
/// at "handle" and at "open".
bool ActsAt(std::string_view trained, std::string_view stage);

/// The stage whose shards a training reads of a data set: its own; of kMotionStage "handle" where
/// the data set has that, else "open"; of kFindStage "grasp".
std::string StageReadOf(const std::filesystem::path& folder, std::string_view stage);

/// SHA-256 that tells what a stage's networks were trained from: over the content hashes of the
/// splits "train" and, where there is one, "val" of all data sets in their order. A policy's record
/// holds it (PolicyProvenance::dataset_sha256). Reads the shards' indices, no cloud.
///
/// @throws Error(kInvalidArgument) without a folder, Error(kMissing or kFormat) as DatasetReader.
std::string StageContentSha256(std::span<const std::filesystem::path> folders,
                               std::string_view stage);

}  // namespace doorforge
