// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/schemas/safetensors.h"

namespace doorforge::internal {

/// A file of tensors beside a policy's weights, made from the same data.
struct CompanionKind {
  const char* schema;
  int version;
  const char* renew;  ///< How to get one of this version, for the message.
};

/// Throws Error(kFormat) unless the file is of this kind and version, and was made from the data
/// set of this hash; `path` begins the messages.
void RequireCompanion(const TensorFile& file, const CompanionKind& kind,
                      const std::string& dataset_sha256, const std::string& path);

}  // namespace doorforge::internal
