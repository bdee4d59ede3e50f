// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "datasets/mapping_guard.h"

namespace doorforge {

/// A file mapped for reading.
///
/// What another program cuts off the file while it is mapped reads as zeros from then on. Whoever
/// computes something from bytes() that was not compared with a checksum since calls RequireWhole()
/// before the result is given away.
class MappedFile {
 public:
  /// Throws Error(kMissing) if there is no such regular file, Error(kIo) if it cannot be mapped.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return {data_, size_}; }

  /// Throws Error(kIo), naming the file, if a part of it could not be read since it was mapped, or
  /// if it is shorter by now than it was then.
  void RequireWhole() const;

 private:
  std::filesystem::path path_;
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  dev_t device_ = 0;
  ino_t inode_ = 0;
  std::optional<internal::MappingGuard> guard_;  // none for an empty file
};

}  // namespace doorforge
