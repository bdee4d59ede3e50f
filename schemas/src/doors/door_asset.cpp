// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_asset.h"

#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"
#include "doorforge/schemas/door_with_files.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mesh_pool.h"

#include "doors/door_record.h"
#include "doors/latch_json.h"
#include "models/record_json.h"

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

Json MeshReference(const std::string& path, const std::string& sha256) {
  return {{"path", path}, {"sha256", sha256}};
}

Json GeometryToJson(const DoorGeometry& geometry, const internal::GeometryHashes& hashes) {
  Json hulls = Json::array();
  for (std::size_t i = 0; i < hashes.hulls.size(); ++i)
    hulls.push_back(MeshReference(CollisionMeshPath(geometry, i), hashes.hulls[i]));
  Json json = {{"name", geometry.name},
               {"label", kLabelNames.at(static_cast<std::size_t>(geometry.label))},
               {"color_rgba", internal::ColorToJson(geometry.color_rgba)},
               {"mesh", MeshReference(VisualMeshPath(geometry), hashes.mesh)},
               {"hulls", hulls}};
  if (hashes.visual) json["visual"] = internal::VisualToJson(*hashes.visual);
  return json;
}

// Writes every mesh as text to hash it: for doors that were made in memory. Whoever read a door
// knows the hashes from its record.
internal::DoorHashes HashesOf(const DoorAsset& door) {
  internal::DoorHashes hashes;
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    for (const DoorGeometry& geometry : door.links[i].geometry) {
      internal::GeometryHashes own{Sha256Hex(ToObj(geometry.mesh)), {}, {}};
      for (const TriangleMesh& hull : geometry.hulls) own.hulls.push_back(Sha256Hex(ToObj(hull)));
      own.visual = internal::AuthoredFilesOf(geometry.name, geometry.visual);
      hashes[i].push_back(std::move(own));
    }
  }
  return hashes;
}

Json PooledGeometryToJson(const DoorGeometry& geometry, const GeometryFiles& files,
                          const std::string& shape) {
  Json json = {{"name", geometry.name},
               {"label", kLabelNames.at(static_cast<std::size_t>(geometry.label))},
               {"color_rgba", internal::ColorToJson(geometry.color_rgba)},
               {"shape", shape}};
  // only an exact identity is left out: what is read must be what was written, to the last bit
  if (!files.link_from_files.isApprox(RigidTransform::Identity(), 0))
    json["link_from_shape"] = TransformToJson(files.link_from_files);
  return json;
}

Json LinkToJson(const DoorLink& link, const Json& geometry) {
  return {{"name", link.name}, {"mass", internal::MassToJson(link.mass)}, {"geometry", geometry}};
}

/// Where a door's meshes come from: its own files, or the pool that the record names.
class DoorSource {
 public:
  DoorSource(const Json& record, const std::filesystem::path& folder, const std::string& path) {
    const auto entry = record.find("mesh_pool");
    if (entry == record.end()) return;
    // a record from outside must not lead to files anywhere
    if (*entry != kMeshPoolPath)
      throw Error(ErrorCode::kFormat, path + ".mesh_pool: found " + entry->dump() +
                                          "; the only pool a door may share is \"../pool\"");
    pool_.emplace(folder, path);
  }

  /// The meshes of a geometry as its record names them.
  struct Names {
    struct Mesh {
      std::string path;
      std::string sha256;
    };
    Mesh mesh;
    std::vector<Mesh> hulls;
    RigidTransform link_from_files = RigidTransform::Identity();
    std::optional<VisualFiles> visual = {};
  };

  Names NamesOf(const Json& geometry, const std::string& path) const {
    return geometry.contains("shape") ? Pooled(geometry, path) : Own(geometry, path);
  }

 private:
  static Names::Mesh Reference(const Json& json, const std::string& path) {
    return {ValueOf<std::string>(json, "path", path), ValueOf<std::string>(json, "sha256", path)};
  }

  static Names Own(const Json& geometry, const std::string& path) {
    Names names{Reference(MemberOf(geometry, "mesh", path), path), {}};
    for (const Json& hull : MemberOf(geometry, "hulls", path))
      names.hulls.push_back(Reference(hull, path));
    if (geometry.contains("visual"))
      names.visual = internal::VisualFromJson(geometry["visual"], path + ".visual");
    return names;
  }

  // The pool's messages name its files, and not the door that asks for them.
  PooledShape ShapeOf(const std::string& sha256, const std::string& path) const {
    try {
      return pool_->ReadShape(sha256);
    } catch (const Error& error) {
      throw Error(error.code(), path + ": " + error.what());
    }
  }

