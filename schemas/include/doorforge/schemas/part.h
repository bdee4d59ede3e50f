// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/shape_descriptor.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/visual_mesh.h"

namespace doorforge {

inline constexpr int kPartSchemaVersion = 1;

/// The folder of a part, for StagedFolder.
inline constexpr FolderKind kPartFolder{"a part", "part.json", "doorforge.part"};

/// One rigid piece of a part. Meshes are in the part's frame.
struct PartPiece {
  /// Body: "frame" (optional, fixed) and "leaf" (moves). Handle: "rose" (optional, fixed to the
  /// leaf) and "grip" (moves).
  std::string name;
  TriangleMesh mesh;                ///< Closed, oriented, positive volume.
  std::vector<TriangleMesh> hulls;  ///< Convex, closed; together they stand for the piece.
  Eigen::Vector4d color_rgba{0.7, 0.7, 0.7, 1.0};
  MassProperties mass;  ///< In the part's frame.
  /// What its author drew, in the part's frame; empty: `mesh` in its colour.
  VisualMesh visual = {};
};

/// A revolute joint of a part, in the part's frame. Positive angles open (body) or unlock (handle).
struct PartJoint {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< A point on the axis.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();     ///< Unit length.
  double lower_rad = 0;
  double upper_rad = 0;  ///< lower = upper = 0: the piece does not turn (mechanism none).
};

/// A reusable half of a door.
///
/// Part frame of both roles: x out of the leaf towards who opens it, y from the hinge to the free
/// edge, z up. Body: origin at the bottom (z = 0 is the lowest point), x = y = 0 as its author put
/// them; the hinge is at the small-y side. Handle: origin at the mount, the plane x = 0 lies on the
/// leaf's surface and the piece "grip" reaches into x > 0.
struct Part {
  std::string id;
  PartRole role = PartRole::kBody;
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;  ///< A body has kNone.
  std::vector<PartPiece> pieces;
  PartJoint joint;  ///< Body: the hinge. Handle: the axis that unlocks.

  /// Body: where a handle of this category goes; the handle's frame is put here.
  RigidTransform part_from_mount = RigidTransform::Identity();
  /// Handle: pose of the gripper's grasp frame (x across, y the direction in which the fingers
  /// close, z the approach; origin midway between the pads).
  RigidTransform part_from_grasp = RigidTransform::Identity();
  /// Handle: half extents of the box around the grasp frame within which a grasp still holds [m].
  Eigen::Vector3d grasp_half_extent_m = Eigen::Vector3d::Zero();

  std::string license;  ///< SPDX expression, or "NOASSERTION" where the source states none.
  std::string source;   ///< Recipe file or description of where the part came from.
  std::string source_sha256;
};

/// Writes `part.json` and `meshes/` (canonical files, visual meshes in `meshes/authored`) into an
/// existing folder, in general that of a StagedFolder.
void WritePart(const Part& part, const std::filesystem::path& folder);

/// Reads a part's folder. Throws Error(kMissing) or Error(kFormat); mesh paths that leave the
/// folder are refused. Closedness is not checked here: that is `doorforge validate`.
Part ReadPart(const std::filesystem::path& folder);
/// Reads the meshes with readers of the caller, which also decide which paths they accept. Visual
/// meshes are read as by ReadPart(folder), which refuses changed files, unless `read_visual` is
/// given.
Part ReadPart(const std::filesystem::path& folder, const MeshReader& read_mesh,
              const VisualReader& read_visual = {});

/// Describes all pieces together; part.json holds it as "shape", so that copies are found without
/// reading meshes.
ShapeDescriptor ShapeOf(const Part& part);

/// SHA-256 over part.json's fields but "shape", and the bytes of meshes and
/// visual meshes: the part's identity for later
/// values.
std::string ContentHash(const Part& part);

const PartPiece* FindPiece(const Part& part, std::string_view name);

}  // namespace doorforge
