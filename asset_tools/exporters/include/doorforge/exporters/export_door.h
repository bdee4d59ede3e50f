// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/named_enum.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// What becomes of the latch in an export: kBolt builds a bolt that slides in the leaf, follows the
/// handle and meets a strike on the frame, whose shapes are cut out around it; kData names the
/// law's numbers, and whoever simulates the door applies it.
enum class LatchExport { kBolt, kData };
inline constexpr NamedValue<LatchExport> kLatchExports[] = {{LatchExport::kBolt, "bolt"},
                                                            {LatchExport::kData, "data"}};
constexpr std::span<const NamedValue<LatchExport>> ValuesOf(LatchExport) { return kLatchExports; }

/// How a door is written.
struct ExportSettings {
  LatchExport latch = LatchExport::kBolt;  ///< GLB, which is for viewers, has data in either case.
  /// PNG of the door, written beside the formats as thumbnail.png and where the catalogues of a
  /// format look for it; empty: none.
  std::string thumbnail_png = {};
};

/// A program that doors are exported for.
struct ExportProfile {
  std::string_view name;    ///< "mujoco", "isaac", "gazebo" or "sapien".
  std::string_view format;  ///< The one that it reads best.
  bool thumbnail;           ///< Its catalogues show pictures.
};
std::span<const ExportProfile> ExportProfiles();
std::vector<std::string> ExportProfileNames();
/// Null if there is no such profile.
const ExportProfile* ExportProfileNamed(std::string_view name);

/// A format that a door can be handed on in. All hold the same links, joints, limits and masses;
/// docs/export.md says what becomes of the latch in each.
struct DoorFormat {
  std::string_view name;  ///< It is the word for the format in options and records.
  bool names_meshes;      ///< Whether its files name those of WriteMeshFiles() beside them.
  /// Writes the format's files into an existing folder.
  void (*write)(const DoorAsset& door, const ExportSettings& settings,
                const std::filesystem::path& folder);
};

/// All formats, in the order in which help and messages name them.
std::span<const DoorFormat> DoorFormats();
/// Their names, for the choices of an option.
std::vector<std::string> DoorFormatNames();
/// Null if there is no such format.
const DoorFormat* DoorFormatNamed(std::string_view name);

/// MuJoCo's model, with the meshes of WriteDoor() beside it. A latch is a bolt: a sliding body in
/// the leaf's free edge, coupled to the handle by a tendon, and a strike on the frame that only the
/// bolt touches. It holds up to half the unlock angle and lets go before 1.05 times it. Gravity is
/// the model's default; the latch's numbers are also in <custom>, the grasp is the site "grasp".
/// Visuals are the closed meshes in their colours: MuJoCo takes no others.
std::string ToMjcf(const DoorAsset& door, const ExportSettings& settings = {});

/// URDF with the meshes of WriteDoor() beside it and, for a bolt, those of meshes/latch. The bolt
/// is a link on a prismatic joint that mimics handle_joint; since URDF has no word for a spring,
/// the handle's joint has friction that bears its weight. <ros2_control> has the joints' limits,
/// <doorforge> latch, grasp and what the door is.
std::string ToExportedUrdf(const DoorAsset& door, const ExportSettings& settings = {});

/// SDF 1.9 (sdformat 12) with the meshes of WriteDoor() beside it. Springs are in the joints'
/// dynamics. A bolt touches the strike alone, by bit masks; it follows the handle by <mimic>, a
/// word of SDF 1.11 that older readers pass over. The latch's numbers are in the element
/// <doorforge:latch>, the grasp is the frame "grasp".
std::string ToSdf(const DoorAsset& door, const ExportSettings& settings = {});
/// The model.config that Gazebo wants beside model.sdf.
std::string ToSdfConfig(const DoorAsset& door);

/// glTF 2.0 binary, all in one file: a node a link and a geometry by their names, visual meshes
/// only, those of authors with their materials, texture coordinates and pictures, y up by the root
/// node's turn. Joints and latch are in `extras` of the nodes.
std::string ToGlb(const DoorAsset& door);

/// USD as text with UsdPhysics schemas; all in one file but pictures, which it names as
/// AuthoredTexturePath(). A bolt's prismatic joint has the mimic schemas of Newton and PhysX; it
/// touches no link but the frame, by filtered pairs.
std::string ToUsda(const DoorAsset& door, const ExportSettings& settings = {});

/// The folder of an exported door, for StagedFolder.
inline constexpr FolderKind kExportFolder{"an exported door", "export.json",
                                          "doorforge.exported_door"};

/// Commits `folder` with the files of these formats, with `meshes/` for those that name them, and
/// with export.json, which says of which door they are, how it was written and by whom. Throws
/// Error(kInvalidArgument) if the folder exists and may not be replaced: only what holds an
/// export.json of ours is. Deterministic.
void WriteExportedDoor(const DoorAsset& door, std::span<const DoorFormat> formats,
                       const std::filesystem::path& folder, Existing existing,
                       const ExportSettings& settings = {});

}  // namespace doorforge
