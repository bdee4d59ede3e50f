// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "doorforge/core/committed_file.h"

#include "files/mesh_readers.h"
#include "files/picture_files.h"
#include "files/polygon_soup.h"
#include "files/text_lines.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

/// A material as its file states it; its picture is opened where a face needs it.
struct StatedMaterial {
  Eigen::Vector4d color_rgba = ImportedMaterial{}.color_rgba;
  std::string picture;
  int number = -1;  // into ImportedMesh::materials once it is used
};
using Materials = std::map<std::string, StatedMaterial, std::less<>>;

// Options may come before the name of a picture: -blendu on, -mm 0 1, -o 0 0 0, ...
std::string_view PictureName(Words& words) {
  constexpr std::array<std::string_view, 3> kUpToThree{"-o", "-s", "-t"};
  std::string_view rest = words.Rest();
  while (rest.starts_with('-')) {
    const std::string_view option = words.Next();
    const bool numbers =
        std::find(kUpToThree.begin(), kUpToThree.end(), option) != kUpToThree.end();
    int values = option == "-mm" ? 2 : numbers ? 3 : 1;
    for (rest = words.Rest(); values > 0; --values, rest = words.Rest()) {
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
      if (numbers && !NumberOf<double>(word)) break;
      words.Next();
    }
  }
  return rest;
}

/// Reads MTL files. What is not understood in one is noted or passed over, since a mesh without its
/// colours is still a mesh.
class MaterialReader {
 public:
  MaterialReader(const NamedFiles& files, PictureFiles& pictures)
      : files_(files), pictures_(pictures) {}

  void Read(std::string_view name, Materials& materials) {
    name_ = name.substr(0, 200);
    const std::optional<fs::path> path = files_.Find(name);
    std::error_code error;
    if (!path || !fs::is_regular_file(*path, error)) {
      pictures_.Note("materials \"" + name_ + "\" left out: no such file inside the folder");
      return;
    }
    const std::string text = ReadFile(*path, kMaxFileBytes);
    StatedMaterial* material = nullptr;
    Lines lines(text);
    while (const auto line = lines.Next()) {
      Words words(*line);
      const std::string_view key = words.Next();
      if (key == "newmtl")
        material =
            &materials.insert_or_assign(std::string(words.Rest()), StatedMaterial{}).first->second;
      else if (material != nullptr)
        ReadLine(lines, key, words, *material);
    }
  }

 private:
  static constexpr std::uint64_t kMaxFileBytes = 16ULL << 20;

  void ReadLine(const Lines& lines, std::string_view key, Words& words, StatedMaterial& material) {
    if (key == "Kd") ReadColor(lines, words, material.color_rgba);
    if (key == "d") material.color_rgba[3] = Opacity(NumberOf<double>(words.Next()).value_or(1));
    if (key == "Tr")
      material.color_rgba[3] = Opacity(1 - NumberOf<double>(words.Next()).value_or(0));
    if (key == "map_Kd") material.picture = PictureName(words);
  }

  void ReadColor(const Lines& lines, Words& words, Eigen::Vector4d& color) {
    Eigen::Vector3d rgb;
    for (double& channel : rgb) {
      const auto number = NumberOf<double>(words.Next());
      if (!number || !std::isfinite(*number)) {
        pictures_.Note("materials \"" + name_ + "\", line " + std::to_string(lines.number()) +
                       ": Kd needs three numbers, passed over");
        return;
      }
      channel = std::clamp(*number, 0.0, 1.0);
    }
    color.head<3>() = rgb;
  }

  static double Opacity(double stated) {
    const double opacity = std::isfinite(stated) ? std::clamp(stated, 0.0, 1.0) : 1;
    return opacity > 0 ? opacity : 1;
  }

  const NamedFiles& files_;
  PictureFiles& pictures_;
  std::string name_;
};

