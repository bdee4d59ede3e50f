// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "datasets/mapped_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {

MappedFile::MappedFile(const std::filesystem::path& path) : path_(path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (fd < 0 || ::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    if (fd >= 0) ::close(fd);
    throw Error(ErrorCode::kMissing, path.string() + ": no such file, or it cannot be opened");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  device_ = status.st_dev;
  inode_ = status.st_ino;
  if (size_ == 0) {  // mmap refuses empty files
    ::close(fd);
    return;
  }
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, fd, 0);
  const int error = errno;
  ::close(fd);
  if (data == MAP_FAILED)
    throw Error(ErrorCode::kIo, path.string() + ": cannot be mapped: " + std::strerror(error));
  data_ = static_cast<const std::byte*>(data);
  guard_.emplace(data_, size_);
}

MappedFile::~MappedFile() {
  guard_.reset();
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
}

void MappedFile::RequireWhole() const {
  // What was cut off within the last page that is left reads as zeros without any signal; a file
  // that was put in this one's place says nothing about what is mapped.
  struct stat now {};
  const bool is_shorter = ::stat(path_.c_str(), &now) == 0 && now.st_dev == device_ &&
                          now.st_ino == inode_ && static_cast<std::size_t>(now.st_size) < size_;
  if (!is_shorter && !(guard_ && guard_->IsDamaged())) return;
  throw Error(ErrorCode::kIo, path_.string() +
                                  ": was cut by another program, or its disk failed, while it was "
                                  "read; nothing that was read from it is used");
}

}  // namespace doorforge
