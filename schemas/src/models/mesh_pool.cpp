// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/mesh_pool.h"

#include <array>
#include <memory>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/mesh_file.h"

#include "models/record_json.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Json;

constexpr const char* kPoolSchema = "doorforge.mesh_pool";
constexpr const char* kShapeSchema = "doorforge.shape";
constexpr std::size_t kDigitsInName = 20;
constexpr std::uint64_t kMaxPooledBytes = 1ULL << 30;

bool IsHash(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string PooledFileName(const std::string& sha256, const std::string& extension) {
  if (!IsHash(sha256))
    throw Error(ErrorCode::kFormat, "\"" + sha256 +
                                        "\" is no SHA-256; a file of the mesh pool is named by 64 "
                                        "lower-case hexadecimal digits, never by a path");
  return sha256.substr(0, kDigitsInName) + extension;
}

std::string PooledMeshPath(const std::string& sha256) {
  return std::string(kMeshPoolPath) + "/" + PooledFileName(sha256, ".obj");
}

VisualFiles PooledVisualFiles(const VisualMesh& mesh) {
  VisualFiles files = VisualFilesIn(kMeshPoolPath, "mesh", mesh);
  files.mesh.path = PooledMeshPath(files.mesh.sha256);
  return files;
}

namespace {

constexpr std::array<const char*, 2> kPictureEndings = {".png", ".jpg"};

RecordedFile Pooled(const std::string& sha256, const std::string& ending) {
  return {std::string(kMeshPoolPath) + "/" + PooledFileName(sha256, ending), sha256};
}

Json VisualToJson(const VisualFiles& visual) {
  Json json = {{"mesh", visual.mesh.sha256}, {"materials", visual.materials.sha256}};
  for (const char* ending : kPictureEndings) json[ending + 1] = Json::array();
  for (const RecordedFile& file : visual.textures)
    json[fs::path(file.path).extension().string().substr(1)].push_back(file.sha256);
  return json;
}

VisualFiles VisualFromJson(const Json& json, const std::string& path) {
  VisualFiles visual;
  visual.mesh = Pooled(ValueOf<std::string>(json, "mesh", path), ".obj");
  visual.materials = Pooled(ValueOf<std::string>(json, "materials", path), ".mtl");
  for (const char* ending : kPictureEndings) {
    for (const Json& file : MemberOf(json, ending + 1, path)) {
      if (!file.is_string()) throw Error(ErrorCode::kFormat, path + ": expected strings");
      visual.textures.push_back(Pooled(file.get<std::string>(), ending));
    }
  }
  return visual;
}

}  // namespace

std::string ShapeText(const PooledShape& shape) {
  Json json = {{"schema", kShapeSchema},
               {"schema_version", kMeshPoolSchemaVersion},
               {"mesh", shape.mesh},
               {"hulls", shape.hulls}};
  if (shape.visual) json["visual"] = VisualToJson(*shape.visual);
  return JsonText(json) + "\n";
}

std::string MeshPoolText() {
  return JsonText(Json{{"schema", kPoolSchema}, {"schema_version", kMeshPoolSchemaVersion}}) + "\n";
}

MeshPool::MeshPool(const fs::path& door_folder, std::string record) : record_(std::move(record)) {
  pool_ = fs::canonical(door_folder).parent_path() / fs::path(kMeshPoolPath).filename();
  if (!fs::is_directory(pool_))
    throw Error(ErrorCode::kMissing, record_ + ": shares meshes with its neighbours, but " +
                                         pool_.string() +
                                         " is missing; move doors together with their pool, or "
                                         "compose with --standalone");
  if (fs::is_symlink(pool_))
    throw Error(ErrorCode::kFormat, pool_.string() + ": is a link; a mesh pool is a real folder");
  const fs::path marker = pool_ / "pool.json";
  RequireSchema(ReadJsonFile(marker), kPoolSchema, kMeshPoolSchemaVersion, marker.string());
}

fs::path MeshPool::FileOf(const std::string& sha256, const std::string& extension) const {
  fs::path file = pool_ / PooledFileName(sha256, extension);
  if (fs::is_symlink(fs::symlink_status(file)))
    throw Error(ErrorCode::kFormat, file.string() + ": is a link; pools hold real files only");
  if (!fs::is_regular_file(file))
    throw Error(ErrorCode::kMissing, file.string() + ": missing; " + record_ + " names it");
  return file;
}

fs::path MeshPool::MeshFile(const std::string& sha256) const { return FileOf(sha256, ".obj"); }

std::string MeshPool::Read(const std::string& sha256, const std::string& extension) const {
  const fs::path file = FileOf(sha256, extension);
  std::string text = ReadFile(file, kMaxPooledBytes);
  const std::string found = Sha256Hex(text);
  if (found != sha256)
    throw Error(ErrorCode::kFormat, file.string() + ": SHA-256 " + found.substr(0, 12) +
                                        "..., recorded " + sha256.substr(0, 12) +
                                        "...; compose the doors again");
  return text;
}

PooledShape MeshPool::ReadShape(const std::string& sha256) const {
  const std::string text = Read(sha256, ".json");
  const std::string path = (pool_ / PooledFileName(sha256, ".json")).string();
  const Json json = ParseJson(text, path);
  RequireSchema(json, kShapeSchema, kMeshPoolSchemaVersion, path);
  PooledShape shape{ValueOf<std::string>(json, "mesh", path), {}};
  for (const Json& hull : MemberOf(json, "hulls", path)) {
    if (!hull.is_string()) throw Error(ErrorCode::kFormat, path + ".hulls: expected strings");
    shape.hulls.push_back(hull.get<std::string>());
  }
  if (json.contains("visual")) shape.visual = VisualFromJson(json["visual"], path + ".visual");
  return shape;
}

TriangleMesh MeshPool::ReadMesh(const std::string& sha256) const {
  return ParseObj(Read(sha256, ".obj"), (pool_ / PooledFileName(sha256, ".obj")).string());
}

std::string MeshPool::ReadRecorded(const RecordedFile& file) const {
  return Read(file.sha256, fs::path(file.path).extension().string());
}

namespace {

// Empty where it is no hash: then it is no file of a pool either.
std::string PooledPathOf(const std::string& sha256) {
  try {
    return PooledMeshPath(sha256);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

VisualReader DoorVisualReader(const fs::path& folder, const std::string& record) {
  const VisualReader own = internal::VisualReaderBelow(folder, record);
  const auto pool = std::make_shared<std::optional<MeshPool>>();
  return [folder, record, own, pool](const VisualFiles& files) {
    if (files.mesh.path != PooledPathOf(files.mesh.sha256)) return own(files);
    if (!*pool) pool->emplace(folder, record);
    return ReadVisualMesh(files,
                          [&](const RecordedFile& file) { return (*pool)->ReadRecorded(file); });
  };
}

}  // namespace doorforge
