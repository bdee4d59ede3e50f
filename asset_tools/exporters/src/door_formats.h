// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/exporters/export_door.h"

namespace doorforge::internal {

// What writes each format into a folder. A new one is declared here, has its row below and is named
// in CMakeLists.txt.
void WriteUrdf(const DoorAsset& door, const ExportSettings& settings,
               const std::filesystem::path& folder);
void WriteMjcf(const DoorAsset& door, const ExportSettings& settings,
               const std::filesystem::path& folder);
void WriteSdf(const DoorAsset& door, const ExportSettings& settings,
              const std::filesystem::path& folder);
void WriteGlb(const DoorAsset& door, const ExportSettings& settings,
              const std::filesystem::path& folder);
void WriteUsda(const DoorAsset& door, const ExportSettings& settings,
               const std::filesystem::path& folder);

/// The formats: name, whether the files name meshes, and what writes them.
inline constexpr DoorFormat kDoorFormats[] = {{"urdf", true, WriteUrdf},
                                              {"mjcf", true, WriteMjcf},
                                              {"sdf", true, WriteSdf},
                                              {"glb", false, WriteGlb},
                                              {"usda", false, WriteUsda}};

}  // namespace doorforge::internal
