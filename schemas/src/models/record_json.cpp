// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "models/record_json.h"

#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/mesh_file.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = 1ULL << 30;

fs::path PathInside(const std::string& relative, const fs::path& folder, const std::string& path) {
  const fs::path root = fs::weakly_canonical(folder);
  fs::path full = fs::weakly_canonical(root / relative);
  const fs::path inside = full.lexically_relative(root);
  if (fs::path(relative).is_absolute() || inside.empty() || *inside.begin() == "..")
    throw Error(ErrorCode::kFormat, path + ": path \"" + relative +
                                        "\" leaves the folder; only files below " +
                                        folder.string() + " are read");
  return full;
}

// The bytes of a file that a record names, which must be those that were recorded.
std::string ReadRecorded(const RecordedFile& file, const fs::path& folder,
                         const std::string& path) {
  std::string bytes = ReadFile(PathInside(file.path, folder, path), kMaxFileBytes);
  const std::string found = Sha256Hex(bytes);
  if (found != file.sha256)
    throw Error(ErrorCode::kFormat, (folder / file.path).string() + ": SHA-256 " +
                                        found.substr(0, 12) + "..., recorded " +
                                        file.sha256.substr(0, 12) +
                                        "...; the file was changed; make the part or door again");
  return bytes;
}

Json FileToJson(const RecordedFile& file) { return {{"path", file.path}, {"sha256", file.sha256}}; }

RecordedFile FileFromJson(const Json& json, const std::string& path) {
  return {ValueOf<std::string>(json, "path", path), ValueOf<std::string>(json, "sha256", path)};
}

}  // namespace

Json MassToJson(const MassProperties& mass) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  return {{"mass_kg", mass.mass_kg},
          {"center_of_mass_m", Vector3ToJson(mass.center_of_mass_m)},
          {"inertia_xx_yy_zz_kg_m2", Vector3ToJson(i.diagonal())},
          {"inertia_xy_xz_yz_kg_m2", {i(0, 1), i(0, 2), i(1, 2)}}};
}

MassProperties MassFromJson(const Json& json, const std::string& path) {
  MassProperties mass;
  mass.mass_kg = ValueOf<double>(json, "mass_kg", path);
  mass.center_of_mass_m =
      Vector3FromJson(MemberOf(json, "center_of_mass_m", path), path + ".center_of_mass_m");
  mass.inertia_kg_m2.diagonal() =
      Vector3FromJson(MemberOf(json, "inertia_xx_yy_zz_kg_m2", path), path + ".inertia");
  const Eigen::Vector3d off =
      Vector3FromJson(MemberOf(json, "inertia_xy_xz_yz_kg_m2", path), path + ".inertia");
  mass.inertia_kg_m2(0, 1) = mass.inertia_kg_m2(1, 0) = off[0];
  mass.inertia_kg_m2(0, 2) = mass.inertia_kg_m2(2, 0) = off[1];
  mass.inertia_kg_m2(1, 2) = mass.inertia_kg_m2(2, 1) = off[2];
  return mass;
}

Json ColorToJson(const Eigen::Vector4d& rgba) { return {rgba[0], rgba[1], rgba[2], rgba[3]}; }

Eigen::Vector4d ColorFromJson(const Json& json, const std::string& path) {
  if (!json.is_array() || json.size() != 4)
    throw Error(ErrorCode::kFormat, path + ": expected four numbers");
  Eigen::Vector4d rgba;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const Json& channel = json[static_cast<std::size_t>(i)];
    if (!channel.is_number()) throw Error(ErrorCode::kFormat, path + ": expected four numbers");
    rgba[i] = channel.get<double>();
  }
  return rgba;
}

Json MeshReference(const std::string& relative_path, const TriangleMesh& mesh) {
  return {{"path", relative_path}, {"sha256", Sha256Hex(ToObj(mesh))}};
}

TriangleMesh ReadReferencedMesh(const Json& reference, const MeshReader& read_mesh,
                                const std::string& path) {
  return read_mesh(ValueOf<std::string>(reference, "path", path),
                   ValueOf<std::string>(reference, "sha256", path));
}

MeshReader ReaderBelow(const fs::path& folder, const std::string& path) {
  return [folder, path](const std::string& relative, const std::string& sha256) {
    return ParseObj(ReadRecorded({relative, sha256}, folder, path), (folder / relative).string());
  };
}

Json VisualToJson(const VisualFiles& files) {
  Json json = FileToJson(files.mesh);
  json["materials"] = FileToJson(files.materials);
  json["textures"] = Json::array();
  for (const RecordedFile& file : files.textures) json["textures"].push_back(FileToJson(file));
  return json;
}

VisualFiles VisualFromJson(const Json& json, const std::string& path) {
  VisualFiles files;
  files.mesh = FileFromJson(json, path);
  files.materials = FileFromJson(MemberOf(json, "materials", path), path + ".materials");
  for (const Json& texture : MemberOf(json, "textures", path))
    files.textures.push_back(FileFromJson(texture, path + ".textures"));
  return files;
}

void WriteVisual(const VisualMesh& mesh, const std::string& name, const fs::path& folder) {
  if (mesh.empty()) return;
  const VisualTexts texts = ToTexts(mesh);
  const VisualFiles files = VisualFilesIn(kAuthoredFolder, name, mesh);
  CommitFile(folder / files.mesh.path, texts.mesh);
  CommitFile(folder / files.materials.path, texts.materials);
  for (const auto& texture : TexturesOf(mesh))
    CommitFile(folder / kAuthoredFolder / FileNameOf(*texture), texture->bytes);
}

VisualReader VisualReaderBelow(const fs::path& folder, const std::string& path) {
  return [folder, path](const VisualFiles& files) {
    return ReadVisualMesh(
        files, [&](const RecordedFile& file) { return ReadRecorded(file, folder, path); });
  };
}

void RequireOwnNames(const nlohmann::ordered_json& pieces, const std::string& path) {
  std::set<std::string> names;
  for (const nlohmann::ordered_json& piece : pieces) {
    const auto name = ValueOf<std::string>(piece, "name", path);
    if (!names.insert(name).second)
      throw Error(ErrorCode::kFormat, path + ": two pieces are called \"" + name +
                                          "\"; their files have that name, so each has its own");
  }
}

}  // namespace doorforge::internal
