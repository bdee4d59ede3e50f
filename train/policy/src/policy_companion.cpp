// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "policy_companion.h"

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

std::string MetadataOf(const TensorFile& file, const std::string& key) {
  const auto found = file.metadata.find(key);
  return found == file.metadata.end() ? "" : found->second;
}

}  // namespace

void RequireCompanion(const TensorFile& file, const CompanionKind& kind,
                      const std::string& dataset_sha256, const std::string& path) {
  const std::string version = std::to_string(kind.version);
  const std::string schema = MetadataOf(file, "schema");
  const std::string found = MetadataOf(file, "schema_version");
  if (schema != kind.schema || found != version)
    throw Error(ErrorCode::kFormat, path + ": schema \"" + schema + "\" version \"" + found +
                                        "\", expected \"" + kind.schema + "\" version \"" +
                                        version + "\"; " + kind.renew);
  const std::string data = MetadataOf(file, "dataset_sha256");
  if (data != dataset_sha256)
    throw Error(ErrorCode::kFormat, path + ": was made from the data " + data.substr(0, 12) +
                                        "..., the policy beside it from " +
                                        dataset_sha256.substr(0, 12) +
                                        "...; run its training again with --resume");
}

}  // namespace doorforge::internal
