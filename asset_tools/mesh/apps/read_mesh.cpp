// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// doorforge-read-mesh PATH MAX_FILE_BYTES MAX_TRIANGLES MEMORY_BYTES SECONDS MAX_PICTURE_BYTES
//     FILES_BELOW
//
// Reads one mesh file on behalf of ImportMesh() and writes the result to file descriptor 3. It is
// a program of its own so that a hostile file can neither crash nor hang the caller, and so that
// the caller's threads and locks do not matter.

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <sys/resource.h>
#include <unistd.h>

#include "doorforge/core/error.h"

#include "mesh_message.h"
#include "mesh_readers.h"

namespace doorforge {
namespace {

void Limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit limit{soft, hard};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

void LimitProcess([[maybe_unused]] std::uint64_t memory_bytes, std::uint64_t seconds) {
#if !defined(__SANITIZE_ADDRESS__)  // its shadow memory alone takes terabytes of address space
  Limit(RLIMIT_AS, memory_bytes, memory_bytes);
#endif
  Limit(RLIMIT_CPU, seconds, seconds + 1);
  Limit(RLIMIT_CORE, 0, 0);
  Limit(RLIMIT_FSIZE, 0, 0);
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

std::string MessageFor(const std::filesystem::path& path, const MeshImportLimits& limits) {
  try {
    return Encoded(Read(path, limits));
  } catch (const Error& error) {
    return Encoded(error);
  } catch (const std::bad_alloc&) {
    return Encoded(Error(ErrorCode::kFormat, "reading it takes more than the " +
                                                 std::to_string(limits.memory_bytes >> 20) +
                                                 " MiB of memory allowed"));
  } catch (const std::exception& error) {
    return Encoded(Error(ErrorCode::kFormat, error.what()));
  }
}

bool Send(std::string_view message) {
  while (!message.empty()) {
    const ssize_t written = ::write(3, message.data(), message.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    message.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  using namespace doorforge;  // NOLINT
  if (argc != 8) {
    std::fprintf(stderr, "doorforge-read-mesh is started by the other doorforge programs\n");
    return 2;
  }
  MeshImportLimits limits;
  limits.max_file_bytes = std::strtoull(argv[2], nullptr, 10);
  limits.max_triangles = std::strtoull(argv[3], nullptr, 10);
  limits.memory_bytes = std::strtoull(argv[4], nullptr, 10);
  limits.max_picture_bytes = std::strtoull(argv[6], nullptr, 10);
  limits.files_below = argv[7];
  LimitProcess(limits.memory_bytes, std::strtoull(argv[5], nullptr, 10));
  return Send(MessageFor(argv[1], limits)) ? 0 : 3;
}
