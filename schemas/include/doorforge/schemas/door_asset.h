// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/part_identity.h"
#include "doorforge/schemas/visual_mesh.h"

namespace doorforge {

inline constexpr int kDoorSchemaVersion = 2;

/// The folder of a door, for StagedFolder.
inline constexpr FolderKind kDoorFolder{"a door", "door.json", "doorforge.door"};

/// A mesh fixed to a link, in the link's frame.
struct DoorGeometry {
  std::string name;                 ///< Unique in the door, such as "leaf" or "grip".
  TriangleMesh mesh;                ///< Closed; what the depth camera sees.
  std::vector<TriangleMesh> hulls;  ///< Convex; what touches.
  Eigen::Vector4d color_rgba{0.7, 0.7, 0.7, 1.0};
  PointLabel label = PointLabel::kBody;
  /// What its author drew, for renderers, in the link's frame; empty: `mesh` in its colour.
  VisualMesh visual = {};
};

struct DoorLink {
  std::string name;  ///< "base", "leaf", "handle".
  std::vector<DoorGeometry> geometry;
  MassProperties mass;  ///< In the link's frame.
};

/// Revolute joint at the child link's origin.
struct DoorJoint {
  std::string name;  ///< "hinge", "handle_joint".
  RigidTransform parent_from_child_at_zero = RigidTransform::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Unit, in the child's frame.
  double lower_rad = 0;
  double upper_rad = 0;
  double effort_limit_nm = 0;
  double velocity_limit_rad_s = 0;
  double damping_nm_s = 0;  ///< Not in the paper; see docs/design/simulation.md.
};

/// The latch as data. kEffort is the paper's law (Section 3.2): while locked the hinge feels
/// -lock_effort against opening, afterwards -hinge_spring * door angle; the handle feels
/// -handle_spring * handle angle throughout. Locked means handle angle <= unlock_angle.
///
/// kBolt is a bolt that reaches bolt_throw_m into the strike of the frame and is drawn back by
/// bolt_throw_m * min(1, handle angle / unlock_angle): it holds whatever the effort, and catches
/// again as the leaf closes, see bolt.h. lock_effort_nm, relatch and unlocks_ajar say nothing then;
/// the springs do.
struct Latch {
  LatchType type = LatchType::kNone;
  double unlock_angle_rad = 0;
  /// The policies' "handle done" angle, larger than unlock_angle; sticky within an episode.
  double handle_done_angle_rad = 0;
  double lock_effort_nm = 150;
  double hinge_spring_nm_per_rad = 3;
  double handle_spring_nm_per_rad = 3;
  /// False: a door that has been unlocked stays so while it is ajar by more than 0.01 rad, but one
  /// that its lock effort holds there under load does not come free; true: it locks again whenever
  /// the handle returns (the paper's formula).
  bool relatch = false;
  /// The released code's variant, not together with relatch: ajar by more than 0.01 rad, the door
  /// is unlocked, even if force alone has brought it there.
  bool unlocks_ajar = false;
  double bolt_throw_m = 0;  ///< Only a latch of type kBolt has it.
};

enum DoorLinkIndex : int { kBaseLink = 0, kLeafLink = 1, kHandleLink = 2 };

/// A composed door: base (frame), leaf, handle; two joints.
///
/// Door frame = base link's frame: x out of the leaf towards who stands in front of the handle, z
/// up, z = 0 the lowest point, y to that person's right. All link frames are parallel to it at zero
/// angles; the leaf's origin lies on the hinge line, the handle's on the handle's axis at the
/// mount. Positive hinge angles open, positive handle angles unlock; directions are in the joints'
/// axes.
///
/// The canonical door, which the paper's objects and the catalogue's parts are, is hinged left and
/// pulled: the hinge is at small y and the leaf opens towards x > 0. Hinged right, the hinge is at
/// large y; pushed, the leaf opens towards x < 0.
struct DoorAsset {
  std::string id;  ///< "<body id>__<handle id>" unless the author names it.
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;
  std::array<DoorLink, 3> links;  ///< Indexed by DoorLinkIndex.
  DoorJoint hinge;                ///< Base to leaf.
  DoorJoint handle_joint;         ///< Leaf to handle.
  Latch latch;
  HingeSide hinge_side = HingeSide::kLeft;
  Opening opening = Opening::kPull;
  RigidTransform handle_from_grasp = RigidTransform::Identity();  ///< See Part::part_from_grasp.
  Eigen::Vector3d grasp_half_extent_m = Eigen::Vector3d::Zero();
  PartIdentity body;
  PartIdentity handle;
  std::string license;  ///< SPDX expression of both parts.
  /// Where masses, springs and dampings come from, for people; empty where nobody said.
  std::string physics_source = {};
};

/// Throws Error(kInvalidArgument) unless the door is what scenes, the simulated world and the
/// experts are made for: the hinge opens and moves the handle the way that `opening` says; a bolt
/// has a throw, a handle that turns beyond the unlock angle, and an upright hinge on the door's
/// hinge_side; no two pieces have one name, for a record that repeats a piece four hundred times
/// costs minutes. `user` begins the message, such as "simulate".
void RequireSimulatable(const DoorAsset& door, std::string_view user);

/// Poses of base, leaf and handle in the door frame at the given joint angles.
std::array<RigidTransform, 3> DoorFromLinks(const DoorAsset& door, double hinge_rad,
                                            double handle_rad);

/// Writes `door.json`, `meshes/{visual,collision}/*.obj` and the visual meshes of authors in
/// `meshes/authored` into an existing folder. The URDF beside it is written by ComposeDoor's
/// exporter (asset_tools/exporters).
void WriteDoor(const DoorAsset& door, const std::filesystem::path& folder);

/// Reads a door's folder. Throws Error(kMissing) or Error(kFormat); mesh paths that leave the
/// folder are refused. The one way out of it is the mesh pool beside it, see mesh_pool.h.
DoorAsset ReadDoor(const std::filesystem::path& folder);
/// Reads the meshes with readers of the caller, which also decide which paths they accept. Visual
/// meshes are read as by ReadDoor(folder), which refuses changed files, unless `read_visual` is
/// given.
DoorAsset ReadDoor(const std::filesystem::path& folder, const MeshReader& read_mesh,
                   const VisualReader& read_visual = {});

/// File of a mesh relative to the door's folder: "meshes/visual/<name>.obj" and
/// "meshes/collision/<name>_<index>.obj".
std::string VisualMeshPath(const DoorGeometry& geometry);
std::string CollisionMeshPath(const DoorGeometry& geometry, std::size_t hull_index);

/// Files of what authors drew: "meshes/authored/<name>.obj" and "meshes/authored/<20 digits>.png".
std::string AuthoredMeshPath(const DoorGeometry& geometry);
std::string AuthoredTexturePath(const VisualTexture& texture);

/// Writes the files of all meshes that OwnFilesOf() names.
void WriteMeshFiles(const DoorAsset& door, const std::filesystem::path& folder);

/// Where the files of one geometry lie, relative to the door's folder.
struct GeometryFiles {
  std::string mesh;
  std::vector<std::string> hulls;
  /// What the files hold is in a frame of its own where doors share them.
  RigidTransform link_from_files = RigidTransform::Identity();
  std::optional<VisualFiles> visual = {};  ///< These files hold what its author drew.
};
/// Indexed as DoorAsset::links and the geometry of each.
using DoorFiles = std::array<std::vector<GeometryFiles>, 3>;

/// The files that WriteDoor() writes.
DoorFiles OwnFilesOf(const DoorAsset& door);
/// The files that the record in `folder` names, in the pool or in the folder. Reads no mesh. Throws
/// as ReadDoor().
DoorFiles ReadDoorFiles(const std::filesystem::path& folder);

/// Text of a door.json whose geometries are shapes of a mesh pool: `shapes` holds their names as
/// `files` its transforms. Meshes of `door` are not looked at.
std::string PooledDoorText(const DoorAsset& door, const DoorFiles& files,
                           const std::array<std::vector<std::string>, 3>& shapes);

/// SHA-256 of door.json's text with the bytes of all files: the door's identity in later records.
/// It is the same whether the door has its own meshes or shares them.
std::string ContentHash(const DoorAsset& door);

}  // namespace doorforge
