// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/read_mesh_process.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "doorforge/core/confined_child.h"
#include "doorforge/core/error.h"
#include "doorforge/mesh/confine.h"

#include "files/mesh_message.h"
#include "files/mesh_readers.h"

namespace doorforge {
namespace {

bool memory_lacked = false;

// The lack is noted, since a library may take the exception for a fault of the file and go on.
void NoteLackOfMemory() {
  memory_lacked = true;
  throw std::bad_alloc();
}

// Files below the folder of the mesh, or what the caller names in its place, are all that a mesh's
// materials and textures may be.
void Confine([[maybe_unused]] const std::filesystem::path& path,
             [[maybe_unused]] const MeshImportLimits& limits) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they need more of the system
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const std::array readable{path, folder, limits.files_below};
  internal::ConfineToReading(readable);
#endif
}

ImportedMesh Read(const std::filesystem::path& path, const MeshImportLimits& limits) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (std::filesystem::file_size(path) == 0) throw Error(ErrorCode::kFormat, "the file is empty");
  if (ending == ".obj") return ReadObjFile(path, limits);
  if (ending == ".stl") return ReadStlFile(path, limits);
  if (ending == ".ply") return ReadPlyFile(path, limits);
  if (std::filesystem::file_size(path) > limits.max_file_bytes)
    throw Error(ErrorCode::kIo,
                "more than the " + std::to_string(limits.max_file_bytes) + " bytes allowed");
  return ReadWithAssimp(path, limits);
}

std::string OutOfMemory(const MeshImportLimits& limits) {
  std::set_new_handler(nullptr);
  return Encoded(Error(ErrorCode::kFormat, "reading it takes more than the " +
                                               std::to_string(limits.memory_bytes >> 20) +
                                               " MiB of memory allowed"));
}

std::string MessageFor(const std::filesystem::path& path, const MeshImportLimits& limits) {
  try {
    return Encoded(Read(path, limits));
  } catch (const Error& error) {
    // a library calls the lack of memory what it likes
    return memory_lacked ? OutOfMemory(limits) : Encoded(error);
  } catch (const std::bad_alloc&) {
    return OutOfMemory(limits);
  } catch (const std::exception&) {
    return Encoded(Error(ErrorCode::kFormat, "its content does not follow its format"));
  }
}

}  // namespace

int ReadMeshForParent(std::span<char* const> arguments) {
  if (arguments.size() != 9) {
    std::fprintf(stderr, "doorforge-read-mesh is started by the other doorforge programs\n");
    return 2;
  }
  const auto number = [&](std::size_t i) { return std::strtoull(arguments[i], nullptr, 10); };
  MeshImportLimits limits;
  limits.max_file_bytes = number(2);
  limits.max_triangles = number(3);
  limits.memory_bytes = number(4);
  limits.max_picture_bytes = number(6);
  limits.files_below = arguments[7];
  ConfineProcess({limits.memory_bytes, number(5), std::atoi(arguments[8])});
  std::set_new_handler(NoteLackOfMemory);
  Confine(arguments[1], limits);
  if (!SendAnswer(MessageFor(arguments[1], limits))) return 3;
  return memory_lacked ? kExitMemoryLacked : 0;
}

}  // namespace doorforge
