// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/parts/make_part.h"
#include "doorforge/schemas/names.h"

namespace doorforge {

/// One composed object of UniDoorManip, read but not yet loaded: what its files say it consists of.
///
/// Everything lies in the object frame, which is ours: x out of the door, y from the hinge to the
/// free edge, z up; the object's base stands at yaw 180 degrees in it, as in the released
/// simulator.
struct UniDoorManipObject {
  /// A mesh file and where it goes.
  struct Mesh {
    std::string piece;  ///< "frame", "leaf", "rose" or "grip".
    std::filesystem::path file;
    std::string sha256;  ///< The file has this hash.
    /// Uniform scale, the turn of the raw (z-up) file into the link frame, and the link's pose at
    /// zero joint angles; rotation times scale plus offset.
    Eigen::Affine3d object_from_raw = Eigen::Affine3d::Identity();
  };

  std::filesystem::path folder;  ///< It is the object's; textures lie below it.
  std::string name;              ///< Sub-task and object, such as "LeverDoor/99650069960003".
  std::string body_name;         ///< First seven digits, or the folder's name.
  std::string handle_name;       ///< Last seven digits, or the folder's name.
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;
  std::vector<Mesh> body_meshes;
  std::vector<Mesh> handle_meshes;
  PartJoint hinge;
  PartJoint handle_joint;
  RigidTransform object_from_grasp = RigidTransform::Identity();
  Eigen::AlignedBox3d body_box;       ///< From bounding_box.json; empty if the file is absent.
  Eigen::AlignedBox3d handle_box;     ///< From handle_bounding.json, about the handle's mount.
  std::vector<std::string> left_out;  ///< Meshes of the frame that are absent and may be.
};

/// True if `folder` looks like one object: it holds a mobility.urdf.
bool IsUniDoorManipObject(const std::filesystem::path& folder);

/// Reads the small files of an object and checks that every mesh is there.
///
/// Category and mechanism follow from `category` if given, else from the sub-task folder the object
/// lies in (LeverDoor, RoundDoor, Window, Car, Safe, Cabinet, Fridge), else from the mesh names and
/// ids of the release. Joints: the one revolute joint below the root is the hinge, the one below
/// that the handle's. Signs are turned so that positive angles open towards +x and unlock. The
/// handle's range is HandleRange(), not the file's. Numbers of frames are in docs/import.md.
///
/// @param category Name as in names.h, or empty.
/// @param frame_may_miss An object whose frame's (or car's) mesh is absent is read without it.
/// @throws Error(kMissing) if a file that the object needs is absent: all absent ones are named;
///     Error(kFormat) if a file does not follow its format, the joints are not a hinge and a
///     handle, or a mesh path leaves the folder; Error(kInvalidArgument) if the category cannot be
///     told.
UniDoorManipObject ReadUniDoorManip(const std::filesystem::path& folder,
                                    const std::string& category, bool frame_may_miss = false);

/// Loads the meshes of one half of the object into that half's part frame. The facts carry licence
/// "NOASSERTION", the source, and as `source_sha256` a hash of everything the part is made of:
/// equal for parts that several objects share.
PartDraft LoadBody(const UniDoorManipObject& object);
PartDraft LoadHandle(const UniDoorManipObject& object);

/// The hash that LoadBody() and LoadHandle() record, without loading meshes.
std::string BodySourceHash(const UniDoorManipObject& object);
std::string HandleSourceHash(const UniDoorManipObject& object);

/// Largest distance between the faces of the box that the object's own JSON files state and the box
/// of the loaded meshes, an independent check of frames and scales [m]; 0 where no box is stated.
/// The stated boxes are those of the frame (of the leaf where there is no frame) and of the grip.
double BoxDeviation(const UniDoorManipObject& object, const PartDraft& half);

}  // namespace doorforge