  Names Pooled(const Json& geometry, const std::string& path) const {
    if (!pool_)
      throw Error(ErrorCode::kFormat, path + ": names a shape, but the record has no mesh_pool");
    const PooledShape shape = ShapeOf(ValueOf<std::string>(geometry, "shape", path), path);
    Names names{{PooledMeshPath(shape.mesh), shape.mesh}, {}};
    for (const std::string& hull : shape.hulls) names.hulls.push_back({PooledMeshPath(hull), hull});
    names.visual = shape.visual;
    if (geometry.contains("link_from_shape"))
      names.link_from_files =
          TransformFromJson(geometry["link_from_shape"], path + ".link_from_shape");
    return names;
  }

  std::optional<MeshPool> pool_;
};

/// They read meshes and visual meshes.
struct Readers {
  MeshReader mesh;
  VisualReader visual;
};

DoorGeometry GeometryFromJson(const Json& json, const DoorSource& source, const Readers& readers,
                              const std::string& path) {
  DoorGeometry geometry;
  geometry.name = IdOf(json, "name", path);
  geometry.label = LabelNamed(ValueOf<std::string>(json, "label", path), path);
  geometry.color_rgba = internal::ColorFromJson(MemberOf(json, "color_rgba", path), path);
  const DoorSource::Names names = source.NamesOf(json, path);
  const auto read = [&](const DoorSource::Names::Mesh& mesh) {
    return PlacedAsFiled(readers.mesh(mesh.path, mesh.sha256), names.link_from_files);
  };
  geometry.mesh = read(names.mesh);
  for (const auto& hull : names.hulls) geometry.hulls.push_back(read(hull));
  if (names.visual)
    geometry.visual = PlacedAsFiled(readers.visual(*names.visual), names.link_from_files);
  return geometry;
}

DoorLink LinkFromJson(const Json& json, const DoorSource& source, const Readers& readers,
                      const std::string& path) {
  DoorLink link;
  link.name = IdOf(json, "name", path);
  link.mass = internal::MassFromJson(MemberOf(json, "mass", path), path);
  for (const Json& piece : MemberOf(json, "geometry", path))
    link.geometry.push_back(GeometryFromJson(piece, source, readers, path));
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

// All but the links.
Json HeadToJson(const DoorAsset& door) {
  Json json = {{"schema", "doorforge.door"},
               {"schema_version", kDoorSchemaVersion},
               {"id", door.id},
               {"category", NameOf(door.category)},
               {"mechanism", NameOf(door.mechanism)},
               {"license", door.license},
               {"body", IdentityToJson(door.body)},
               {"handle", IdentityToJson(door.handle)},
               {"latch", internal::LatchToJson(door.latch)},
               {"hinge_side", NameOf(door.hinge_side)},
               {"opening", NameOf(door.opening)},
               {"hinge", JointToJson(door.hinge)},
               {"handle_joint", JointToJson(door.handle_joint)},
               {"handle_from_grasp", TransformToJson(door.handle_from_grasp)},
               {"grasp_half_extent_m", Vector3ToJson(door.grasp_half_extent_m)}};
  // doors of earlier builds had none and keep their bytes, and so their hashes
  if (!door.physics_source.empty()) json["physics_source"] = door.physics_source;
  return json;
}

Json DoorToJson(const DoorAsset& door, const internal::DoorHashes& hashes) {
  Json json = HeadToJson(door);
  json["links"] = Json::array();
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    const DoorLink& link = door.links[i];
    Json geometry = Json::array();
    for (std::size_t k = 0; k < link.geometry.size(); ++k)
      geometry.push_back(GeometryToJson(link.geometry[k], hashes[i].at(k)));
    json["links"].push_back(LinkToJson(link, geometry));
  }
  return json;
}

template <class Enum>
Enum NamedOr(std::optional<Enum> (*find)(std::string_view), const Json& json, const char* key,
             const std::string& path) {
  if (!json.contains(key)) return Enum{};  // version 1 had left and pull alone
  const auto name = ValueOf<std::string>(json, key, path);
  const std::optional<Enum> found = find(name);
  if (!found) throw Error(ErrorCode::kFormat, path + "." + key + ": unknown name \"" + name + '"');
  return *found;
}

