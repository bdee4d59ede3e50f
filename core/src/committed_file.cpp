// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void ThrowIo(const fs::path& path, const std::string& what) {
  throw Error(ErrorCode::kIo, path.string() + ": " + what + ": " + std::strerror(errno));
}

fs::path FolderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// unique within the machine: the process id, then a count within the process
fs::path TemporaryBeside(const fs::path& path) {
  static std::atomic<int> count{0};
  return FolderOf(path) / ("." + path.filename().string() + ".tmp-" + std::to_string(::getpid()) +
                           "-" + std::to_string(count++));
}

void SyncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (fd < 0) ThrowIo(folder, "cannot be opened");
  ::fsync(fd);
  ::close(fd);
}

void WriteAll(int fd, std::string_view content, const fs::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ThrowIo(path, "write failed");
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void CreateFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::kIo, folder.string() + ": cannot be created: " + error.message());
}

void RefuseExisting(const fs::path& path) {
  if (fs::exists(fs::symlink_status(path)))
    throw Error(ErrorCode::kInvalidArgument,
                path.string() + ": already exists; pass --overwrite to replace it");
}

void RenameOnto(const fs::path& from, const fs::path& to, Existing existing) {
  const unsigned flags = existing == Existing::kRefuse ? RENAME_NOREPLACE : 0U;
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0) return;
  if (errno == EEXIST) RefuseExisting(to);
  ThrowIo(to, "cannot be put in place");
}

}  // namespace

std::string ReadFile(const fs::path& path, std::uint64_t max_bytes) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw Error(ErrorCode::kMissing, path.string() + ": no such file");
  const std::uint64_t size = fs::file_size(path, error);
  if (error || size > max_bytes)
    throw Error(ErrorCode::kIo, path.string() + ": " + std::to_string(size) + " bytes, allowed " +
                                    std::to_string(max_bytes));
  std::ifstream file(path, std::ios::binary);
  std::string content(size, '\0');
  if (!file.read(content.data(), static_cast<std::streamsize>(size)))
    throw Error(ErrorCode::kIo, path.string() + ": read failed");
  return content;
}

void CommitFile(const fs::path& path, std::string_view content, Existing existing) {
  CreateFolder(FolderOf(path));
  if (existing == Existing::kRefuse) RefuseExisting(path);
  const fs::path temporary = TemporaryBeside(path);
  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) ThrowIo(temporary, "cannot be created");
  try {
    WriteAll(fd, content, temporary);
    if (::fsync(fd) != 0) ThrowIo(temporary, "fsync failed");
    ::close(fd);
    RenameOnto(temporary, path, existing);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  SyncFolder(FolderOf(path));
}

StagedFolder::StagedFolder(fs::path target, Existing existing)
    : target_(std::move(target)), existing_(existing) {
  if (!target_.has_filename()) target_ = target_.parent_path();
  if (existing_ == Existing::kRefuse) RefuseExisting(target_);
  staging_ = TemporaryBeside(target_);
  CreateFolder(staging_);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(staging_, ignored);
}

void StagedFolder::Commit() {
  for (const auto& entry : fs::recursive_directory_iterator(staging_)) {
    if (entry.is_directory()) SyncFolder(entry.path());
  }
  SyncFolder(staging_);
  if (existing_ == Existing::kReplace && fs::exists(target_)) {
    // a folder cannot be renamed onto a full one: swap, then drop the old content
    if (::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0)
      ThrowIo(target_, "cannot be put in place");
    fs::remove_all(staging_);
  } else {
    RenameOnto(staging_, target_, Existing::kRefuse);
  }
  committed_ = true;
  SyncFolder(FolderOf(target_));
}

namespace {

constexpr const char* kBatchPrefix = ".batch.tmp-";

// Batches of processes that are gone: what they left was never committed.
void RemoveDeadBatches(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kBatchPrefix)) continue;
    const int process = std::atoi(name.c_str() + std::strlen(kBatchPrefix));
    std::error_code ignored;
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH)
      fs::remove_all(entry.path(), ignored);
  }
}

void RenameInto(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) == 0) return;
  // a folder cannot be renamed onto a full one: swap, and let the batch drop the old content
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) != 0)
    ThrowIo(to, "cannot be put in place");
}

}  // namespace

StagedBatch::StagedBatch(fs::path folder) : folder_(std::move(folder)) {
  static std::atomic<int> count{0};
  CreateFolder(folder_);
  RemoveDeadBatches(folder_);
  staging_ = folder_ / (kBatchPrefix + std::to_string(::getpid()) + "-" + std::to_string(count++));
  CreateFolder(staging_);
}

StagedBatch::~StagedBatch() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void StagedBatch::Commit() {
  const int fd = ::open(staging_.c_str(), O_RDONLY | O_DIRECTORY);
  if (fd < 0) ThrowIo(staging_, "cannot be opened");
  const int flushed = ::syncfs(fd);
  ::close(fd);
  if (flushed != 0) ThrowIo(staging_, "cannot be flushed");
  for (const auto& entry : fs::directory_iterator(staging_))
    RenameInto(entry.path(), folder_ / entry.path().filename());
  SyncFolder(folder_);
}

void WriteStaged(const fs::path& path, std::string_view content) {
  CreateFolder(FolderOf(path));
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) ThrowIo(path, "cannot be created");
  try {
    WriteAll(fd, content, path);
  } catch (...) {
    ::close(fd);
    throw;
  }
  ::close(fd);
}

}  // namespace doorforge
