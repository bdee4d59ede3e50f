// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// True from now on after so many minutes, or when the program is asked to stop; 0: only then. May
/// be asked by several threads at once.
std::function<bool()> StopAfter(double minutes);

/// The lines with which all trainings begin to say what came of them.
std::string OutcomeHead(const std::vector<std::string>& notes, const std::filesystem::path& out,
                        std::size_t doors);

/// Adds the metadata and writes it, so that a crash leaves the old file or the new one.
void WriteTrainingState(const std::filesystem::path& folder, const std::string& kind,
                        const PpoOrigin& origin, TensorFile file);

/// Throws Error(kFormat) if it is damaged or of another kind, Error(kInvalidArgument) if it was
/// written for other settings or doors, naming what differs.
TensorFile ReadTrainingState(const std::filesystem::path& folder, const std::string& kind,
                             const PpoOrigin& expected);

/// Writes the samples that a round added, `samples/round_<round>.safetensors`, and returns the
/// file's SHA-256; rounds count from 0.
std::string WriteRoundSamples(const std::filesystem::path& folder, std::uint64_t round,
                              const TensorFile& samples);

/// Samples of a round with the place that they were read from.
struct RoundSamples {
  std::string path;
  TensorFile file;

  template <class T>
  std::vector<T> Values(const char* name, const std::vector<std::uint64_t>& shape) const {
    return ValuesOf<T>(TensorNamed(file, name, path), shape, path);
  }
  /// The first length of a tensor.
  std::uint64_t Rows(const char* name) const;
};

/// Reads them back. Throws Error(kMissing), or Error(kFormat) where the hash is another.
RoundSamples ReadRoundSamples(const std::filesystem::path& folder, std::uint64_t round,
                              const std::string& sha256);

/// The hashes of the rounds' samples in a state, and back: one a round, else Error(kFormat).
void NoteSamples(const std::vector<std::string>& sha256, TensorFile& state);
std::vector<std::string> NotedSamples(const TensorFile& state, std::size_t rounds,
                                      const std::string& path);

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
