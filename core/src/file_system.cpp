// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/file_system.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void ThrowIo(const fs::path& path, const std::string& what, int error = errno) {
  std::string message = path.string() + ": " + what + ": " + std::strerror(error);
  if (error == ENOSPC || error == EDQUOT)
    message += "; make room and give the same command again: what is committed stays";
  throw Error(ErrorCode::kIo, message);
}

// What a signal interrupted has not been done, and is done again.
template <class Call>
int Uninterrupted(Call&& call) {
  while (true) {
    const int result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

class OperatingSystemFiles : public FileSystem {
 public:
  int Create(const fs::path& path) override {
    const int file = Uninterrupted(
        [&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644); });
    if (file < 0) ThrowIo(path, "cannot be created");
    return file;
  }

  int OpenToAppend(const fs::path& path) override {
    const int file = Uninterrupted(
        [&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644); });
    if (file < 0) ThrowIo(path, "cannot be opened for writing");
    return file;
  }

  std::size_t WriteSome(int file, std::string_view bytes, const fs::path& path) override {
    while (true) {
      const ssize_t written = ::write(file, bytes.data(), bytes.size());
      if (written > 0) return static_cast<std::size_t>(written);
      if (written < 0 && errno == EINTR) continue;
      ThrowIo(path, "write failed", written == 0 ? EIO : errno);
    }
  }

  void Truncate(int file, std::uint64_t size, const fs::path& path) override {
    if (Uninterrupted([&] { return ::ftruncate(file, static_cast<off_t>(size)); }) != 0)
      ThrowIo(path, "cannot be cut");
  }

  void Sync(int file, const fs::path& path) override {
    if (Uninterrupted([&] { return ::fsync(file); }) != 0) ThrowIo(path, "fsync failed");
  }

  void SyncFolder(const fs::path& folder) override {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) ThrowIo(folder, "cannot be opened");
    const int error = Uninterrupted([&] { return ::fsync(file); }) != 0 ? errno : 0;
    ::close(file);
    // some network file systems know no such thing as a folder's fsync
    if (error != 0 && error != EINVAL && error != ENOTSUP) ThrowIo(folder, "fsync failed", error);
  }

  void CreateFolder(const fs::path& folder) override {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) ThrowIo(folder, "cannot be created", error.value());
  }

  void Rename(const fs::path& from, const fs::path& to) override {
    if (::rename(from.c_str(), to.c_str()) != 0) ThrowIo(to, "cannot be put in place");
  }

  bool RenameToNew(const fs::path& from, const fs::path& to) override {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
      return true;
    if (errno == EEXIST) return false;
    if (errno != EINVAL) ThrowIo(to, "cannot be put in place");
    // NFS has no renameat2; a hard link does not replace either
    if (::link(from.c_str(), to.c_str()) != 0) {
      if (errno == EEXIST) return false;
      ThrowIo(to, "cannot be put in place");
    }
    Remove(from);
    return true;
  }

  bool HardLink(const fs::path& from, const fs::path& to) override {
    if (::link(from.c_str(), to.c_str()) == 0) return true;
    if (errno == EXDEV || errno == EPERM || errno == EMLINK || errno == ENOTSUP) return false;
    ThrowIo(to, "cannot be linked to " + from.string());
  }

  void Remove(const fs::path& path) override {
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) ThrowIo(path, "cannot be removed");
  }

  void Close(int file) noexcept override { ::close(file); }
};

bool IsSameFile(int file, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

FileSystem& SystemFiles() {
  static OperatingSystemFiles files;
  return files;
}

void WriteAll(FileSystem& files, int file, std::string_view bytes, const fs::path& path) {
  while (!bytes.empty()) bytes.remove_prefix(files.WriteSome(file, bytes, path));
}

std::optional<FileLock> FileLock::Try(FileSystem& files, const fs::path& path) {
  while (true) {
    FileLock lock(files, files.OpenToAppend(path));
    if (::flock(lock.file_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) return std::nullopt;
      if (errno == EINTR) continue;
      ThrowIo(path, "the file system cannot lock it (Lustre: mount with -o flock)");
    }
    // who held the lock before may have removed the file: then this lock is worth nothing
    if (IsSameFile(lock.file_, path)) return lock;
  }
}

}  // namespace doorforge
