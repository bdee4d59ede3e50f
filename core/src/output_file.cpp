// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/output_file.h"

#include "doorforge/core/error.h"

namespace doorforge {

void RequireNoFile(const std::filesystem::path& path, bool overwrite) {
  if (path.empty()) return;
  if (std::filesystem::is_directory(path))
    throw Error(ErrorCode::kInvalidArgument,
                path.string() + ": is a folder; give the name of the file to write");
  if (overwrite || !std::filesystem::exists(std::filesystem::symlink_status(path))) return;
  throw Error(ErrorCode::kInvalidArgument,
              path.string() + ": already exists; pass --overwrite to replace it");
}

}  // namespace doorforge
