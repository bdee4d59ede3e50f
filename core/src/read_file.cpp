// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/read_beginning.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

/// A regular file that is open for reading. What is there may have become a pipe or a device since
/// it was looked for: it is opened without waiting and asked what it is afterwards.
class OpenedFile {
 public:
  explicit OpenedFile(const fs::path& path)
      : path_(path), file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
    const int problem = errno;
    if (file_ < 0 && (problem == EMFILE || problem == ENFILE || problem == EACCES))
      throw Error(ErrorCode::kIo, path.string() + ": cannot be opened: " + std::strerror(problem));
    if (file_ >= 0 && ::fstat(file_, &facts_) == 0 && S_ISREG(facts_.st_mode)) return;
    Close();
    throw Error(ErrorCode::kMissing, path.string() + ": no such file");
  }
  ~OpenedFile() { Close(); }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  std::uint64_t size() const { return static_cast<std::uint64_t>(facts_.st_size); }

  /// Fewer bytes than asked for where the file ends before.
  std::string Read(std::uint64_t bytes) const {
    std::string content(bytes, '\0');
    std::uint64_t got = 0;
    while (got < bytes) {
      const ssize_t count = ::read(file_, content.data() + got, bytes - got);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) throw Error(ErrorCode::kIo, path_.string() + ": read failed");
      if (count == 0) break;
      got += static_cast<std::uint64_t>(count);
    }
    content.resize(got);
    return content;
  }

 private:
  void Close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

  const fs::path& path_;
  int file_;
  struct stat facts_ {};
};

}  // namespace

std::string ReadFile(const fs::path& path, std::uint64_t max_bytes) {
  const OpenedFile file(path);
  if (file.size() > max_bytes)
    throw Error(ErrorCode::kIo, path.string() + ": " + std::to_string(file.size()) +
                                    " bytes, allowed " + std::to_string(max_bytes));
  std::string content = file.Read(file.size());
  if (content.size() < file.size())
    throw Error(ErrorCode::kIo, path.string() + ": read failed, it became shorter");
  return content;
}

std::string ReadBeginning(const fs::path& path, std::uint64_t bytes) {
  try {
    const OpenedFile file(path);
    return file.Read(std::min(bytes, file.size()));
  } catch (const Error&) {
    return {};
  }
}

}  // namespace doorforge
