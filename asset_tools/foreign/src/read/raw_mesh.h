// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/foreign/articulated_object.h"

// Readers that keep every triangle as the file has it, unlike those of ImportMesh(), which drop
// what repeats: here that is what is looked for.

namespace doorforge::foreign {

/// Why a mesh file cannot be read.
struct RawMeshFault : std::runtime_error {
  RawMeshFault(int at_line, const std::string& problem)
      : std::runtime_error(problem), line(at_line) {}
  int line;  ///< From 1; 0 in binary files.
};

inline constexpr std::size_t kMaxRawTriangles = 5'000'000;

/// Each throws RawMeshFault. Faces of more than three corners become fans.
TriangleMesh ReadRawObj(std::string_view bytes, const std::string& file,
                        std::vector<ForeignFileName>& files);
TriangleMesh ReadRawStl(std::string_view bytes);
TriangleMesh ReadRawPly(std::string_view bytes);
TriangleMesh ReadRawOff(std::string_view bytes);

/// Reads lines and the words in them.
class WordLines {
 public:
  explicit WordLines(std::string_view text) : text_(text) {}

  /// The next line with a word in it, without what follows a `#`; false at the end.
  bool Next();
  /// The next word of the line; empty at its end.
  std::string_view Word();
  std::string_view Rest() const { return rest_; }  ///< It is what is left of the line.
  double Number();
  long Integer();
  int line() const { return line_; }
  std::size_t offset() const { return at_; }  ///< The next line begins there.
  [[noreturn]] void Fail(const std::string& problem) const { throw RawMeshFault(line_, problem); }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::string_view rest_;
  int line_ = 0;
};

/// Adds a fan over the corners.
void AddFace(const std::vector<int>& corners, int line, TriangleMesh& mesh);

}  // namespace doorforge::foreign
