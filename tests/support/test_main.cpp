// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The main function of all test programs. What a test writes goes into folders of this process,
// which are removed when its tests are done: a run leaves nothing behind, and runs beside each
// other do not meet.

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

// A new folder below another, removed at the end; names it in the variables given, for the tests
// and their children.
class ScratchBelow {
 public:
  ScratchBelow(const fs::path& base, std::initializer_list<const char*> variables) {
    std::string pattern = (base / "doorforge_test_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) return;
    folder_ = pattern;
    for (const char* variable : variables) ::setenv(variable, folder_.c_str(), 1);
  }
  ~ScratchBelow() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  ScratchBelow(const ScratchBelow&) = delete;
  ScratchBelow& operator=(const ScratchBelow&) = delete;

 private:
  fs::path folder_;
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  // of the two names, the standard library reads the first and GoogleTest the second
  const ScratchBelow scratch(fs::temp_directory_path(), {"TMPDIR", "TEST_TMPDIR"});
  const ScratchBelow in_memory("/dev/shm", {"DOORFORGE_SCRATCH_IN_MEMORY"});
  return RUN_ALL_TESTS();
}
