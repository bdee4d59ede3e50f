// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/core/message.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/parts/model_message.h"

namespace doorforge::foreign {

/// GlbTriangles() of a file, in the program doorforge-read-model. Throws as it does, and
/// Error(kFormat) where the program ends without an answer.
TriangleMesh GlbTrianglesApart(const std::filesystem::path& file);

/// What that program sends.
struct GlbAnswer {
  std::string problem;
  TriangleMesh mesh;
};
template <class Message>
void Exchange(Message& message, GlbAnswer& answer) {
  message(answer.problem, answer.mesh);
}

/// How a process ended that gave no answer; for people.
std::string EndOfReader(int status);

/// Whether each corner of a triangle is a vertex.
bool HasItsVertices(const TriangleMesh& mesh);

}  // namespace doorforge::foreign
