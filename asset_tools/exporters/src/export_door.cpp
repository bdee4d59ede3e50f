// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/exporters/export_door.h"

#include <algorithm>
#include <iterator>

#include "doorforge/core/json_file.h"

#include "door_formats.h"
#include "latch_bodies.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr ExportProfile kExportProfiles[] = {{"mujoco", "mjcf", false},
                                             {"isaac", "usda", true},
                                             {"gazebo", "sdf", true},
                                             {"sapien", "urdf", false}};

// Where Omniverse's browser and Gazebo's Fuel look for the picture of a model.
void WriteThumbnails(const std::string& png, std::span<const DoorFormat> formats,
                     const fs::path& folder) {
  if (png.empty()) return;
  CommitFile(folder / "thumbnail.png", png);
  for (const DoorFormat& format : formats) {
    if (format.name == "usda") CommitFile(folder / ".thumbs/256x256/model.usda.png", png);
    if (format.name == "sdf") CommitFile(folder / "thumbnails/1.png", png);
  }
}

}  // namespace

std::span<const ExportProfile> ExportProfiles() { return kExportProfiles; }

std::vector<std::string> ExportProfileNames() {
  std::vector<std::string> names;
  for (const ExportProfile& profile : kExportProfiles) names.emplace_back(profile.name);
  return names;
}

const ExportProfile* ExportProfileNamed(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kExportProfiles), std::end(kExportProfiles),
                                         [&](const auto& one) { return one.name == name; });
  return found == std::end(kExportProfiles) ? nullptr : found;
}

std::span<const DoorFormat> DoorFormats() { return internal::kDoorFormats; }

std::vector<std::string> DoorFormatNames() {
  std::vector<std::string> names;
  for (const DoorFormat& format : DoorFormats()) names.emplace_back(format.name);
  return names;
}

const DoorFormat* DoorFormatNamed(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(internal::kDoorFormats), std::end(internal::kDoorFormats),
                   [&](const DoorFormat& format) { return format.name == name; });
  return found == std::end(internal::kDoorFormats) ? nullptr : found;
}

void WriteExportedDoor(const DoorAsset& door, std::span<const DoorFormat> formats,
                       const fs::path& folder, Existing existing, const ExportSettings& settings) {
  StagedFolder staged(folder, kExportFolder, existing);
  if (std::any_of(formats.begin(), formats.end(),
                  [](const DoorFormat& format) { return format.names_meshes; })) {
    WriteMeshFiles(door, staged.path());
    if (settings.latch == LatchExport::kBolt) {
      for (const auto& latch :
           {internal::LatchBodiesOf(door), internal::LatchBodiesInPlace(door)}) {
        if (latch) internal::WriteLatchMeshes(*latch, staged.path());
      }
    }
  }
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const DoorFormat& format : formats) {
    format.write(door, settings, staged.path());
    names.push_back(format.name);
  }
  WriteThumbnails(settings.thumbnail_png, formats, staged.path());
  WriteJsonFile(staged.path() / kExportFolder.record, {{"schema", kExportFolder.schema},
                                                       {"schema_version", 1},
                                                       {"door", door.id},
                                                       {"door_sha256", ContentHash(door)},
                                                       {"latch", NameOf(settings.latch)},
                                                       {"formats", names}});
  staged.Commit();
}

}  // namespace doorforge
