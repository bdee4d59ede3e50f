// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"
#include "doorforge/validate/validate_door.h"

#include "page_content.h"

namespace doorforge::internal {

/// A door or part with what of it could not be read.
template <class Record>
struct ReadRecord {
  Record record;
  std::vector<std::string> faults;  ///< Messages of the meshes that are missing or damaged.
};

/// Reads what can be read: a mesh that cannot is empty and a fault. Throw as ReadDoor() and
/// ReadPart() where the record itself cannot be read.
ReadRecord<DoorAsset> ReadDoorForView(const std::filesystem::path& folder);
ReadRecord<Part> ReadPartForView(const std::filesystem::path& folder);

/// The names of links, geometries and joints that a finding is about, as its `where` tells them;
/// empty where it is about the record as a whole.
std::vector<std::string> PlacesOf(const std::string& where, std::span<const std::string> names);

/// Says of a geometry, given the numbers of its link and its place there, what a page holds of its
/// meshes: "mesh", and where they are there "hulls", "visual" and "place" (link_from_mesh).
using MeshesForView = std::function<PageContent::Json(const DoorGeometry& geometry,
                                                      std::size_t link, std::size_t index)>;

/// Everything: closed mesh, convex pieces, what its author drew.
MeshesForView AllMeshes(PageContent& content);

/// What a page shows of a door: identity, links with their meshes, joints, latch, bolt, grasp.
PageContent::Json DoorForView(const DoorAsset& door, const MeshesForView& meshes,
                              PageContent& content);

/// Shows a part alike: its fixed piece is link 0, the one that turns link 1. A part has no latch.
PageContent::Json PartForView(const Part& part, const MeshesForView& meshes);

/// Adds "findings" to what DoorForView() or PartForView() gave.
void AddFindings(std::span<const Finding> findings, PageContent::Json& shown);

}  // namespace doorforge::internal
