// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/exporters/export_door.h"

#include <algorithm>
#include <array>

#include "doorforge/core/json_file.h"
#include "doorforge/exporters/export_urdf.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kFormats = {"urdf", "mjcf", "sdf", "glb", "usda"};

bool NamesMeshes(DoorFormat format) {
  return format == DoorFormat::kUrdf || format == DoorFormat::kMjcf || format == DoorFormat::kSdf;
}

// Beside a USD layer, which holds all else.
void WriteTextures(const DoorAsset& door, const fs::path& folder) {
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      for (const auto& texture : TexturesOf(geometry.visual))
        CommitFile(folder / AuthoredTexturePath(*texture), texture->bytes);
    }
  }
}

void WriteFormat(const DoorAsset& door, DoorFormat format, const fs::path& folder) {
  switch (format) {
    case DoorFormat::kUrdf:
      CommitFile(folder / "model.urdf", ToUrdf(ToUrdfModel(door)));
      break;
    case DoorFormat::kMjcf:
      CommitFile(folder / "model.xml", ToMjcf(door));
      break;
    case DoorFormat::kSdf:
      CommitFile(folder / "model.sdf", ToSdf(door));
      CommitFile(folder / "model.config", ToSdfConfig(door));
      break;
    case DoorFormat::kGlb:
      CommitFile(folder / "model.glb", ToGlb(door));
      break;
    case DoorFormat::kUsda:
      CommitFile(folder / "model.usda", ToUsda(door));
      WriteTextures(door, folder);
      break;
  }
}

}  // namespace

std::string_view NameOf(DoorFormat format) { return kFormats.at(static_cast<std::size_t>(format)); }

std::optional<DoorFormat> DoorFormatNamed(std::string_view name) {
  const auto found = std::find(kFormats.begin(), kFormats.end(), name);
  if (found == kFormats.end()) return std::nullopt;
  return static_cast<DoorFormat>(found - kFormats.begin());
}

void WriteExportedDoor(const DoorAsset& door, std::span<const DoorFormat> formats,
                       const fs::path& folder, Existing existing) {
  StagedFolder staged(folder, kExportFolder, existing);
  if (std::any_of(formats.begin(), formats.end(), NamesMeshes)) WriteMeshFiles(door, staged.path());
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const DoorFormat format : formats) {
    WriteFormat(door, format, staged.path());
    names.push_back(NameOf(format));
  }
  WriteJsonFile(staged.path() / kExportFolder.record, {{"schema", kExportFolder.schema},
                                                       {"schema_version", 1},
                                                       {"door", door.id},
                                                       {"door_sha256", ContentHash(door)},
                                                       {"formats", names}});
  staged.Commit();
}

}  // namespace doorforge
