// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace doorforge {

/// Names of the JSON Schemas (draft 2020-12) in the data folder's `schemas`, sorted: "dataset" for
/// dataset.schema.json. Throws Error(kMissing) if that folder is not there.
std::vector<std::string> PublishedSchemas();

/// The text of one. Throws Error(kInvalidArgument), with the nearest name, if there is none.
std::string PublishedSchema(const std::string& name);

}  // namespace doorforge
