// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "doorforge/core/file_system.h"

namespace doorforge {

/// SHA-256 of a dataset's records, as its file SHA256SUMS holds them; `sha256sum -c SHA256SUMS`
/// reads it too.
///
/// Most records follow from the shards and the plan, and are compared with what follows. This is
/// for what is written down nowhere else: compiler and unplayed doors of provenance.json, and the
/// words of README.md, croissant.json and dataset.json, which other builds word differently.
class RecordSums {
 public:
  static constexpr const char* kFileName = "SHA256SUMS";

  /// Throws Error(kMissing) if there is none, as in datasets of earlier builds, and Error(kFormat)
  /// if it is not what its own first line says.
  static RecordSums Read(const std::filesystem::path& folder);
  /// Empty where Read() throws.
  static RecordSums ReadOrEmpty(const std::filesystem::path& folder);

  /// The keys are paths from the dataset's folder.
  const std::map<std::string, std::string>& sums() const { return sums_; }
  bool Has(const std::string& record) const { return sums_.contains(record); }
  void Set(const std::string& record, std::string_view content);
  void SetHash(const std::string& record, const std::string& sha256) { sums_[record] = sha256; }

  /// Whether the record is listed and has just this content.
  bool Lists(const std::string& record, std::string_view content) const;

  /// Writes the file if it is not there already with the same content. Throws Error(kIo).
  void Commit(FileSystem& files, const std::filesystem::path& folder) const;

 private:
  std::map<std::string, std::string> sums_;
};

}  // namespace doorforge
