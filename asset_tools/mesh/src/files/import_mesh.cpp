// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/import_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <optional>

#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/confined_child.h"
#include "doorforge/core/error.h"

#include "files/memory_share.h"
#include "files/mesh_message.h"
#include "files/position_table.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// What most files need many times over. One that needs more is read again with all the memory, so
// that whether it can be read does not depend on what is read beside it.
constexpr std::uint64_t kFirstShareBytes = 256ULL << 20;

std::string HowItEnded(int status, const MeshImportLimits& limits) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return "reading took longer than the " + std::to_string(std::lround(limits.timeout_s)) +
           " s of processor time allowed";
  if (WIFSIGNALED(status))
    return std::string("the reader crashed on it (") + ::strsignal(WTERMSIG(status)) +
           "); the file is broken, export it again or in another format";
  return "the reader ended with exit code " + std::to_string(WEXITSTATUS(status)) +
         " and no result";
}

// It asked for more memory than it had, whatever came of that: the program says so itself, or it
// crashed where a library does not expect that.
bool MayHaveLackedMemory(int status) {
  if (WIFSIGNALED(status)) return WTERMSIG(status) != SIGXCPU && WTERMSIG(status) != SIGKILL;
  return WEXITSTATUS(status) == kExitMemoryLacked;
}

// Nothing where more memory might help.
std::optional<ImportedMesh> ReadInChild(const fs::path& path, const MeshImportLimits& limits,
                                        bool has_all_memory) {
  const ChildAnswer answer =
      AskChild({SiblingProgram("doorforge-read-mesh", "DOORFORGE_READ_MESH"), path.string(),
                std::to_string(limits.max_file_bytes), std::to_string(limits.max_triangles),
                std::to_string(limits.memory_bytes),
                std::to_string(std::llround(std::ceil(limits.timeout_s))),
                std::to_string(limits.max_picture_bytes), limits.files_below.string(),
                std::to_string(::getpid())},
               {limits.timeout_s, limits.memory_bytes});
  if (answer.too_long && !has_all_memory) return std::nullopt;
  if (answer.too_long)
    throw Error(ErrorCode::kFormat, "its triangles take more than the " +
                                        std::to_string(limits.memory_bytes) + " bytes allowed");
  if (!has_all_memory && MayHaveLackedMemory(answer.status)) return std::nullopt;
  std::optional<ImportedMesh> mesh = DecodedMesh(answer.message);
  if (!mesh) throw Error(ErrorCode::kFormat, HowItEnded(answer.status, limits));
  return mesh;
}

ImportedMesh ReadWithinShare(const fs::path& path, MeshImportLimits limits) {
  const std::uint64_t all = std::min(limits.memory_bytes, MemoryShare::kTotalBytes);
  for (const std::uint64_t wanted : {std::min(all, kFirstShareBytes), all}) {
    const MemoryShare share(wanted);
    limits.memory_bytes = share.bytes();
    if (std::optional<ImportedMesh> mesh = ReadInChild(path, limits, wanted == all))
      return *std::move(mesh);
  }
  throw Error(ErrorCode::kFormat, "the reader ended without a result");
}

void CheckFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw Error(ErrorCode::kMissing, "no such file");
  if (fs::is_directory(status))
    throw Error(ErrorCode::kFormat, "is a folder, expected a mesh file");
  if (!fs::is_regular_file(status))
    throw Error(ErrorCode::kFormat, "is not a regular file, expected a mesh file");
}

void CheckEnding(const fs::path& path) {
  constexpr std::array<std::string_view, 9> kEndings{".obj", ".stl", ".ply", ".dae", ".gltf",
                                                     ".glb", ".fbx", ".3ds", ".off"};
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (std::find(kEndings.begin(), kEndings.end(), ending) == kEndings.end())
    throw Error(
        ErrorCode::kFormat,
        "unknown ending \"" + ending + "\"; allowed .obj .stl .ply .dae .gltf .glb .fbx .3ds .off");
}

}  // namespace

ImportedMesh ImportMesh(const fs::path& path, const MeshImportLimits& limits) {
  Require(limits.max_file_bytes > 0 && limits.max_triangles > 0 && limits.memory_bytes > 0 &&
              limits.timeout_s > 0 && limits.max_picture_bytes > 0,
          ErrorCode::kInvalidArgument, "limits of a mesh import must be positive");
  try {
    CheckFile(path);
    CheckEnding(path);
    return ReadWithinShare(path, limits);
  } catch (const Error& error) {
    const std::string name = path.string();
    const std::string problem = error.what();
    throw Error(error.code(), problem.starts_with(name) ? problem : name + ": " + problem);
  }
}

TriangleMesh MergedPieces(const ImportedMesh& mesh) {
  PositionTable positions;
  TriangleMesh merged;
  for (const ImportedPiece& piece : mesh.pieces) {
    for (const Eigen::Vector3i& t : piece.mesh.triangles) {
      Eigen::Vector3i corner;
      for (int k = 0; k < 3; ++k)
        corner[k] = positions.IndexOf(piece.mesh.vertices[static_cast<std::size_t>(t[k])]);
      merged.triangles.push_back(corner);
    }
  }
  merged.vertices = std::move(positions.positions());
  return merged;
}

}  // namespace doorforge
