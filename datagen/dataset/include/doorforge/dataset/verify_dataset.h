// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

enum class DatasetSeverity {
  kError,
  kNote,  ///< Said, and no fault of the dataset: a file that is no part of it.
};

/// A fault of a dataset. Codes are listed in docs/format-shards.md.
struct DatasetFinding {
  std::string code;   ///< "DST001"
  std::string where;  ///< File, and member within it.
  std::string measured;
  std::string allowed;
  std::string fix;
  DatasetSeverity severity = DatasetSeverity::kError;
};

struct VerifyRequest {
  std::filesystem::path folder;
  int threads = 0;                 ///< 0: all processors.
  std::function<void()> on_shard;  ///< Called after each shard, from any thread; may be empty.
};

/// Checks a dataset's folder completely, every byte of every file that belongs to it: shards
/// against their checksums, every array's type, shape and values, meta data against index; splits,
/// failures.jsonl, dataset.json against what provenance.json and the shards make them, config.yaml
/// against the hash in every index, and all records against SHA256SUMS; and that no body or handle
/// is on both sides of a split. Finds all faults, not the first; their order does not depend on
/// threads. Of an unfinished dataset, what is there is checked just so.
///
/// Datasets of earlier builds have no SHA256SUMS. Of those this cannot tell a change in the fields
/// of provenance.json that are recorded nowhere else, in the prose of dataset.json, or in a
/// croissant.json of another build.
///
/// @throws Error(kMissing) if `folder` is not a folder.
std::vector<DatasetFinding> VerifyDataset(const VerifyRequest& request);

/// Number of shards below a dataset's folder, for progress. Throws Error(kMissing) if it is not a
/// folder.
std::size_t CountShards(const std::filesystem::path& folder);

/// Whether there is more than notes.
bool AnyFault(const std::vector<DatasetFinding>& findings);

/// {"schema", "schema_version", "findings": [...], "counts": {code: number}}
nlohmann::ordered_json FindingsToJson(const std::vector<DatasetFinding>& findings);

/// Says what FindingsToJson() says, for people; the last line says how many faults there are.
///
/// @param folder The dataset's, as the user named it.
std::string FindingsText(const std::vector<DatasetFinding>& findings,
                         const std::filesystem::path& folder);

}  // namespace doorforge
