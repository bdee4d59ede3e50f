// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// Whether a binary glTF has links: nodes whose `extras` have a "mass" or a "joint", as the exports
/// of this project have them. glTF itself has no word for either. False for what is no glTF.
bool HasLinks(const std::filesystem::path& path);

/// Parses such a file into the value that a URDF gives. Links are the nodes with those extras,
/// their shapes the triangles of the nodes below that are no links, each primitive in the colour of
/// its material; all are drawn, none collides. The frame of the topmost link is the base, whatever
/// turns it y up. Normals, texture coordinates, pictures and animation are not read.
///
/// @throws Error(kFormat) on what is no glTF 2.0 with one buffer in the file, on views, accessors
///     and indices that lead outside of it, on compressed or sparse ones, and on extras that are
///     not as exports write them. At most 512 MiB, 64 levels of nodes, 2,000 links and 5,000,000
///     triangles.
UrdfModel ParseGlb(std::string_view bytes, const std::string& name);
/// Throws where a file is faulty, like the readers of other formats; it adds no finding.
UrdfModel ReadGlb(const std::filesystem::path& path, std::vector<UrdfFault>& faults);

}  // namespace doorforge
