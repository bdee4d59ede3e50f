// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/part.h"

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/record_id.h"
#include "doorforge/schemas/mesh_file.h"

#include "models/record_json.h"

namespace doorforge {
namespace {

using internal::Json;

std::string MeshPath(const PartPiece& piece) { return "meshes/" + piece.name + ".obj"; }

std::string HullPath(const PartPiece& piece, std::size_t index) {
  return "meshes/" + piece.name + "_hull_" + std::to_string(index) + ".obj";
}

Json PieceToJson(const PartPiece& piece) {
  Json hulls = Json::array();
  for (std::size_t i = 0; i < piece.hulls.size(); ++i)
    hulls.push_back(internal::MeshReference(HullPath(piece, i), piece.hulls[i]));
  Json json = {{"name", piece.name},
               {"mesh", internal::MeshReference(MeshPath(piece), piece.mesh)},
               {"hulls", hulls},
               {"color_rgba", internal::ColorToJson(piece.color_rgba)},
               {"mass", internal::MassToJson(piece.mass)}};
  if (!piece.visual.empty())
    json["visual"] =
        internal::VisualToJson(VisualFilesIn(internal::kAuthoredFolder, piece.name, piece.visual));
  return json;
}

PartPiece PieceFromJson(const Json& json, const MeshReader& read_mesh,
                        const VisualReader& read_visual, const std::string& path) {
  PartPiece piece;
  piece.name = IdOf(json, "name", path);
  piece.mesh = internal::ReadReferencedMesh(MemberOf(json, "mesh", path), read_mesh, path);
  for (const Json& hull : MemberOf(json, "hulls", path))
    piece.hulls.push_back(internal::ReadReferencedMesh(hull, read_mesh, path));
  piece.color_rgba = internal::ColorFromJson(MemberOf(json, "color_rgba", path), path);
  piece.mass = internal::MassFromJson(MemberOf(json, "mass", path), path);
  if (json.contains("visual"))
    piece.visual = read_visual(internal::VisualFromJson(json["visual"], path + ".visual"));
  return piece;
}

Json JointToJson(const PartJoint& joint) {
  return {{"origin_m", Vector3ToJson(joint.origin_m)},
          {"axis", Vector3ToJson(joint.axis)},
          {"lower_rad", joint.lower_rad},
          {"upper_rad", joint.upper_rad}};
}

PartJoint PartJointFromJson(const Json& json, const std::string& path) {
  PartJoint joint;
  joint.origin_m = Vector3FromJson(MemberOf(json, "origin_m", path), path + ".origin_m");
  joint.axis = Vector3FromJson(MemberOf(json, "axis", path), path + ".axis");
  joint.lower_rad = ValueOf<double>(json, "lower_rad", path);
  joint.upper_rad = ValueOf<double>(json, "upper_rad", path);
  return joint;
}

Json PartToJson(const Part& part) {
  Json json = {{"schema", "doorforge.part"},
               {"schema_version", kPartSchemaVersion},
               {"id", part.id},
               {"role", NameOf(part.role)},
               {"category", NameOf(part.category)},
               {"mechanism", NameOf(part.mechanism)},
               {"license", part.license},
               {"source", part.source},
               {"source_sha256", part.source_sha256},
               {"joint", JointToJson(part.joint)}};
  if (part.role == PartRole::kBody) {
    json["part_from_mount"] = TransformToJson(part.part_from_mount);
  } else {
    json["part_from_grasp"] = TransformToJson(part.part_from_grasp);
    json["grasp_half_extent_m"] = Vector3ToJson(part.grasp_half_extent_m);
  }
  json["pieces"] = Json::array();
  for (const PartPiece& piece : part.pieces) json["pieces"].push_back(PieceToJson(piece));
  return json;
}

template <class Enum>
Enum Named(std::optional<Enum> (*find)(std::string_view), const Json& json, const char* key,
           const std::string& path) {
  const auto name = ValueOf<std::string>(json, key, path);
  const std::optional<Enum> found = find(name);
  if (!found) throw Error(ErrorCode::kFormat, path + "." + key + ": unknown name \"" + name + '"');
  return *found;
}

}  // namespace

ShapeDescriptor ShapeOf(const Part& part) {
  std::vector<TriangleMesh> meshes;
  for (const PartPiece& piece : part.pieces) {
    // as the file holds them, so that a part that is read back has the same numbers
    meshes.push_back(RoundedToFloat(piece.mesh));
  }
  return DescribeShape(meshes);
}

void WritePart(const Part& part, const std::filesystem::path& folder) {
  for (const PartPiece& piece : part.pieces) {
    CommitFile(folder / MeshPath(piece), ToObj(piece.mesh));
    for (std::size_t i = 0; i < piece.hulls.size(); ++i)
      CommitFile(folder / HullPath(piece, i), ToObj(piece.hulls[i]));
    internal::WriteVisual(piece.visual, piece.name, folder);
  }
  Json json = PartToJson(part);
  json["shape"] = ShapeOf(part);
  WriteJsonFile(folder / "part.json", json);
}

Part ReadPart(const std::filesystem::path& folder) {
  return ReadPart(folder, internal::ReaderBelow(folder, (folder / "part.json").string()));
}

Part ReadPart(const std::filesystem::path& folder, const MeshReader& read_mesh,
              const VisualReader& read_visual) {
  const std::string path = (folder / "part.json").string();
  const VisualReader visual_reader =
      read_visual ? read_visual : internal::VisualReaderBelow(folder, path);
  const Json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.part", kPartSchemaVersion, path);
  Part part;
  part.id = IdOf(json, "id", path);
  part.role = Named(PartRoleNamed, json, "role", path);
  part.category = Named(CategoryNamed, json, "category", path);
  part.mechanism = Named(MechanismNamed, json, "mechanism", path);
  part.license = ValueOf<std::string>(json, "license", path);
  part.source = ValueOf<std::string>(json, "source", path);
  part.source_sha256 = ValueOf<std::string>(json, "source_sha256", path);
  part.joint = PartJointFromJson(MemberOf(json, "joint", path), path + ".joint");
  if (part.role == PartRole::kBody) {
    part.part_from_mount =
        TransformFromJson(MemberOf(json, "part_from_mount", path), path + ".part_from_mount");
  } else {
    part.part_from_grasp =
        TransformFromJson(MemberOf(json, "part_from_grasp", path), path + ".part_from_grasp");
    part.grasp_half_extent_m =
        Vector3FromJson(MemberOf(json, "grasp_half_extent_m", path), path + ".grasp_half_extent_m");
  }
  internal::RequireOwnNames(MemberOf(json, "pieces", path), path + ".pieces");
  for (const Json& piece : json["pieces"])
    part.pieces.push_back(PieceFromJson(piece, read_mesh, visual_reader, path + ".pieces"));
  return part;
}

std::string ContentHash(const Part& part) { return Sha256Hex(JsonText(PartToJson(part))); }

const PartPiece* FindPiece(const Part& part, std::string_view name) {
  for (const PartPiece& piece : part.pieces) {
    if (piece.name == name) return &piece;
  }
  return nullptr;
}

void RequireCategory(const std::string& option, const std::string& word) {
  if (CategoryNamed(word)) return;
  std::string all;
  for (const std::string& name : NamesOf<Category>()) all += (all.empty() ? "" : ", ") + name;
  throw Error(ErrorCode::kInvalidArgument,
              option + ": unknown category \"" + word + "\"; allowed are " + all);
}

}  // namespace doorforge
