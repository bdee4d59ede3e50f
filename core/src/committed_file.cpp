// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <vector>

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

std::string HostName() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

// unique among machines: the process id, a count within the process, the machine's name
fs::path TemporaryBeside(const fs::path& path) {
  static std::atomic<int> count{0};
  return FolderOf(path) / ("." + path.filename().string() + ".tmp-" + std::to_string(::getpid()) +
                           "-" + std::to_string(count++) + "-" + HostName());
}

// The process of this machine that made a name such as TemporaryBeside()'s, if it is one.
std::optional<pid_t> WriterOf(const std::string& name) {
  const std::size_t at = name.rfind(".tmp-");
  if (!name.starts_with('.') || at == std::string::npos) return std::nullopt;
  const char* const end = name.data() + name.size();
  pid_t process = 0;
  const auto [after_process, error] = std::from_chars(name.data() + at + 5, end, process);
  if (error != std::errc{} || process <= 0 || after_process == end || *after_process != '-')
    return std::nullopt;
  int count = 0;
  const auto [after_count, count_error] = std::from_chars(after_process + 1, end, count);
  if (count_error != std::errc{} || std::string(after_count, end) != "-" + HostName())
    return std::nullopt;
  return process;
}

void SyncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (fd < 0) ThrowIo(folder, "cannot be opened");
  ::fsync(fd);
  ::close(fd);
}

void CreateFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::kIo, folder.string() + ": cannot be created: " + error.message());
}

[[noreturn]] void ThrowExists(const fs::path& path) {
  throw Error(ErrorCode::kInvalidArgument,
              path.string() + ": already exists; pass --overwrite to replace it");
}

void RefuseExisting(const fs::path& path) {
  if (fs::exists(fs::symlink_status(path))) ThrowExists(path);
}

// For what is in the way of nothing.
void RemoveQuietly(FileSystem& files, const fs::path& path) {
  try {
    files.Remove(path);
  } catch (...) {
    return;
  }
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
  CommitFile(SystemFiles(), path, content, existing);
}

void CommitFile(FileSystem& files, const fs::path& path, std::string_view content,
                Existing existing) {
  files.CreateFolder(FolderOf(path));
  if (existing == Existing::kRefuse) RefuseExisting(path);
  const fs::path temporary = TemporaryBeside(path);
  const int file = files.Create(temporary);
  bool is_open = true;
  try {
    WriteAll(files, file, content, temporary);
    files.Sync(file, temporary);
    files.Close(file);
    is_open = false;
    if (existing == Existing::kReplace)
      files.Rename(temporary, path);
    else if (!files.RenameToNew(temporary, path))
      ThrowExists(path);
  } catch (...) {
    if (is_open) files.Close(file);
    RemoveQuietly(files, temporary);
    throw;
  }
  files.SyncFolder(FolderOf(path));
}

void RemoveStaleFiles(FileSystem& files, const fs::path& folder) {
  std::vector<fs::path> stale;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::optional<pid_t> process = WriterOf(entry.path().filename().string());
    if (process && entry.is_regular_file() && ::kill(*process, 0) != 0 && errno == ESRCH)
      stale.push_back(entry.path());
  }
  for (const fs::path& path : stale) files.Remove(path);
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
    WriteAll(SystemFiles(), fd, content, path);
  } catch (...) {
    ::close(fd);
    throw;
  }
  ::close(fd);
}

}  // namespace doorforge
