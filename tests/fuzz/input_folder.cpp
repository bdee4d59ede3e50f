// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "input_folder.h"

#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "fuzz_target.h"

namespace doorforge::fuzz {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    const char* chosen = std::getenv("TMPDIR");
    const fs::path above = chosen != nullptr              ? fs::path(chosen)
                           : fs::is_directory("/dev/shm") ? fs::path("/dev/shm")
                                                          : fs::temp_directory_path();
    path_ = above / ("doorforge-fuzz-" + std::to_string(::getpid()));
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

fs::path InputFile(const std::string& name, std::string_view bytes) {
  static const Folder folder;
  fs::path path = folder.path() / name;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  Expect(
      file >= 0 && ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
      "the input can be written to " + path.string());
  ::close(file);
  return path;
}

}  // namespace doorforge::fuzz
