// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "doorforge/core/temporary_folder.h"

namespace doorforge::internal {

/// Bytes that one dropped file may have, and all that are kept at a time together.
inline constexpr std::uint64_t kMostFileBytes = std::uint64_t{64} << 20;
inline constexpr std::uint64_t kMostKeptBytes = std::uint64_t{256} << 20;

/// Names of files, each with the SHA-256 of the bytes that are meant.
using NamedFiles = std::map<std::string, std::string>;

/// Throws Error(kInvalidArgument) unless this is the name of a mesh (STL, OBJ, GLB), of an OBJ's
/// materials (MTL) or of a picture (PNG, JPEG) and of nothing else: no path, no pattern, not
/// hidden.
void CheckFileName(const std::string& name);

/// Whether a name that was checked is a mesh's.
bool IsMeshName(const std::string& name);

/// Files that were dropped, by the hash of their bytes, in a folder that goes with this object. Of
/// more than kMostKeptBytes those go that were longest not asked for. Safe to use from several
/// threads.
class DroppedFiles {
 public:
  /// Keeps the bytes; returns their SHA-256. Throws Error(kInvalidArgument) if they are too many.
  std::string Keep(const std::string& bytes);

  /// Puts the files into a folder under their names. Throws Error(kInvalidArgument) on a name that
  /// is none (see CheckFileName()), Error(kMissing) for one that is not kept.
  void PutInto(const std::filesystem::path& folder, const NamedFiles& files);

 private:
  struct Kept {
    std::uint64_t bytes = 0;
    std::list<std::string>::iterator turn;
  };

  void Forget();

  TemporaryFolder folder_;
  std::mutex mutex_;
  std::map<std::string, Kept> kept_;
  std::list<std::string> turns_;  // the longest unasked first
  std::uint64_t total_ = 0;
};

}  // namespace doorforge::internal
