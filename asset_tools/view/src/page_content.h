// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/visual_mesh.h"

namespace doorforge::internal {

/// What a page shows: a JSON document, and bytes that it names by their place. docs/design/view.md
/// has the layout, web/src/content.js reads it.
class PageContent {
 public:
  using Json = nlohmann::ordered_json;

  Json document = {{"meshes", Json::array()}};

  /// Adds a mesh to the list "meshes" of the document and returns its place there. It is {"at",
  /// "vertices", "triangles", "wide", "least", "step"}: coordinates are whole steps from the least
  /// corner, 65,535 of them along each side of the bounding box, 0.02 mm on a door. A mesh of the
  /// same bytes is kept once.
  std::size_t AddMesh(const TriangleMesh& mesh);

  /// Adds one surface of what an author drew, with "uv" where it has a texture's
  /// coordinates, a pair of floats a corner in the order of the triangles.
  std::size_t AddSurface(const VisualMesh& mesh, const VisualSurface& surface);

  /// Adds bytes and returns {"at", "bytes"}. The same bytes are kept once.
  Json AddBytes(std::string_view bytes);

  /// Four bytes with the length of the document (little endian), the document, padding to four
  /// bytes, the bytes; all of it deflated (zlib, RFC 1950).
  std::string Packed() const;

 private:
  std::size_t Place(const std::string& bytes);
  Json MeshEntry(const TriangleMesh& mesh);
  std::size_t Listed(Json mesh);

  std::string bytes_;
  std::map<std::string, std::size_t> places_;  // by SHA-256
  std::map<std::string, std::size_t> meshes_;  // by text
};

/// RFC 4648, with padding.
std::string Base64(std::string_view bytes);

}  // namespace doorforge::internal
