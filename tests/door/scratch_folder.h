// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace doorforge {

/// A folder for a test's files, in memory where the system has a place for that: thousands of small
/// committed files would wait for the disk.
inline std::filesystem::path ScratchFolder(const std::string& name) {
  namespace fs = std::filesystem;
  const bool in_memory = ::access("/dev/shm", W_OK) == 0;
  const fs::path base = in_memory ? fs::path("/dev/shm") : fs::path(testing::TempDir());
  return base / ("doorforge_test_" + std::to_string(::getuid())) / name;
}

}  // namespace doorforge
