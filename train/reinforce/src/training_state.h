// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/safetensors.h"
#include "doorforge/schemas/seen_parts.h"

// What the states of this room's trainings have in common: one file each, with a hash over all that
// it holds, that says what it belongs to.

namespace doorforge::internal {

inline constexpr const char* kTrainingState = "training.safetensors";

/// SHA-256 of the ids and contents of the doors.
std::string HashOfDoors(const std::vector<FoundDoor>& doors);

SeenParts PartsOfDoors(const std::vector<FoundDoor>& doors);

/// A folder that holds a training is only touched if the user said how: Error(kInvalidArgument).
void RequireUnusedFolder(const std::filesystem::path& folder, bool resume, bool overwrite);

/// The lines with which both trainings begin to say what came of them.
std::string OutcomeHead(const std::vector<std::string>& notes, const std::filesystem::path& out,
                        std::size_t doors);

/// Adds the metadata and writes it, so that a crash leaves the old file or the new one.
void WriteTrainingState(const std::filesystem::path& folder, const std::string& kind,
                        const PpoOrigin& origin, TensorFile file);

/// Throws Error(kFormat) if it is damaged or of another kind, Error(kInvalidArgument) if it was
/// written for other settings or doors, naming what differs.
TensorFile ReadTrainingState(const std::filesystem::path& folder, const std::string& kind,
                             const PpoOrigin& expected);

/// Numbers of rows by their columns, one row after the other, and back.
template <class Row, class Columns>
std::vector<double> NumbersOfRows(const std::vector<Row>& rows, const Columns& columns) {
  std::vector<double> numbers;
  for (const Row& row : rows)
    for (const auto& column : columns) numbers.push_back(row.*column.value);
  return numbers;
}
template <class Row, class Columns>
std::vector<Row> RowsOfNumbers(const std::vector<double>& numbers, const Columns& columns) {
  std::vector<Row> rows(numbers.size() / columns.size());
  auto number = numbers.begin();
  for (Row& row : rows)
    for (const auto& column : columns) row.*column.value = *number++;
  return rows;
}

/// The rows of a tensor of such numbers. Throws Error(kFormat), naming `path`.
template <class Row, class Columns>
std::vector<Row> RowsOfTensor(const Tensor& tensor, const Columns& columns,
                              const std::string& path) {
  const std::uint64_t count = tensor.shape.empty() ? 0 : tensor.shape[0];
  return RowsOfNumbers<Row>(ValuesOf<double>(tensor, {count, columns.size()}, path), columns);
}

}  // namespace doorforge::internal
