// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "shared_meshes.h"

#include <set>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/schemas/mesh_pool.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

std::set<std::string> ClosedMeshesOf(const DoorFiles& files) {
  std::set<std::string> paths;
  for (const auto& link : files) {
    for (const GeometryFiles& geometry : link) paths.insert(geometry.mesh);
  }
  return paths;
}

}  // namespace

std::shared_ptr<const TriangleMesh> SharedMeshes::Take(const fs::path& folder,
                                                       const std::string& relative,
                                                       const std::string& sha256) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(sha256); found != known_.end()) return found->second;
  }
  const std::string record = (folder / "door.json").string();
  const bool pooled = relative.starts_with(std::string(kMeshPoolPath) + "/");
  auto read =
      std::make_shared<const TriangleMesh>(pooled ? MeshPool(folder, record).ReadMesh(sha256)
                                                  : ReadObj(FileInside(folder, relative, record)));
  if (!pooled && Sha256Hex(ToObj(*read)) != sha256)
    throw Error(ErrorCode::kFormat,
                record + ": " + relative + ": is not the mesh that the record was written with");
  const std::lock_guard lock(mutex_);
  return known_.try_emplace(sha256, std::move(read)).first->second;
}

DoorOfShared SharedMeshes::Read(const fs::path& folder) {
  const DoorFiles files = ReadDoorFiles(folder);
  const std::set<std::string> closed = ClosedMeshesOf(files);
  std::map<std::string, FiledMesh> read;
  DoorOfShared result;
  result.door = ReadDoor(
      folder,
      [&](const std::string& relative, const std::string& sha256) {
        if (!closed.contains(relative)) return TriangleMesh{};
        FiledMesh& filed = read[relative];
        filed = {sha256, Take(folder, relative, sha256)};
        return *filed.mesh;
      },
      [](const VisualFiles&) { return VisualMesh{}; });
  for (const auto& link : files) {
    auto& meshes = result.meshes.emplace_back();
    for (const GeometryFiles& geometry : link) {
      meshes.push_back(read.at(geometry.mesh));
      meshes.back().link_from_mesh = geometry.link_from_files;
    }
  }
  return result;
}

}  // namespace doorforge::internal
