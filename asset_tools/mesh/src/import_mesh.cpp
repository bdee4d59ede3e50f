// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/import_mesh.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

#include "memory_share.h"
#include "mesh_message.h"
#include "position_table.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMessageDescriptor = 3;  // where the reading program writes

// What most files need many times over. One that needs more is read again with all the memory, so
// that whether it can be read does not depend on what is read beside it.
constexpr std::uint64_t kFirstShareBytes = 256ULL << 20;

// What of the environment the reading program sees: where the loader finds shared libraries that
// lie in no usual place, and in a build with sanitizers what configures those. It reads no other
// variable, and what it reads files for may not know the user's.
constexpr std::array<const char*, 4> kKeptVariables {
  "LD_LIBRARY_PATH",
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
      "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"
#endif
};

std::vector<std::string> ReaderEnvironment() {
  std::vector<std::string> environment;
  for (const char* name : kKeptVariables) {
    const char* value = name == nullptr ? nullptr : std::getenv(name);
    if (value != nullptr) environment.push_back(std::string(name) + '=' + value);
  }
  return environment;
}

// For the execution functions of POSIX; the texts must outlive it.
std::vector<char*> PointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

fs::path ReaderProgram() {
  if (const char* program = std::getenv("DOORFORGE_READ_MESH")) return program;
  for (const fs::path& folder : ProgramFolders()) {
    if (fs::exists(folder / "doorforge-read-mesh")) return folder / "doorforge-read-mesh";
  }
  throw Error(ErrorCode::kMissing, (ProgramFolder() / "doorforge-read-mesh").string() +
                                       ": no such program; set DOORFORGE_READ_MESH to its path");
}

// The reading process and the end of its pipe. Whatever happens, it is ended and waited for.
class Reader {
 public:
  explicit Reader(std::vector<std::string> arguments) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
      throw Error(ErrorCode::kIo, std::string("no pipe: ") + std::strerror(errno));
    const int error = Spawn(arguments, ends[1]);
    ::close(ends[1]);
    descriptor_ = ends[0];
    if (error == 0) return;
    ::close(descriptor_);
    throw Error(ErrorCode::kMissing, arguments[0] + ": cannot be started: " + std::strerror(error));
  }

  ~Reader() {
    ::close(descriptor_);
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      Wait();
    }
  }

  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Appends what has arrived. False at the end of the message; throws at the deadline.
  bool ReadMore(std::string& message, Clock::time_point deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd poll_entry{descriptor_, POLLIN, 0};
    const int ready =
        left <= 0 ? 0 : ::poll(&poll_entry, 1, static_cast<int>(std::min<long>(left, 1 << 30)));
    if (ready < 0 && errno == EINTR) return true;
    if (ready == 0) throw Error(ErrorCode::kFormat, "reading took longer than the time allowed");
    std::array<char, 1 << 16> buffer{};
    const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) return true;
    if (count > 0) message.append(buffer.data(), static_cast<std::size_t>(count));
    return count > 0;
  }

  /// Status as of waitpid().
  int Wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status;
  }

 private:
  int Spawn(std::vector<std::string>& arguments, int write_end) {
    std::vector<std::string> variables = ReaderEnvironment();
    const std::vector<char*> argv = PointersTo(arguments);
    const std::vector<char*> environment = PointersTo(variables);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, write_end, kMessageDescriptor);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    // what other code opened without the flag that closes it
    ::posix_spawn_file_actions_addclosefrom_np(&actions, kMessageDescriptor + 1);
    const int error =
        ::posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environment.data());
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) process_ = 0;
    return error;
  }

  pid_t process_ = 0;
  int descriptor_ = -1;
};

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
  Reader reader({ReaderProgram().string(), path.string(), std::to_string(limits.max_file_bytes),
                 std::to_string(limits.max_triangles), std::to_string(limits.memory_bytes),
                 std::to_string(std::llround(std::ceil(limits.timeout_s))),
                 std::to_string(limits.max_picture_bytes), limits.files_below.string(),
                 std::to_string(::getpid())});
  const auto deadline =
      Clock::now() + std::chrono::milliseconds(std::llround(limits.timeout_s * 1000));
  std::string message;
  while (reader.ReadMore(message, deadline)) {
    if (message.size() <= limits.memory_bytes) continue;
    if (!has_all_memory) return std::nullopt;
    throw Error(ErrorCode::kFormat, "its triangles take more than the " +
                                        std::to_string(limits.memory_bytes) + " bytes allowed");
  }
  const int status = reader.Wait();
  if (!has_all_memory && MayHaveLackedMemory(status)) return std::nullopt;
  std::optional<ImportedMesh> mesh = DecodedMesh(message);
  if (!mesh) throw Error(ErrorCode::kFormat, HowItEnded(status, limits));
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
