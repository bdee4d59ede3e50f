// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

/// The schema of a record that programs write.
struct RecordSchema {
  std::string name;               ///< "dataset": the file is schemas/json/dataset.schema.json.
  nlohmann::ordered_json schema;  ///< JSON Schema, draft 2020-12.
};

/// JSON Schemas of the records of a dataset: dataset.json, provenance.json, a shard's index, an
/// episode's meta.json and a line of failures.jsonl.
///
/// They are made from the C++ records: a record in which nothing is left out goes through its
/// codec, and what comes out gives names, order, types and signs. What the type does not say
/// (closed sets of names, keys that earlier builds did not write) is added by the key's place, and
/// a place that the codec no longer writes is an error. Keys beyond the schema are allowed: later
/// builds of the same version may add some, and programs add theirs to meta.json.
std::vector<RecordSchema> RecordSchemas();

}  // namespace doorforge
