// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/read_mesh_process.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "doorforge/core/error.h"

#include "confine.h"
#include "mesh_message.h"
#include "mesh_readers.h"

namespace doorforge {
namespace {

constexpr rlim_t kOpenFiles = 64;  // a mesh, its materials and buffers, one after the other

bool memory_lacked = false;

// The lack is noted, since a library may take the exception for a fault of the file and go on.
void NoteLackOfMemory() {
  memory_lacked = true;
  throw std::bad_alloc();
}

// What the user allows already is never raised, which would be refused.
void Limit(int resource, rlim_t soft, rlim_t hard) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_max = std::min(limit.rlim_max, hard);
  limit.rlim_cur = std::min(limit.rlim_max, soft);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

// Ends with the program that waits for the result: without it nobody would, and a file that is a
// pipe may never end. Where it is gone already, so is the parent.
void EndWith(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(3);
}

// What a file that takes over this process could use is given up before the file is opened.
// Descriptors and environment were left behind by ImportMesh().
void GiveUpRights() {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
#if !defined(__SANITIZE_ADDRESS__)  // its search for leaks looks at the process from outside
  ::prctl(PR_SET_DUMPABLE, 0);
#endif
  Limit(RLIMIT_NOFILE, kOpenFiles, kOpenFiles);
  Limit(RLIMIT_NPROC, 0, 0);  // reading starts neither threads nor programs
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

void LimitProcess([[maybe_unused]] std::uint64_t memory_bytes, std::uint64_t seconds) {
#if !defined(__SANITIZE_ADDRESS__)  // its shadow memory alone takes terabytes of address space
  Limit(RLIMIT_AS, memory_bytes, memory_bytes);
#endif
  std::set_new_handler(NoteLackOfMemory);
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
  EndWith(static_cast<pid_t>(std::strtol(arguments[8], nullptr, 10)));
  GiveUpRights();
  LimitProcess(limits.memory_bytes, number(5));
  Confine(arguments[1], limits);
  if (!Send(MessageFor(arguments[1], limits))) return 3;
  return memory_lacked ? kExitMemoryLacked : 0;
}

}  // namespace doorforge
