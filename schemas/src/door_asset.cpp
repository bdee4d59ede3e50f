// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_asset.h"

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/mesh_file.h"

#include "latch_json.h"
#include "record_json.h"

namespace doorforge {
namespace {

using internal::Json;

constexpr std::array<const char*, kPointLabelCount> kLabelNames = {"body", "handle", "frame",
                                                                   "robot", "other"};

PointLabel LabelNamed(const std::string& name, const std::string& path) {
  for (std::size_t i = 0; i < kLabelNames.size(); ++i) {
    if (name == kLabelNames[i]) return static_cast<PointLabel>(i);
  }
  throw Error(ErrorCode::kFormat, path + ".label: unknown name \"" + name + '"');
}

Json GeometryToJson(const DoorGeometry& geometry) {
  Json hulls = Json::array();
  for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
    hulls.push_back(internal::MeshReference(CollisionMeshPath(geometry, i), geometry.hulls[i]));
  return {{"name", geometry.name},
          {"label", kLabelNames.at(static_cast<std::size_t>(geometry.label))},
          {"color_rgba", internal::ColorToJson(geometry.color_rgba)},
          {"mesh", internal::MeshReference(VisualMeshPath(geometry), geometry.mesh)},
          {"hulls", hulls}};
}

DoorGeometry GeometryFromJson(const Json& json, const MeshReader& read_mesh,
                              const std::string& path) {
  DoorGeometry geometry;
  geometry.name = ValueOf<std::string>(json, "name", path);
  geometry.label = LabelNamed(ValueOf<std::string>(json, "label", path), path);
  geometry.color_rgba = internal::ColorFromJson(MemberOf(json, "color_rgba", path), path);
  geometry.mesh = internal::ReadReferencedMesh(MemberOf(json, "mesh", path), read_mesh, path);
  for (const Json& hull : MemberOf(json, "hulls", path))
    geometry.hulls.push_back(internal::ReadReferencedMesh(hull, read_mesh, path));
  return geometry;
}

Json LinkToJson(const DoorLink& link) {
  Json geometry = Json::array();
  for (const DoorGeometry& piece : link.geometry) geometry.push_back(GeometryToJson(piece));
  return {{"name", link.name}, {"mass", internal::MassToJson(link.mass)}, {"geometry", geometry}};
}

DoorLink LinkFromJson(const Json& json, const MeshReader& read_mesh, const std::string& path) {
  DoorLink link;
  link.name = ValueOf<std::string>(json, "name", path);
  link.mass = internal::MassFromJson(MemberOf(json, "mass", path), path);
  for (const Json& piece : MemberOf(json, "geometry", path))
    link.geometry.push_back(GeometryFromJson(piece, read_mesh, path));
  return link;
}

Json JointToJson(const DoorJoint& joint) {
  return {{"name", joint.name},
          {"parent_from_child_at_zero", TransformToJson(joint.parent_from_child_at_zero)},
          {"axis", Vector3ToJson(joint.axis)},
          {"lower_rad", joint.lower_rad},
          {"upper_rad", joint.upper_rad},
          {"effort_limit_nm", joint.effort_limit_nm},
          {"velocity_limit_rad_s", joint.velocity_limit_rad_s},
          {"damping_nm_s", joint.damping_nm_s}};
}

DoorJoint JointFromJson(const Json& json, const std::string& path) {
  DoorJoint joint;
  joint.name = ValueOf<std::string>(json, "name", path);
  joint.parent_from_child_at_zero =
      TransformFromJson(MemberOf(json, "parent_from_child_at_zero", path), path);
  joint.axis = Vector3FromJson(MemberOf(json, "axis", path), path + ".axis");
  joint.lower_rad = ValueOf<double>(json, "lower_rad", path);
  joint.upper_rad = ValueOf<double>(json, "upper_rad", path);
  joint.effort_limit_nm = ValueOf<double>(json, "effort_limit_nm", path);
  joint.velocity_limit_rad_s = ValueOf<double>(json, "velocity_limit_rad_s", path);
  joint.damping_nm_s = ValueOf<double>(json, "damping_nm_s", path);
  return joint;
}

Json DoorToJson(const DoorAsset& door) {
  Json json = {{"schema", "doorforge.door"},
               {"schema_version", kDoorSchemaVersion},
               {"id", door.id},
               {"category", NameOf(door.category)},
               {"mechanism", NameOf(door.mechanism)},
               {"license", door.license},
               {"body", {{"id", door.body_id}, {"sha256", door.body_sha256}}},
               {"handle", {{"id", door.handle_id}, {"sha256", door.handle_sha256}}},
               {"latch", internal::LatchToJson(door.latch)},
               {"hinge", JointToJson(door.hinge)},
               {"handle_joint", JointToJson(door.handle_joint)},
               {"handle_from_grasp", TransformToJson(door.handle_from_grasp)},
               {"grasp_half_extent_m", Vector3ToJson(door.grasp_half_extent_m)},
               {"links", Json::array()}};
  for (const DoorLink& link : door.links) json["links"].push_back(LinkToJson(link));
  return json;
}

void ReadIdentity(const Json& json, const std::string& path, DoorAsset& door) {
  door.id = ValueOf<std::string>(json, "id", path);
  const auto category = CategoryNamed(ValueOf<std::string>(json, "category", path));
  const auto mechanism = MechanismNamed(ValueOf<std::string>(json, "mechanism", path));
  if (!category || !mechanism)
    throw Error(ErrorCode::kFormat, path + ": unknown category or mechanism");
  door.category = *category;
  door.mechanism = *mechanism;
  door.license = ValueOf<std::string>(json, "license", path);
  const Json& body = MemberOf(json, "body", path);
  const Json& handle = MemberOf(json, "handle", path);
  door.body_id = ValueOf<std::string>(body, "id", path);
  door.body_sha256 = ValueOf<std::string>(body, "sha256", path);
  door.handle_id = ValueOf<std::string>(handle, "id", path);
  door.handle_sha256 = ValueOf<std::string>(handle, "sha256", path);
}

}  // namespace

std::array<RigidTransform, 3> DoorFromLinks(const DoorAsset& door, double hinge_rad,
                                            double handle_rad) {
  const RigidTransform door_from_leaf =
      door.hinge.parent_from_child_at_zero * RotationAbout(door.hinge.axis, hinge_rad);
  const RigidTransform leaf_from_handle = door.handle_joint.parent_from_child_at_zero *
                                          RotationAbout(door.handle_joint.axis, handle_rad);
  return {RigidTransform::Identity(), door_from_leaf, door_from_leaf * leaf_from_handle};
}

std::string VisualMeshPath(const DoorGeometry& geometry) {
  return "meshes/visual/" + geometry.name + ".obj";
}

std::string CollisionMeshPath(const DoorGeometry& geometry, std::size_t hull_index) {
  return "meshes/collision/" + geometry.name + "_" + std::to_string(hull_index) + ".obj";
}

void WriteDoor(const DoorAsset& door, const std::filesystem::path& folder) {
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      CommitFile(folder / VisualMeshPath(geometry), ToObj(geometry.mesh));
      for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
        CommitFile(folder / CollisionMeshPath(geometry, i), ToObj(geometry.hulls[i]));
    }
  }
  WriteJsonFile(folder / "door.json", DoorToJson(door));
}

