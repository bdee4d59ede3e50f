// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace doorforge {

/// What a finished dataset says of itself to people and to catalogues of datasets.
struct DatasetCardFiles {
  /// README.md: YAML front matter as the Hugging Face hub reads it (licence, tags, one
  /// configuration a stage with its shards), then what is in the data, how they were made, how to
  /// read them, and what they are not.
  std::string readme;
  /// croissant.json: JSON-LD of MLCommons' Croissant format 1.0
  /// (https://docs.mlcommons.org/croissant/docs/croissant-spec.html). Every file with its size and
  /// SHA-256, a file set for each array, record sets of the episodes' meta data and of the
  /// failures.
  nlohmann::ordered_json croissant;
};

/// Reads records and indices, not the shards, whose hashes the indices hold. A pure function of the
/// dataset. Throws Error(kMissing or kFormat).
DatasetCardFiles MakeDatasetCard(const std::filesystem::path& folder);

/// What WriteDatasetCard() does with the README.md that is there.
enum class OldReadme {
  kRefuseOthers,  ///< Replaced if `datagen` or this wrote it; Error(kInvalidArgument) if not.
  kReplace,       ///< Replaced whatever it is.
  kKeep,          ///< Stays, and `verify` takes it as it is from now on.
};

/// Writes both files into the dataset's folder, and their lines of SHA256SUMS where there is one;
/// README.md replaces the short one of `datagen`. Locks the folder meanwhile.
///
/// @throws Error(kMissing) if it is no folder; Error(kInvalidArgument) if somebody else writes into
///     it, or there is a README.md or croissant.json that was not written
///     here, see OldReadme; Error(kFormat) if SHA256SUMS is damaged; as MakeDatasetCard().
void WriteDatasetCard(const std::filesystem::path& folder,
                      OldReadme readme = OldReadme::kRefuseOthers);

}  // namespace doorforge
