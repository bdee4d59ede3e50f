// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dataset_folder.h"

#include <algorithm>
#include <string>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// Whether there is nothing but what a writer leaves that was killed at its first file, or has while
// it writes.
bool HoldsNothing(const fs::path& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const fs::directory_entry& entry) {
                       const std::string name = entry.path().filename().string();
                       return name.starts_with(".config.yaml.tmp-") ||
                              name == FolderLock::kFileName;
                     });
}

// All but the lock of whoever removes it.
void RemoveDataset(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != FolderLock::kFileName) fs::remove_all(entry.path());
  }
}

}  // namespace

FolderLock LockDatasetFolder(const fs::path& out, bool replace) {
  Require(!fs::exists(out) || fs::is_directory(out), ErrorCode::kInvalidArgument,
          out.string() + ": is a file; --out takes a folder");
  return {out, "doorforge datagen", replace ? Writers::kOne : Writers::kTogether};
}

void PrepareDatasetFolder(const fs::path& out, bool replace) {
  if (HoldsNothing(out)) return;
  if (!fs::exists(out / "config.yaml"))
    throw Error(
        ErrorCode::kInvalidArgument,
        out.string() + ": exists and holds no dataset (no config.yaml); choose another folder");
  if (!replace) return;
  RequireKind(out, kDatasetFolder);
  RemoveDataset(out);
}

}  // namespace doorforge
