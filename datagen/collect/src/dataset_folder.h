// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/core/folder_lock.h"

namespace doorforge {

/// Locks the folder of a dataset that is collected, and makes it if it is not there. The tasks of a
/// collection write side by side; who replaces what is there writes alone.
///
/// @throws Error(kInvalidArgument) if `out` is a file, and as FolderLock.
FolderLock LockDatasetFolder(const std::filesystem::path& out, bool replace);

/// Removes the dataset that is in the locked folder if it is to be replaced. Whether it is one to
/// go on in is decided where config.yaml is compared.
///
/// @throws Error(kInvalidArgument) if the folder holds something else than a dataset.
void PrepareDatasetFolder(const std::filesystem::path& out, bool replace);

}  // namespace doorforge
