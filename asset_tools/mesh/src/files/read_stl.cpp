// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>
#include <string>

#include "doorforge/core/committed_file.h"

#include "files/mesh_readers.h"
#include "files/polygon_soup.h"
#include "files/text_lines.h"

namespace doorforge {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

std::uint64_t BinarySize(std::string_view content) {
  std::uint32_t facets = 0;
  std::memcpy(&facets, content.data() + kHeaderBytes - sizeof facets, sizeof facets);
  return kHeaderBytes + std::uint64_t{facets} * kFacetBytes;
}

ImportedMesh ReadBinary(std::string_view content, const MeshImportLimits& limits) {
  const std::uint64_t size = BinarySize(content);
  if (size > content.size())
    throw Error(ErrorCode::kFormat, "its header promises " + std::to_string(size) +
                                        " bytes, the file has " + std::to_string(content.size()));
  PolygonSoup soup(limits);
  for (std::size_t at = kHeaderBytes; at < size; at += kFacetBytes) {
    std::array<float, 12> numbers{};  // the normal comes first and is not used
    std::memcpy(numbers.data(), content.data() + at, sizeof numbers);
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = {numbers[3 * k + 3], numbers[3 * k + 4], numbers[3 * k + 5]};
    try {
      soup.AddPolygon(corners);
    } catch (const Error& error) {
      throw Error(error.code(), "byte " + std::to_string(at) + ": " + error.what());
    }
  }
  return std::move(soup).Finish();
}

Eigen::Vector3d VertexOf(const Lines& lines, Words& words) {
  Eigen::Vector3d vertex;
  for (double& coordinate : vertex) {
    const auto number = NumberOf<double>(words.Next());
    if (!number) lines.Fail("a vertex needs three numbers");
    coordinate = *number;
  }
  return vertex;
}

ImportedMesh ReadText(std::string_view content, const MeshImportLimits& limits) {
  PolygonSoup soup(limits);
  Lines lines(content);
  std::vector<Eigen::Vector3d> corners;
  bool in_solid = false;
  while (const auto line = lines.Next()) {
    Words words(*line);
    const std::string_view key = words.Next();
    if (key == "vertex") {
      corners.push_back(VertexOf(lines, words));
    } else if (key == "endloop") {
      if (corners.size() < 3) lines.Fail("a facet needs three vertices");
      soup.AddPolygon(corners);
      corners.clear();
    } else if (key == "solid") {
      soup.BeginPiece(std::string(words.Rest()), ImportedPiece{}.color_rgba);
      in_solid = true;
    } else if (key == "endsolid") {
      in_solid = false;
    } else if (!key.empty() && key != "facet" && key != "outer" && key != "endfacet") {
      lines.Fail("\"" + std::string(key.substr(0, 40)) + "\" is no word of the format");
    }
  }
  if (in_solid) lines.Fail("the file ends before its \"endsolid\"");
  return std::move(soup).Finish();
}

}  // namespace

ImportedMesh ReadStlFile(const std::filesystem::path& path, const MeshImportLimits& limits) {
  const std::string content = ReadFile(path, limits.max_file_bytes);
  // some binary files begin with "solid" too, so the length decides first
  const bool exact = content.size() >= kHeaderBytes && BinarySize(content) == content.size();
  if (!exact && Words(content.substr(0, 80)).Next().starts_with("solid"))
    return ReadText(content, limits);
  if (content.size() < kHeaderBytes)
    throw Error(ErrorCode::kFormat, "neither text that begins with \"solid\" nor binary: " +
                                        std::to_string(content.size()) + " bytes, a header has 84");
  return ReadBinary(content, limits);
}

}  // namespace doorforge
