// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/exporters/export_urdf.h"

#include "doorforge/core/committed_file.h"

namespace doorforge {
namespace {

void AddShapes(const DoorGeometry& geometry, const GeometryFiles& files, UrdfLink& link) {
  UrdfShape visual;
  visual.name = geometry.name;
  visual.link_from_shape = files.link_from_files;
  visual.geometry = UrdfMeshFile{.filename = files.visual ? files.visual->mesh.path : files.mesh};
  // a material here would hide those that the mesh brings along
  if (!files.visual) visual.color_rgba = geometry.color_rgba;
  link.visuals.push_back(visual);
  for (const std::string& hull : files.hulls) {
    UrdfShape collision;  // without a name, which would say no more than its place
    collision.link_from_shape = files.link_from_files;
    collision.geometry = UrdfMeshFile{.filename = hull};
    link.collisions.push_back(collision);
  }
}

UrdfJoint ToUrdfJoint(const DoorJoint& joint, const std::string& parent, const std::string& child) {
  UrdfJoint urdf;
  urdf.name = joint.name;
  urdf.type = joint.upper_rad > joint.lower_rad ? UrdfJointType::kRevolute : UrdfJointType::kFixed;
  urdf.parent = parent;
  urdf.child = child;
  urdf.parent_from_joint = joint.parent_from_child_at_zero;
  urdf.axis = joint.axis;
  urdf.lower = joint.lower_rad;
  urdf.upper = joint.upper_rad;
  urdf.effort = joint.effort_limit_nm;
  urdf.velocity = joint.velocity_limit_rad_s;
  urdf.damping = joint.damping_nm_s;
  return urdf;
}

}  // namespace

UrdfModel ToUrdfModel(const DoorAsset& door) { return ToUrdfModel(door, OwnFilesOf(door)); }

UrdfModel ToUrdfModel(const DoorAsset& door, const DoorFiles& files) {
  UrdfModel model;
  model.name = door.id;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const DoorLink& link = door.links[i];
    UrdfLink urdf;
    urdf.name = link.name;
    urdf.inertial = link.mass;
    for (std::size_t k = 0; k < link.geometry.size(); ++k) {
      AddShapes(link.geometry[k], files[i].at(k), urdf);
      if (files[i].at(k).visual) model.mujoco_reads_visuals = false;
    }
    model.links.push_back(std::move(urdf));
  }
  const auto& names = door.links;
  model.joints = {ToUrdfJoint(door.hinge, names[kBaseLink].name, names[kLeafLink].name),
                  ToUrdfJoint(door.handle_joint, names[kLeafLink].name, names[kHandleLink].name)};
  return model;
}

void WriteDoorFolder(const DoorAsset& door, const std::filesystem::path& folder,
                     Existing existing) {
  StagedFolder staged(folder, kDoorFolder, existing);
  WriteDoor(door, staged.path());
  CommitFile(staged.path() / "model.urdf", ToUrdf(ToUrdfModel(door)));
  staged.Commit();
}

}  // namespace doorforge