class ObjReader {
 public:
  ObjReader(const fs::path& path, const MeshImportLimits& limits)
      : files_(path, limits), pictures_(path, limits), soup_(limits) {}

  ImportedMesh Read(std::string text) {
    JoinContinuedLines(text);
    Lines lines(text);
    while (const auto line = lines.Next()) ReadLine(lines, *line);
    ImportedMesh mesh = std::move(soup_).Finish();
    mesh.materials = std::move(used_);
    pictures_.MoveTo(mesh);
    return mesh;
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
    if (key == "vt") ReadTexcoord(words);
    if (key == "f") ReadFace(lines, words);
    if (key == "o" || key == "g") {
      name_ = words.Rest();
      begun_ = false;
    }
    if (key == "usemtl") {
      material_ = words.Rest();
      begun_ = false;
    }
    if (key == "mtllib") MaterialReader(files_, pictures_).Read(words.Rest(), materials_);
  }

  // one that is no number counts, so that those behind it keep their places
  void ReadTexcoord(Words& words) {
    Eigen::Vector2d& texcoord = texcoords_.emplace_back();
    for (double& coordinate : texcoord) coordinate = NumberOf<double>(words.Next()).value_or(0);
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
    corner_texcoords_.clear();
    for (std::string_view word = words.Next(); !word.empty(); word = words.Next()) {
      if (word.starts_with('#')) break;
      corners_.push_back(vertices_[CornerOf(lines, word)]);
      if (const auto at = TexcoordOf(word)) corner_texcoords_.push_back(texcoords_[*at]);
    }
    if (corner_texcoords_.size() != corners_.size()) corner_texcoords_.clear();
    if (!begun_) BeginPiece();
    try {
      soup_.AddPolygon(corners_, corner_texcoords_);
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

  // the number behind the first slash; nothing where there is none, or none in range
  std::optional<std::size_t> TexcoordOf(std::string_view word) const {
    const std::size_t slash = word.find('/');
    if (slash == std::string_view::npos) return std::nullopt;
    word.remove_prefix(slash + 1);
    const auto number = NumberOf<std::int64_t>(word.substr(0, word.find('/')));
    if (!number) return std::nullopt;
    const auto count = static_cast<std::int64_t>(texcoords_.size());
    const std::int64_t index = *number < 0 ? count + *number : *number - 1;
    if (index < 0 || index >= count) return std::nullopt;
    return static_cast<std::size_t>(index);
  }

  void BeginPiece() {
    const auto material = materials_.find(material_);
    if (material == materials_.end()) {
      soup_.BeginPiece(name_, ImportedPiece{}.color_rgba);
    } else {
      const int number = NumberFor(material->first, material->second);
      soup_.BeginPiece(name_, material->second.color_rgba, number);
    }
    begun_ = true;
  }

  int NumberFor(const std::string& name, StatedMaterial& stated) {
    if (stated.number >= 0) return stated.number;
    ImportedMaterial material{name, stated.color_rgba, -1};
    if (!stated.picture.empty()) material.picture = pictures_.Add(stated.picture);
    // a picture in black: some exporters state no colour beside it
    if (material.picture >= 0 && material.color_rgba.head<3>().isZero(0))
      material.color_rgba.head<3>().setOnes();
    stated.number = static_cast<int>(used_.size());
    used_.push_back(std::move(material));
    return stated.number;
  }

  NamedFiles files_;
  PictureFiles pictures_;
  PolygonSoup soup_;
  Materials materials_;
  std::vector<ImportedMaterial> used_;
  std::vector<Eigen::Vector2d> texcoords_;
  std::vector<Eigen::Vector2d> corner_texcoords_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3d> corners_;
  std::string name_;
  std::string material_;
  bool begun_ = false;
};

}  // namespace

ImportedMesh ReadObjFile(const fs::path& path, const MeshImportLimits& limits) {
  return ObjReader(path, limits).Read(ReadFile(path, limits.max_file_bytes));
}

}  // namespace doorforge
