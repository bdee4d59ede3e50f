// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/free_space.h"

#include <cstdio>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// The folder itself or the nearest one above it that is there.
fs::path ExistingFolder(const fs::path& folder) {
  fs::path there = fs::absolute(folder.empty() ? fs::path(".") : folder);
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  return there;
}

}  // namespace

double BytesBelow(const fs::path& folder) {
  double bytes = 0;
  if (!fs::exists(folder)) return bytes;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
}

std::string LackOfSpace(const fs::path& folder, double needed_bytes) {
  constexpr double kMiB = 1 << 20;
  const auto free = static_cast<double>(fs::space(ExistingFolder(folder)).available);
  if (free >= needed_bytes) return {};
  char numbers[100];
  std::snprintf(numbers, sizeof numbers, ": about %.0f MiB are needed, %.0f MiB are free",
                needed_bytes / kMiB, free / kMiB);
  return folder.string() + numbers;
}

void RequireSpace(const fs::path& folder, double needed_bytes, const std::string& way_out) {
  const std::string lack = LackOfSpace(folder, needed_bytes);
  if (!lack.empty()) throw Error(ErrorCode::kIo, lack + "; " + way_out);
}

}  // namespace doorforge
