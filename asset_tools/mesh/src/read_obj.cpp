// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>

#include "doorforge/core/committed_file.h"

#include "mesh_readers.h"
#include "polygon_soup.h"
#include "text_lines.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

using Colors = std::map<std::string, Eigen::Vector4d, std::less<>>;

// A path below `folder`, or nothing: a mesh may not point at files elsewhere.
std::optional<fs::path> Below(const fs::path& folder, std::string_view name) {
  const fs::path relative = fs::path(name).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..") return std::nullopt;
  return folder / relative;
}

void ReadColor(Words& words, Eigen::Vector4d& color) {
  Eigen::Vector3d rgb;
  for (double& channel : rgb) {
    const auto number = NumberOf<double>(words.Next());
    if (!number || !std::isfinite(*number)) return;
    channel = *number;
  }
  color.head<3>() = rgb;
}

// Diffuse colours of a material file; what is not understood in it is passed over, since a mesh
// without its colours is still a mesh.
void ReadMaterials(const fs::path& path, Colors& colors) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  const std::string text = ReadFile(path, 16ULL << 20);
  Eigen::Vector4d* color = nullptr;
  Lines lines(text);
  while (const auto line = lines.Next()) {
    Words words(*line);
    const std::string_view key = words.Next();
    if (key == "newmtl")
      color = &colors.insert_or_assign(std::string(words.Rest()), ImportedPiece{}.color_rgba)
                   .first->second;
    if (key == "Kd" && color != nullptr) ReadColor(words, *color);
    if (key == "d" && color != nullptr)
      color->w() = std::clamp(NumberOf<double>(words.Next()).value_or(1.0), 0.0, 1.0);
  }
}

class ObjReader {
 public:
  ObjReader(fs::path folder, const MeshImportLimits& limits)
      : folder_(std::move(folder)), soup_(limits) {}

  ImportedMesh Read(std::string text) {
    JoinContinuedLines(text);
    Lines lines(text);
    while (const auto line = lines.Next()) ReadLine(lines, *line);
    return std::move(soup_).Finish();
  }

 private:
  // Blanks instead of a backslash and the line end behind it, which keeps the rest simple.
  static void JoinContinuedLines(std::string& text) {
    for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
      const std::size_t end = at + 1 < text.size() && text[at + 1] == '\r' ? at + 2 : at + 1;
      if (end >= text.size() || text[end] != '\n') continue;
      std::fill(text.begin() + static_cast<std::ptrdiff_t>(at),
                text.begin() + static_cast<std::ptrdiff_t>(end) + 1, ' ');
    }
  }

  void ReadLine(const Lines& lines, std::string_view line) {
    Words words(line);
    const std::string_view key = words.Next();
    if (key == "v") ReadVertex(lines, words);
    if (key == "f") ReadFace(lines, words);
    if (key == "o" || key == "g") {
      name_ = words.Rest();
      begun_ = false;
    }
    if (key == "usemtl") {
      material_ = words.Rest();
      begun_ = false;
    }
    if (key == "mtllib") {
      if (const auto path = Below(folder_, words.Rest())) ReadMaterials(*path, colors_);
    }
  }

  void ReadVertex(const Lines& lines, Words& words) {
    Eigen::Vector3d& vertex = vertices_.emplace_back();
    for (double& coordinate : vertex) {
      const auto number = NumberOf<double>(words.Next());
      if (!number) lines.Fail("a vertex needs three numbers");
      coordinate = *number;
    }
  }

  void ReadFace(const Lines& lines, Words& words) {
    corners_.clear();
    for (std::string_view word = words.Next(); !word.empty(); word = words.Next()) {
      if (word.starts_with('#')) break;
      corners_.push_back(vertices_[CornerOf(lines, word)]);
    }
    if (!begun_) BeginPiece();
    try {
      soup_.AddPolygon(corners_);
    } catch (const Error& error) {
      lines.Fail(error.what());
    }
  }

  std::size_t CornerOf(const Lines& lines, std::string_view word) const {
    const auto count = static_cast<std::int64_t>(vertices_.size());
    const auto number = NumberOf<std::int64_t>(word.substr(0, word.find('/')));
    if (!number) lines.Fail("\"" + std::string(word.substr(0, 40)) + "\" is not a face's corner");
    // negative numbers count back from the last vertex so far
    const std::int64_t index = *number < 0 ? count + *number : *number - 1;
    if (index < 0 || index >= count)
      lines.Fail("a face names vertex " + std::to_string(*number) + ", allowed 1.." +
                 std::to_string(count));
    return static_cast<std::size_t>(index);
  }

  void BeginPiece() {
    const auto color = colors_.find(material_);
    soup_.BeginPiece(name_, color != colors_.end() ? color->second : ImportedPiece{}.color_rgba);
    begun_ = true;
  }

  fs::path folder_;
  PolygonSoup soup_;
  Colors colors_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3d> corners_;
  std::string name_;
  std::string material_;
  bool begun_ = false;
};

}  // namespace

ImportedMesh ReadObjFile(const fs::path& path, const MeshImportLimits& limits) {
  return ObjReader(path.parent_path(), limits).Read(ReadFile(path, limits.max_file_bytes));
}

}  // namespace doorforge
