// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/folder_lock.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostHolderBytes = 200;

[[noreturn]] void ThrowOfLock(const fs::path& path, const std::string& what) {
  throw Error(ErrorCode::kIo, path.string() + ": " + what + ": " + std::strerror(errno));
}

// "doorforge train (process 4711 on host)"
std::string HolderText(const std::string& work) {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) std::strcpy(host.data(), "unknown");
  return (work + " (process " + std::to_string(::getpid()) + " on " + host.data() + ")")
      .substr(0, kMostHolderBytes);
}

// Without control characters: the file is read while others may write it.
std::string HolderIn(int file) {
  std::array<char, kMostHolderBytes> text{};
  const ssize_t size = ::pread(file, text.data(), text.size(), 0);
  std::string holder;
  for (ssize_t i = 0; i < size && text.at(static_cast<std::size_t>(i)) != '\n'; ++i) {
    const char c = text.at(static_cast<std::size_t>(i));
    if (c >= ' ' && c <= '~') holder += c;
  }
  return holder.empty() ? "another process" : holder;
}

bool IsThatLock(int file, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

int Open(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (file < 0) ThrowOfLock(path, "cannot be opened for writing");
  return file;
}

}  // namespace

FolderLock::FolderLock(fs::path folder, const std::string& work, Writers writers)
    : path_(folder / kFileName), made_folder_(!fs::exists(fs::symlink_status(folder))) {
  SystemFiles().CreateFolder(folder);
  while (file_ < 0) {
    const int file = Open(path_);
    const int wanted = writers == Writers::kOne ? LOCK_EX : LOCK_SH;
    if (::flock(file, wanted | LOCK_NB) == 0) {
      // who held it before may have removed the file: then this lock is worth nothing
      if (IsThatLock(file, path_))
        file_ = file;
      else
        ::close(file);
      continue;
    }
    const int error = errno;
    const std::string holder = HolderIn(file);
    ::close(file);
    errno = error;
    if (error == EINTR) continue;
    if (error != EWOULDBLOCK)
      ThrowOfLock(path_, "the file system cannot lock it (Lustre: mount with -o flock)");
    throw Error(ErrorCode::kInvalidArgument,
                folder.string() + ": " + holder +
                    " writes there at this moment; wait until it has ended, or use another folder");
  }
  const std::string holder = HolderText(work) + "\n";
  if (::ftruncate(file_, 0) != 0 ||
      ::pwrite(file_, holder.data(), holder.size(), 0) != static_cast<ssize_t>(holder.size())) {
    // the name is for a message alone; the lock holds without it
    errno = 0;
  }
}

FolderLock::~FolderLock() {
  // the last one of several takes the file away
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 && IsThatLock(file_, path_)) ::unlink(path_.c_str());
  ::close(file_);
  // refused work leaves no empty folder; one with something in it stays
  if (made_folder_) ::rmdir(path_.parent_path().c_str());
}

}  // namespace doorforge
