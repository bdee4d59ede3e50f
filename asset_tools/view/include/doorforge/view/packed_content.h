// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/part.h"

// What pages hold, for who sends it to a page that is open already. docs/design/view.md has the
// layout of packed content: a document with the bytes that it names, deflated.

namespace doorforge {

/// The packed content of the door or part in a folder, with its findings by the profile "physics".
/// `beside` are further keys of the document. Throws as MakeRecordPage().
std::string PackRecord(const std::filesystem::path& folder, const nlohmann::ordered_json& beside);

/// The packed content of the rule-based expert's episode at the door, without clouds. Throws as
/// ReadDoor() and RunEpisode().
std::string PackExpertFilm(const std::filesystem::path& door_folder, std::uint64_t seed);

/// The packed content of loose meshes, in their order, with `beside` as its further keys.
std::string PackMeshes(std::span<const TriangleMesh> meshes, const nlohmann::ordered_json& beside);

/// A page with the viewer and this document, which may ask the server that it came from, and nobody
/// else. Throws Error(kMissing) where the viewer is not among the data.
std::string ServedPage(const std::string& title, const nlohmann::ordered_json& document);

/// A picture of a part as a JPEG file, `width_px` wide and three quarters as high. Throws
/// Error(kInvalidArgument) if the width does not lie in 64..640.
std::string DrawThumbnail(const Part& part, int width_px);

}  // namespace doorforge
