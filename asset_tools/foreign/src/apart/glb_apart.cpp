// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "apart/glb_apart.h"

#include <algorithm>
#include <csignal>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/confined_child.h"
#include "doorforge/core/error.h"

#include "read/raw_mesh.h"

namespace doorforge::foreign {

TriangleMesh GlbTrianglesApart(const std::filesystem::path& file) {
  const ChildAnswer child =
      AskChild({SiblingProgram("doorforge-read-model", "DOORFORGE_READ_MODEL"),
                std::to_string(::getpid()), "triangles", file.string()},
               {600, 1ULL << 30U});
  GlbAnswer answer;
  MessageReader message(child.message);
  message(answer);
  if (child.too_long || !message.AtEnd() || !HasItsVertices(answer.mesh))
    throw Error(ErrorCode::kFormat, EndOfReader(child.status));
  if (!answer.problem.empty()) throw RawMeshFault(0, answer.problem);
  return std::move(answer.mesh);
}

std::string EndOfReader(int status) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return "reading it took longer than the 60 s of processor time allowed";
  if (WIFSIGNALED(status))
    return std::string("the reader crashed on it (") + ::strsignal(WTERMSIG(status)) + ")";
  return "the reader ended with exit code " + std::to_string(WEXITSTATUS(status)) +
         " and no sound result";
}

bool HasItsVertices(const TriangleMesh& mesh) {
  const auto count = static_cast<int>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Eigen::Vector3i& t) {
    return t.minCoeff() >= 0 && t.maxCoeff() < count;
  });
}

}  // namespace doorforge::foreign
