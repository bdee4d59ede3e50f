// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/committed_file.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void ThrowOfCommit(const fs::path& path, const std::string& what) {
  throw Error(ErrorCode::kIo, path.string() + ": " + what + ": " + std::strerror(errno));
}

fs::path FolderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void CreateFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::kIo, folder.string() + ": cannot be created: " + error.message());
}

// Twelve digits that no other run of an operating system has: what is locked in one is locked for
// all of its processes, whatever container, host name or process number they have.
std::string RunOfTheSystem() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string id;
  for (char c = 0; id.size() < 12 && file.get(c);) {
    if (std::isxdigit(static_cast<unsigned char>(c)) != 0) id += c;
  }
  return id.size() == 12 ? id : std::string(12, '0');
}

const std::string& ThisRun() {
  static const std::string run = RunOfTheSystem();
  return run;
}

constexpr std::string_view kTemporaryMark = ".tmp-";

// ".NAME.tmp-RUN-PROCESS-COUNT": unique among machines. A long name is cut, so that whatever can be
// the name of a file can be staged.
std::string TemporaryName(const std::string& name) {
  constexpr std::size_t kMostOfName = 100;
  static std::atomic<int> count{0};
  return "." + name.substr(0, kMostOfName) + std::string(kTemporaryMark) + ThisRun() + "-" +
         std::to_string(::getpid()) + "-" + std::to_string(count++);
}

fs::path TemporaryBeside(const fs::path& path) {
  return FolderOf(path) / TemporaryName(path.filename().string());
}

bool TakeNumber(std::string_view& text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  text.remove_prefix(digits);
  return digits > 0;
}

// Which run of a system made a name such as TemporaryName()'s, if it is one.
std::optional<std::string> WriterOf(std::string_view name) {
  const std::size_t at = name.rfind(kTemporaryMark);
  if (!name.starts_with('.') || at == std::string_view::npos) return std::nullopt;
  std::string_view rest = name.substr(at + kTemporaryMark.size());
  const std::string run(rest.substr(0, 12));
  if (run.size() != 12 || run.find_first_not_of("0123456789abcdef") != std::string::npos)
    return std::nullopt;
  rest.remove_prefix(12);
  for (int number = 0; number < 2; ++number) {
    if (!rest.starts_with('-')) return std::nullopt;
    rest.remove_prefix(1);
    if (!TakeNumber(rest)) return std::nullopt;
  }
  return rest.empty() ? std::optional(run) : std::nullopt;
}

bool IsNamed(int file, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

// The lock of something that is there, or -1 if it is held or gone. Where a file system knows no
// locks nothing is ever taken for left behind.
int TryLock(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return -1;
  if (::flock(file, LOCK_EX | LOCK_NB) == 0 && IsNamed(file, path)) return file;
  ::close(file);
  return -1;
}

bool IsUntouchedForADay(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
}

// For what is in the way of nothing.
void RemoveQuietly(FileSystem& files, const fs::path& path) {
  try {
    files.Remove(path);
  } catch (...) {
    return;
  }
}

// Removes a temporary unless its writer may still live.
void RemoveIfStale(FileSystem& files, const fs::path& path, const std::string& run) {
  if (run != ThisRun() && !IsUntouchedForADay(path)) return;
  const int lock = TryLock(path);
  if (lock < 0) return;
  std::error_code ignored;
  if (fs::is_directory(fs::symlink_status(path, ignored)))
    fs::remove_all(path, ignored);
  else
    RemoveQuietly(files, path);
  ::close(lock);
}

// Once for each folder in the life of a process: a program that stages ten thousand folders in one
// does not look through it ten thousand times.
void RemoveStaleBeside(FileSystem& files, const fs::path& path) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  const fs::path folder = FolderOf(path);
  {
    const std::scoped_lock lock(mutex);
    if (!seen.insert(fs::absolute(folder).lexically_normal().string()).second) return;
  }
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::optional<std::string> run = WriterOf(entry->path().filename().string());
    if (run) RemoveIfStale(files, entry->path(), *run);
  }
}