DoorAsset ReadDoor(const std::filesystem::path& folder) {
  return ReadDoor(folder, internal::ReaderBelow(folder, (folder / "door.json").string()));
}

DoorAsset ReadDoor(const std::filesystem::path& folder, const MeshReader& read_mesh) {
  const std::string path = (folder / "door.json").string();
  const Json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.door", kDoorSchemaVersion, path);
  DoorAsset door;
  ReadIdentity(json, path, door);
  door.latch = internal::LatchFromJson(MemberOf(json, "latch", path), path + ".latch");
  door.hinge = JointFromJson(MemberOf(json, "hinge", path), path + ".hinge");
  door.handle_joint = JointFromJson(MemberOf(json, "handle_joint", path), path + ".handle_joint");
  door.handle_from_grasp = TransformFromJson(MemberOf(json, "handle_from_grasp", path), path);
  door.grasp_half_extent_m = Vector3FromJson(MemberOf(json, "grasp_half_extent_m", path), path);
  const Json& links = MemberOf(json, "links", path);
  if (!links.is_array() || links.size() != door.links.size())
    throw Error(ErrorCode::kFormat, path + ".links: expected base, leaf and handle");
  for (std::size_t i = 0; i < door.links.size(); ++i)
    door.links[i] = LinkFromJson(links[i], read_mesh, path + ".links");
  return door;
}

std::string ContentHash(const DoorAsset& door) { return Sha256Hex(DoorToJson(door).dump()); }

}  // namespace doorforge
