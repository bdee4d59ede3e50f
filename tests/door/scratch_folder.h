// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace doorforge {

/// A folder for a test's files, in memory where the system has a place for that: thousands of small
/// committed files would wait for the disk. It is gone when the tests are done (test_main.cpp).
inline std::filesystem::path ScratchFolder(const std::string& name) {
  const char* in_memory = std::getenv("DOORFORGE_SCRATCH_IN_MEMORY");
  return std::filesystem::path(in_memory != nullptr ? in_memory : testing::TempDir()) / name;
}

}  // namespace doorforge