// Waits for the lock of what was just made: whoever looks for what was left behind may hold it for
// a moment, before it had an owner, and then removes it. False if that has happened. Where the file
// system knows no locks nothing is removed.
bool BecomeOwner(int file, const fs::path& path) {
  while (::flock(file, LOCK_EX) != 0) {
    if (errno != EINTR) return true;
  }
  return IsNamed(file, path);
}

struct OwnedTemporary {
  fs::path path;
  int file;  // locked until it is closed
};

OwnedTemporary CreateOwnedFolder(const fs::path& beside) {
  CreateFolder(FolderOf(beside));
  while (true) {
    const fs::path path = TemporaryBeside(beside);
    if (::mkdir(path.c_str(), 0777) != 0) ThrowOfCommit(beside, "cannot be staged");
    const int file = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0 && errno == ENOENT) continue;
    if (file < 0) ThrowOfCommit(path, "cannot be opened");
    if (BecomeOwner(file, path)) return {path, file};
    ::close(file);
  }
}

OwnedTemporary CreateOwnedFile(FileSystem& files, const fs::path& beside) {
  while (true) {
    const fs::path path = TemporaryBeside(beside);
    const int file = files.Create(path);
    if (BecomeOwner(file, path)) return {path, file};
    files.Close(file);
  }
}

[[noreturn]] void ThrowExists(const fs::path& path) {
  throw Error(ErrorCode::kInvalidArgument,
              path.string() + ": already exists; pass --overwrite to replace it");
}

void RefuseExisting(const fs::path& path) {
  if (fs::exists(fs::symlink_status(path))) ThrowExists(path);
}

void RenameToNew(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
  if (errno == EEXIST) RefuseExisting(to);
  ThrowOfCommit(to, "cannot be put in place");
}

void Swap(const fs::path& one, const fs::path& other) {
  if (::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) != 0)
    ThrowOfCommit(other, "cannot be put in place");
}

bool IsRecordOf(const fs::path& record, const FolderKind& kind) {
  if (!kind.record.ends_with(".json")) {
    std::string begin(kind.schema.size(), '\0');
    std::ifstream(record, std::ios::binary)
        .read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return begin == kind.schema;
  }
  try {
    return ValueOf<std::string>(ReadJsonFile(record), "schema", record.string()) == kind.schema;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void CommitFile(const fs::path& path, std::string_view content, Existing existing) {
  CommitFile(SystemFiles(), path, content, existing);
}

void CommitFile(FileSystem& files, const fs::path& path, std::string_view content,
                Existing existing) {
  files.CreateFolder(FolderOf(path));
  if (existing == Existing::kRefuse) RefuseExisting(path);
  RemoveStaleBeside(files, path);
  const auto [temporary, file] = CreateOwnedFile(files, path);
  try {
    WriteAll(files, file, content, temporary);
    files.Sync(file, temporary);
    if (existing == Existing::kReplace)
      files.Rename(temporary, path);
    else if (!files.RenameToNew(temporary, path))
      ThrowExists(path);
  } catch (...) {
    RemoveQuietly(files, temporary);
    files.Close(file);
    throw;
  }
  files.Close(file);  // its lock kept the temporary until it had its name
  files.SyncFolder(FolderOf(path));
}

void RemoveStaleFiles(FileSystem& files, const fs::path& folder) {
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied,
                                         error);
  std::vector<std::pair<fs::path, std::string>> temporaries;
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    const std::optional<std::string> run = WriterOf(entry->path().filename().string());
    if (!run) continue;
    temporaries.emplace_back(entry->path(), *run);
    entry.disable_recursion_pending();
  }
  for (const auto& [path, run] : temporaries) RemoveIfStale(files, path, run);
}

void RequireWritable(const fs::path& folder) {
  const fs::path target = fs::absolute(folder).lexically_normal();
  std::vector<fs::path> made;
  for (fs::path missing = target; !fs::exists(missing) && missing.has_relative_path();
       missing = missing.parent_path())
    made.push_back(missing);
  CreateFolder(target);
  const fs::path probe = target / TemporaryName("probe");
  const int file = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const int reason = errno;
  if (file >= 0) {
    ::close(file);
    ::unlink(probe.c_str());
  }
  for (const fs::path& empty : made) ::rmdir(empty.c_str());
  errno = reason;
  if (file < 0) ThrowOfCommit(folder, "nothing can be written there");
}

