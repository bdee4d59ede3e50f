// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace doorforge {

/// The body of the process that reads one mesh file on behalf of ImportMesh() and writes the result
/// to file descriptor 3. It is a program of its own so that a hostile file can neither crash nor
/// hang the caller, and so that the caller's threads and locks do not matter. It gives up its
/// rights, and limits its time and memory, before it opens the file.
///
/// @param arguments The program's name, then PATH MAX_FILE_BYTES MAX_TRIANGLES MEMORY_BYTES SECONDS
///     MAX_PICTURE_BYTES FILES_BELOW PARENT_PROCESS.
/// @return The exit code: 0, 2 on wrong use, 3 if nobody reads the result, or the code that says
///     that memory was lacking.
int ReadMeshForParent(std::span<char* const> arguments);

}  // namespace doorforge
