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
/// temporary name in the same folder, fsync, rename, fsync of the folder. Creates the folder; the
/// first one in a folder removes what killed writers left there, as a StagedFolder does.
void CommitFile(const std::filesystem::path& path, std::string_view content,
                Existing existing = Existing::kReplace);
/// Does so through `files`.
void CommitFile(FileSystem& files, const std::filesystem::path& path, std::string_view content,
                Existing existing = Existing::kReplace);

/// Removes the temporary files and folders, at any depth below a folder, of writers that were
/// killed. A writer holds a lock on what it stages for as long as it lives, so what is locked
/// stays, whichever container the writer runs in. Names begun before a restart of this machine, or
/// on another machine that shares the folder, are removed when they have not been touched for a
/// day. A folder that is not there holds nothing.
void RemoveStaleFiles(FileSystem& files, const std::filesystem::path& folder);

/// Creates `folder` if need be and writes and removes a file in it, so that a place where nothing
/// can be written is told before the work and not after it. Folders that it made, and that are
/// still empty, are removed again. Throws Error(kIo) that names the folder and the reason.
void RequireWritable(const std::filesystem::path& folder);

/// A kind of folder that doorforge writes, known by a record in it.
struct FolderKind {
  std::string_view name;    ///< For messages, such as "a door".
  std::string_view record;  ///< A file in the folder, such as "door.json".
  /// What the record's key "schema" must say; for a record that is no JSON, how it begins.
  std::string_view schema;
};

/// Throws Error(kInvalidArgument), which says what was expected and what to do, unless the folder
/// is a real one (no link) with the kind's record in it: what may be replaced or removed at a
/// user's word is what doorforge wrote, and nothing else.
void RequireKind(const std::filesystem::path& folder, const FolderKind& kind);

/// A folder that appears under its final name only when it is complete.
///
///     StagedFolder staged(out, kDoorFolder, Existing::kRefuse);
///     ... write below staged.path() ...
///     staged.Commit();
///
/// The constructor refuses early when the target exists, or with kReplace is there and not of this
/// kind; the destructor of an uncommitted folder removes what was written, so a refused import
/// leaves nothing behind. The first one in a folder removes what killed writers left there.
class StagedFolder {
 public:
  StagedFolder(std::filesystem::path target, const FolderKind& kind,
               Existing existing = Existing::kRefuse);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staging_; }
  void Commit();

 private:
  void Replace();

  std::filesystem::path target_;
  FolderKind kind_;
  Existing existing_;
  std::filesystem::path staging_;
  int lock_ = -1;  // on the staging folder, while this lives
  bool committed_ = false;
};

/// Many small files or folders that appear in one folder, each whole or not at all, with one wait
/// for the disk for all of them: a file system flush in place of an fsync for each.
///
///     StagedBatch batch(folder, kDoorFolder);
///     ... write below batch.path(), plainly ...
///     batch.Commit();
///
/// The destructor removes what was not committed, and so does a later batch in the same folder for
/// a process that was killed.
class StagedBatch {
 public:
  /// Creates `folder`. The entries will be files, or folders of the given kind.
  StagedBatch(std::filesystem::path folder, const FolderKind& kind);
  ~StagedBatch();
  StagedBatch(const StagedBatch&) = delete;
  StagedBatch& operator=(const StagedBatch&) = delete;

  const std::filesystem::path& path() const { return staging_; }
  /// Flushes, then renames every entry of path() into the folder, replacing what is there. Throws
  /// Error(kInvalidArgument), with nothing renamed, where a folder is in the place of one of these
  /// entries and is not of the batch's kind, or a file is where a folder goes.
  void Commit();

 private:
  std::filesystem::path folder_;
  FolderKind kind_;
  std::filesystem::path staging_;
  int lock_ = -1;  // on the staging folder, while this lives
};

/// Writes a file below a StagedBatch, without waiting for the disk. Creates its folder.
void WriteStaged(const std::filesystem::path& path, std::string_view content);

}  // namespace doorforge
