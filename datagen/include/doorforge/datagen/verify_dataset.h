// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

/// A fault of a dataset. Codes are listed in docs/format-shards.md.
struct DatasetFinding {
  std::string code;   ///< "DST001"
  std::string where;  ///< File, and member within it.
  std::string measured;
  std::string allowed;
  std::string fix;
};

struct VerifyRequest {
  std::filesystem::path folder;
  int threads = 0;                 ///< 0: all processors.
  std::function<void()> on_shard;  ///< Called after each shard, from any thread; may be empty.
};

/// Checks a dataset's folder completely: every byte of every shard against its checksums, every
/// array's type, shape and values, meta data against index, counts against dataset.json, and that
/// no body or handle is on both sides of a split. Finds all faults, not the first; their order does
/// not depend on threads.
///
/// @throws Error(kMissing) if `folder` is not a folder.
std::vector<DatasetFinding> VerifyDataset(const VerifyRequest& request);

/// {"schema", "schema_version", "findings": [...], "counts": {code: number}}
nlohmann::ordered_json FindingsToJson(const std::vector<DatasetFinding>& findings);

}  // namespace doorforge
