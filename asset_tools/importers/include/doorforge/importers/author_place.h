// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "doorforge/core/rigid_transform.h"

namespace doorforge {

/// Where authors had handles on one body: body_from_handle, in the frames of the two parts, by the
/// handle's Part::source_sha256.
using AuthorPlaces = std::map<std::string, RigidTransform>;

/// The places that `handles.json` in a body's folder remembers, a record of schema
/// "doorforge.authored_handles", version 1; none if there is no such file.
///
/// @throws Error(kFormat) on a file that is no such record.
AuthorPlaces ReadAuthorPlaces(const std::filesystem::path& body_folder);

/// Adds `places` to those that the body's folder remembers. The file appears or changes as a whole.
void RememberAuthorPlaces(const std::filesystem::path& body_folder, const AuthorPlaces& places);

}  // namespace doorforge