void RequireKind(const fs::path& folder, const FolderKind& kind) {
  const auto refuse = [&](const std::string& found) {
    throw Error(ErrorCode::kInvalidArgument,
                folder.string() + ": " + found + "; only " + std::string(kind.name) +
                    " that doorforge wrote is replaced: move it away or choose another folder");
  };
  std::error_code error;
  const fs::file_status status = fs::symlink_status(folder, error);
  if (fs::is_symlink(status)) refuse("is a link");
  if (!fs::is_directory(status)) refuse("is a file");
  const fs::path record = folder / kind.record;
  if (!fs::is_regular_file(fs::symlink_status(record, error)))
    refuse("holds no " + std::string(kind.record));
  if (!IsRecordOf(record, kind)) refuse("its " + std::string(kind.record) + " is another's");
}

StagedFolder::StagedFolder(fs::path target, const FolderKind& kind, Existing existing)
    : target_(std::move(target)), kind_(kind), existing_(existing) {
  if (!target_.has_filename()) target_ = target_.parent_path();
  if (existing_ == Existing::kRefuse)
    RefuseExisting(target_);
  else if (fs::exists(fs::symlink_status(target_)))
    RequireKind(target_, kind_);
  RemoveStaleBeside(SystemFiles(), target_);
  const OwnedTemporary owned = CreateOwnedFolder(target_);
  staging_ = owned.path;
  lock_ = owned.file;
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(staging_, ignored);
  ::close(lock_);
}

void StagedFolder::Commit() {
  for (const auto& entry : fs::recursive_directory_iterator(staging_)) {
    if (entry.is_directory()) SystemFiles().SyncFolder(entry.path());
  }
  SystemFiles().SyncFolder(staging_);
  if (existing_ == Existing::kReplace && fs::exists(fs::symlink_status(target_)))
    Replace();
  else
    RenameToNew(staging_, target_);
  committed_ = true;
  SystemFiles().SyncFolder(FolderOf(target_));
}

// A folder cannot be renamed onto a full one: the two are swapped, then the old content is dropped.
void StagedFolder::Replace() {
  RequireKind(target_, kind_);  // once more: much may have happened since the beginning
  Swap(staging_, target_);
  // what was replaced is in the way of nobody, and the next writer removes what is left of it
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

StagedBatch::StagedBatch(fs::path folder, const FolderKind& kind)
    : folder_(std::move(folder)), kind_(kind) {
  CreateFolder(folder_);
  RemoveStaleBeside(SystemFiles(), folder_ / "batch");
  const OwnedTemporary owned = CreateOwnedFolder(folder_ / "batch");
  staging_ = owned.path;
  lock_ = owned.file;
}

StagedBatch::~StagedBatch() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  ::close(lock_);
}

void StagedBatch::Commit() {
  if (::syncfs(lock_) != 0) ThrowOfCommit(staging_, "cannot be flushed");
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(staging_)) {
    names.push_back(entry.path().filename());
    const fs::path target = folder_ / names.back();
    if (entry.is_directory() && fs::exists(fs::symlink_status(target))) RequireKind(target, kind_);
  }
  for (const fs::path& name : names) {
    if (::rename((staging_ / name).c_str(), (folder_ / name).c_str()) == 0) continue;
    // a full folder is in the place: the batch drops the old content
    if (errno != ENOTEMPTY && errno != EEXIST)
      ThrowOfCommit(folder_ / name, "cannot be put in place");
    Swap(staging_ / name, folder_ / name);
  }
  SystemFiles().SyncFolder(folder_);
}

void WriteStaged(const fs::path& path, std::string_view content) {
  CreateFolder(FolderOf(path));
  const int file = SystemFiles().Create(path);
  try {
    WriteAll(SystemFiles(), file, content, path);
  } catch (...) {
    ::close(file);
    throw;
  }
  ::close(file);
}

}  // namespace doorforge
