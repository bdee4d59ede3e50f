// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/mesh/import_mesh.h"

// What doorforge-read-mesh sends through its pipe: the pieces, or an error. Both ends are of one
// build on one machine, so numbers go as they lie in memory.

namespace doorforge {

/// Exit code of the reading program where it asked for more memory than it may have, whatever it
/// sent.
inline constexpr int kExitMemoryLacked = 4;

std::string Encoded(const ImportedMesh& mesh);
std::string Encoded(const Error& error);

/// The mesh; throws the Error that was sent. Empty if the message is cut off or breaks a promise of
/// ImportedMesh: the sender has read a file from outside and is not trusted.
std::optional<ImportedMesh> DecodedMesh(std::string_view message);

}  // namespace doorforge