void ReadIdentity(const Json& json, const std::string& path, DoorAsset& door) {
  door.id = IdOf(json, "id", path);
  const auto category = CategoryNamed(ValueOf<std::string>(json, "category", path));
  const auto mechanism = MechanismNamed(ValueOf<std::string>(json, "mechanism", path));
  if (!category || !mechanism)
    throw Error(ErrorCode::kFormat, path + ": unknown category or mechanism");
  door.category = *category;
  door.mechanism = *mechanism;
  door.license = ValueOf<std::string>(json, "license", path);
  door.hinge_side = NamedOr(HingeSideNamed, json, "hinge_side", path);
  door.opening = NamedOr(OpeningNamed, json, "opening", path);
  if (json.contains("physics_source"))
    door.physics_source = ValueOf<std::string>(json, "physics_source", path);
  door.body = IdentityFromJson(MemberOf(json, "body", path), path + ".body");
  door.handle = IdentityFromJson(MemberOf(json, "handle", path), path + ".handle");
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

std::string AuthoredMeshPath(const DoorGeometry& geometry) {
  return std::string(internal::kAuthoredFolder) + "/" + geometry.name + ".obj";
}

std::string AuthoredTexturePath(const VisualTexture& texture) {
  return std::string(internal::kAuthoredFolder) + "/" + FileNameOf(texture);
}

void WriteMeshFiles(const DoorAsset& door, const std::filesystem::path& folder) {
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      CommitFile(folder / VisualMeshPath(geometry), ToObj(geometry.mesh));
      for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
        CommitFile(folder / CollisionMeshPath(geometry, i), ToObj(geometry.hulls[i]));
      internal::WriteVisual(geometry.visual, geometry.name, folder);
    }
  }
}

void WriteDoor(const DoorAsset& door, const std::filesystem::path& folder) {
  WriteMeshFiles(door, folder);
  WriteJsonFile(folder / "door.json", DoorToJson(door, HashesOf(door)));
}

namespace {

void RequireDoorRecord(const Json& json, const std::string& path) {
  RequireSchema(json, "doorforge.door", kDoorSchemaVersion, path);
  const Json& links = MemberOf(json, "links", path);
  if (!links.is_array() || links.size() != std::tuple_size_v<decltype(DoorAsset::links)>)
    throw Error(ErrorCode::kFormat, path + ".links: expected base, leaf and handle");
}

}  // namespace

// Own files by path below the folder, pooled ones by hash.
MeshReader internal::DoorMeshReader(const std::filesystem::path& folder, const std::string& path) {
  const MeshReader own = internal::ReaderBelow(folder, path);
  // opened when the first pooled mesh is asked for, and shared by the copies of the function
  const auto pool = std::make_shared<std::optional<MeshPool>>();
  return [folder, path, own, pool](const std::string& relative, const std::string& sha256) {
    // a name that does not follow from its hash is a file of the door's own
    const bool pooled = relative.starts_with(std::string(kMeshPoolPath) + "/") &&
                        relative == PooledMeshPath(sha256);
    if (!pooled) return own(relative, sha256);
    if (!*pool) pool->emplace(folder, path);
    return (*pool)->ReadMesh(sha256);
  };
}

DoorAsset ReadDoor(const std::filesystem::path& folder) {
  return ReadDoor(folder, internal::DoorMeshReader(folder, (folder / "door.json").string()));
}

DoorAsset ReadDoor(const std::filesystem::path& folder, const MeshReader& read_mesh,
                   const VisualReader& read_visual) {
  const std::string path = (folder / "door.json").string();
  return internal::DoorFromRecord(ReadJsonFile(path), folder, read_mesh,
                                  read_visual ? read_visual : DoorVisualReader(folder, path));
}

namespace {

DoorAsset DoorFrom(const Json& json, const DoorSource& source, const Readers& readers,
                   const std::string& path) {
  DoorAsset door;
  ReadIdentity(json, path, door);
  door.latch = internal::LatchFromJson(MemberOf(json, "latch", path), path + ".latch");
  door.hinge = JointFromJson(MemberOf(json, "hinge", path), path + ".hinge");
  door.handle_joint = JointFromJson(MemberOf(json, "handle_joint", path), path + ".handle_joint");
  door.handle_from_grasp = TransformFromJson(MemberOf(json, "handle_from_grasp", path), path);
  door.grasp_half_extent_m = Vector3FromJson(MemberOf(json, "grasp_half_extent_m", path), path);
  for (std::size_t i = 0; i < door.links.size(); ++i)
    door.links[i] = LinkFromJson(json["links"][i], source, readers, path + ".links");
  return door;
}

DoorFiles FilesFrom(const Json& json, const DoorSource& source, const std::string& path) {
  DoorFiles files;
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (const Json& geometry : MemberOf(json["links"][i], "geometry", path + ".links")) {
      const DoorSource::Names names = source.NamesOf(geometry, path + ".links");
      GeometryFiles named{names.mesh.path, {}, names.link_from_files};
      for (const auto& hull : names.hulls) named.hulls.push_back(hull.path);
      named.visual = names.visual;
      files[i].push_back(std::move(named));
    }
  }
  return files;
}

}  // namespace

DoorAsset internal::DoorFromRecord(const Json& json, const std::filesystem::path& folder,
                                   const MeshReader& read_mesh, const VisualReader& read_visual) {
  const std::string path = (folder / "door.json").string();
  RequireDoorRecord(json, path);
  return DoorFrom(json, DoorSource(json, folder, path), {read_mesh, read_visual}, path);
}

