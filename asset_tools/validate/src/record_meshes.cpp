// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "record_meshes.h"

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/schemas/mesh_pool.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = 1ULL << 30;

bool IsPooled(const std::string& relative) {
  return relative.starts_with(std::string(kMeshPoolPath) + "/") &&
         relative.find("..", 2) == std::string::npos;
}

std::size_t BytesOf(const MeshOnDisk& file) {
  return file.mesh.vertices.size() * sizeof(Eigen::Vector3d) +
         file.mesh.triangles.size() * sizeof(Eigen::Vector3i) + sizeof(MeshOnDisk);
}

}  // namespace

namespace {

bool IsClosed(const TriangleMesh& mesh) {
  const MeshTopology topology = MeasureTopology(mesh);
  return topology.boundary_edges + topology.non_manifold_edges + topology.inconsistent_edges == 0;
}

}  // namespace

LeafLines::LeafLines(const TriangleMesh& leaf)
    : lines(leaf), bounds(BoundsOf(leaf)), closed(IsClosed(leaf)) {}

RecordMeshes::RecordMeshes(fs::path folder, std::string record, ValidationMemory& memory)
    : folder_(std::move(folder)), record_(std::move(record)), memory_(memory) {
  pool_ = (fs::canonical(folder_).parent_path() / fs::path(kMeshPoolPath).filename()).string();
}

MeshReader RecordMeshes::Reader() {
  return [this](const std::string& relative, const std::string& sha256) {
    read_.push_back(Load(relative, sha256));
    return read_.back()->mesh;
  };
}

VisualReader RecordMeshes::Visuals() {
  return [this, read = DoorVisualReader(folder_, record_)](const VisualFiles& files) {
    try {
      return read(files);
    } catch (const Error& error) {
      const std::string problem = error.what();
      const bool leaves = problem.find("leaves the folder") != std::string::npos;
      const bool changed = problem.find(": SHA-256 ") != std::string::npos;
      const char* code = error.code() == ErrorCode::kMissing ? "MSH001"
                         : leaves                            ? "MSH003"
                         : changed                           ? "MSH004"
                                                             : "MSH002";
      visual_findings_.push_back(Found(code, record_ + ": " + files.mesh.path, problem));
      VisualMesh unreadable;
      unreadable.surfaces.push_back({{"unreadable", Eigen::Vector4d::Ones(), nullptr}, {}, {}});
      return unreadable;
    }
  };
}

Findings RecordMeshes::FindingsOfFiles() const {
  Findings all = visual_findings_;
  for (const SharedMesh& file : read_)
    all.insert(all.end(), file->findings.begin(), file->findings.end());
  return all;
}

SharedMesh RecordMeshes::Load(const std::string& relative, const std::string& sha256) {
  const auto load = [&] { return LoadFile(relative, sha256); };
  if (!IsPooled(relative)) return std::make_shared<const MeshOnDisk>(load());
  // door.json alone names a pool, so the messages of a pool's file are the same for all doors
  return memory_.files.Get(pool_ + "/" + relative + "/" + sha256, load, BytesOf);
}

MeshOnDisk RecordMeshes::LoadFile(const std::string& relative, const std::string& sha256) const {
  const std::string where = record_ + ": " + relative;
  MeshOnDisk found;
  try {
    const fs::path file = FileOf(relative, sha256);
    const std::string text = ReadFile(file, kMaxFileBytes);
    found.mesh = ParseObj(text, file.string());
    found.sha256 = Sha256Hex(text);
    // the record has the hash of the canonical text: other spaces are no other mesh
    if (found.sha256 != sha256) found.sha256 = Sha256Hex(ToObj(found.mesh));
    if (found.sha256 != sha256)
      found.findings.push_back(Found("MSH004", where,
                                     "SHA-256 " + found.sha256.substr(0, 12) + "..., recorded " +
                                         sha256.substr(0, 12) + "..."));
    if (found.mesh.triangles.empty())
      found.findings.push_back(Found("MSH002", where, "no triangles"));
  } catch (const Error& error) {
    found.mesh = {};
    found.findings.push_back(Found(CodeOf(relative, error), where, error.what()));
  }
  return found;
}

// in the folder, or in the pool that it shares with its neighbours
fs::path RecordMeshes::FileOf(const std::string& relative, const std::string& sha256) const {
  if (IsPooled(relative)) return MeshPool(folder_, record_).MeshFile(sha256);
  return FileInside(folder_, relative, record_);
}

const char* RecordMeshes::CodeOf(const std::string& relative, const Error& error) const {
  if (error.code() == ErrorCode::kMissing) return "MSH001";
  if (IsPooled(relative)) return "MSH002";
  std::error_code ignored;
  const bool inside = fs::is_regular_file(folder_ / relative, ignored) &&
                      relative.find("..") == std::string::npos &&
                      !fs::path(relative).is_absolute() && !LinksOut(relative);
  return inside ? "MSH002" : "MSH003";
}

bool RecordMeshes::LinksOut(const std::string& relative) const {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(folder_ / relative, ignored);
  const fs::path inside = real.lexically_relative(fs::weakly_canonical(folder_, ignored));
  return inside.empty() || *inside.begin() == "..";
}

}  // namespace doorforge::internal
