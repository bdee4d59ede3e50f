// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace doorforge {

/// The operations by which writers of committed files change the disk: everything they do to it
/// goes through here, so that a test can make any one of them fail or be the last before a crash.
///
/// All throw Error(kIo) that names the path and the system's reason; a full disk says how to go on.
/// `path` of functions that take a descriptor is for that message.
class FileSystem {
 public:
  virtual ~FileSystem() = default;

  /// A new file to write; throws if it exists.
  virtual int Create(const std::filesystem::path& path) = 0;
  /// A file to append to, made if it is not there.
  virtual int OpenToAppend(const std::filesystem::path& path) = 0;
  /// Writes a beginning of `bytes`, at least one of them; returns how many.
  virtual std::size_t WriteSome(int file, std::string_view bytes,
                                const std::filesystem::path& path) = 0;
  virtual void Truncate(int file, std::uint64_t size, const std::filesystem::path& path) = 0;
  virtual void Sync(int file, const std::filesystem::path& path) = 0;
  virtual void SyncFolder(const std::filesystem::path& folder) = 0;
  virtual void CreateFolder(const std::filesystem::path& folder) = 0;
  /// Replaces `to` if it is there.
  virtual void Rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  /// False, and nothing done, if `to` is there.
  virtual bool RenameToNew(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  /// A second name for a file; false where that cannot be, as between two file systems.
  virtual bool HardLink(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  /// No error if it is not there.
  virtual void Remove(const std::filesystem::path& path) = 0;
  virtual void Close(int file) noexcept = 0;
};

/// The operating system's; without state.
FileSystem& SystemFiles();

/// FileSystem::WriteSome() until all is written.
void WriteAll(FileSystem& files, int file, std::string_view bytes,
              const std::filesystem::path& path);

/// The lock of a file, held until this is destroyed or the process ends, however it ends.
class FileLock {
 public:
  /// Nothing if someone else holds the lock, in this process or another, on this machine or, where
  /// the file system supports it (NFS, Lustre with `flock`), on others. Creates the file. Throws
  /// Error(kIo), also where the file system cannot lock.
  static std::optional<FileLock> Try(FileSystem& files, const std::filesystem::path& path);

  FileLock(FileLock&& other) noexcept : files_(other.files_), file_(other.file_) {
    other.file_ = -1;
  }
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock() {
    if (file_ >= 0) files_->Close(file_);
  }

  int file() const { return file_; }  ///< Open to append.

 private:
  FileLock(FileSystem& files, int file) : files_(&files), file_(file) {}

  FileSystem* files_;
  int file_;
};

}  // namespace doorforge