DoorWithFiles ReadDoorWithFiles(const Json& record, const std::filesystem::path& folder,
                                const MeshReader& read_mesh, const VisualReader& read_visual) {
  const std::string path = (folder / "door.json").string();
  RequireDoorRecord(record, path);
  const DoorSource source(record, folder, path);
  return {DoorFrom(record, source, {read_mesh, read_visual}, path),
          FilesFrom(record, source, path)};
}

DoorFiles OwnFilesOf(const DoorAsset& door) {
  DoorFiles files;
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (const DoorGeometry& geometry : door.links[i].geometry) {
      GeometryFiles own{VisualMeshPath(geometry), {}};
      for (std::size_t hull = 0; hull < geometry.hulls.size(); ++hull)
        own.hulls.push_back(CollisionMeshPath(geometry, hull));
      if (!geometry.visual.empty())
        own.visual = VisualFilesIn(internal::kAuthoredFolder, geometry.name, geometry.visual);
      files[i].push_back(std::move(own));
    }
  }
  return files;
}

DoorFiles ReadDoorFiles(const std::filesystem::path& folder) {
  const std::string path = (folder / "door.json").string();
  const Json json = ReadJsonFile(path);
  RequireDoorRecord(json, path);
  return FilesFrom(json, DoorSource(json, folder, path), path);
}

std::string PooledDoorText(const DoorAsset& door, const DoorFiles& files,
                           const std::array<std::vector<std::string>, 3>& shapes) {
  Json json = HeadToJson(door);
  json["mesh_pool"] = kMeshPoolPath;
  json["links"] = Json::array();
  for (std::size_t i = 0; i < files.size(); ++i) {
    Json geometry = Json::array();
    for (std::size_t k = 0; k < door.links[i].geometry.size(); ++k)
      geometry.push_back(
          PooledGeometryToJson(door.links[i].geometry[k], files[i].at(k), shapes[i].at(k)));
    json["links"].push_back(LinkToJson(door.links[i], geometry));
  }
  return JsonText(json) + "\n";
}

void RequireSimulatable(const DoorAsset& door, std::string_view user) {
  const auto require = [&](bool holds, const std::string& what, const std::string& instead) {
    if (holds) return;
    throw Error(ErrorCode::kInvalidArgument,
                std::string(user) + ": door \"" + door.id + "\" " + what + "; " + instead);
  };
  require(door.hinge.upper_rad > door.hinge.lower_rad && door.hinge.upper_rad > 0,
          "has no hinge that opens", "set the hinge's limits in door.json");
  const Eigen::Vector3d grasp =
      door.handle_joint.parent_from_child_at_zero * door.handle_from_grasp.translation();
  // where the grasp moves as the door begins to open; x points out of the door
  const double opens = door.hinge.axis.cross(grasp).x();
  require(door.opening == Opening::kPull ? opens > 0 : opens < 0,
          "moves its handle the other way than its opening says",
          "mend hinge.axis or opening in door.json");
  std::set<std::string> names;
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry)
      require(names.insert(geometry.name).second, "has two pieces \"" + geometry.name + '"',
              "remove one of them in door.json, or give it another name");
  }
  const Latch& latch = door.latch;
  if (latch.type == LatchType::kNone) return;
  require(!(latch.relatch && latch.unlocks_ajar), "has a latch with relatch and unlocks_ajar",
          "choose one of the two");
  if (latch.type != LatchType::kBolt) return;
  require(latch.bolt_throw_m > 0 && latch.unlock_angle_rad > 0 &&
              latch.unlock_angle_rad <= door.handle_joint.upper_rad,
          "has a bolt that its handle cannot draw back",
          "give the latch a bolt_throw_m and an unlock_angle_rad within the handle's range");
  // the strike stands beyond the leaf's free edge, which is upright only if the hinge is
  const double outward = door.hinge_side == HingeSide::kLeft ? grasp.y() : -grasp.y();
  require(std::abs(door.hinge.axis.z()) > 0.99 && outward > 0,
          "has a bolt, but not an upright hinge on its hinge_side",
          "compose it with latch: effort");
}

std::string ContentHash(const DoorAsset& door) {
  return internal::ContentHash(door, HashesOf(door));
}

std::string internal::ContentHash(const DoorAsset& door, const DoorHashes& hashes) {
  return Sha256Hex(JsonText(DoorToJson(door, hashes)));
}

std::optional<VisualFiles> internal::AuthoredFilesOf(const std::string& name,
                                                     const VisualMesh& visual) {
  if (visual.empty()) return std::nullopt;
  return VisualFilesIn(kAuthoredFolder, name, visual);
}

}  // namespace doorforge
