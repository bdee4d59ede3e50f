// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "doorforge/core/confinement.h"

namespace doorforge::internal {

/// Takes from this process, for good, what a file that takes it over could use: afterwards it opens
/// files below `readable` alone and to read, writes to what it has open, and computes. It makes no
/// file, no socket, no process and no code: Landlock (landlock(7)) refuses the files, a filter of
/// system calls (seccomp(2)) the rest, with EPERM. Barriers that the kernel does not have are left
/// out. Shared libraries must be loaded already; one thread must be all there is.
///
/// @param readable Files or folders; those that do not exist count for nothing.
/// @return What was put up.
ConfinementSupport ConfineToReading(std::span<const std::filesystem::path> readable);

}  // namespace doorforge::internal
