// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "doorforge/core/file_system.h"

namespace doorforge {

/// Reads a whole file. Throws Error(kMissing) if it does not exist or is not a regular file, and
/// Error(kIo) if it cannot be read or is larger than `max_bytes`.
std::string ReadFile(const std::filesystem::path& path, std::uint64_t max_bytes = 1ULL << 32);

/// What to do where the output already exists.
enum class Existing {
  kRefuse,   ///< Error(kInvalidArgument) that names --overwrite.
  kReplace,  ///< The old file or folder is replaced as a whole.
};

/// Writes `content` so that the path holds either nothing new or all of it, even after a crash:
/// temporary name in the same folder, fsync, rename, fsync of the folder. Creates the folder.
void CommitFile(const std::filesystem::path& path, std::string_view content,
                Existing existing = Existing::kReplace);
/// The same through `files`.
void CommitFile(FileSystem& files, const std::filesystem::path& path, std::string_view content,
                Existing existing = Existing::kReplace);

/// Removes the temporary files that processes of this machine left below a folder when they were
/// killed. Those of processes that live, and of other machines, stay.
void RemoveStaleFiles(FileSystem& files, const std::filesystem::path& folder);

/// A folder that appears under its final name only when it is complete.
///
///     StagedFolder staged(out, Existing::kRefuse);
///     ... write below staged.path() ...
///     staged.Commit();
///
/// The constructor refuses early when the target exists; the destructor of an uncommitted folder
/// removes what was written, so a refused import leaves nothing behind.
class StagedFolder {
 public:
  explicit StagedFolder(std::filesystem::path target, Existing existing = Existing::kRefuse);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staging_; }
  void Commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path staging_;
  Existing existing_;
  bool committed_ = false;
};

/// Many small files or folders that appear in one folder, each whole or not at all, with one wait
/// for the disk for all of them: a file system flush in place of an fsync for each.
///
///     StagedBatch batch(folder);
///     ... write below batch.path(), plainly ...
///     batch.Commit();
///
/// The destructor removes what was not committed, and so does a later batch in the same folder for
/// a process that was killed.
class StagedBatch {
 public:
  /// Creates `folder`.
  explicit StagedBatch(std::filesystem::path folder);
  ~StagedBatch();
  StagedBatch(const StagedBatch&) = delete;
  StagedBatch& operator=(const StagedBatch&) = delete;

  const std::filesystem::path& path() const { return staging_; }
  /// Flushes, then renames every entry of path() into the folder, replacing what is there.
  void Commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path staging_;
};

/// Writes a file below a StagedBatch, without waiting for the disk. Creates its folder.
void WriteStaged(const std::filesystem::path& path, std::string_view content);

}  // namespace doorforge
