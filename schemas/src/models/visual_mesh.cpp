// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/visual_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/schemas/vertex_reach.h"

#include "models/number_text.h"

namespace doorforge {
namespace {

using internal::AppendNumber;
using internal::LineCursor;

constexpr std::size_t kDigitsInTextureName = 20;

const char* EndingOf(TextureFormat format) {
  return format == TextureFormat::kPng ? ".png" : ".jpg";
}

std::string Named(const std::string& sha256, const char* ending) {
  return sha256.substr(0, kDigitsInTextureName) + ending;
}

// Files hold floats; what is hashed and drawn before writing must be what is read afterwards.
double AsFiled(double number) { return RoundedToFloat(number); }

// Other programs end a name at the first blank.
bool IsWord(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(),
                                       [](unsigned char c) { return c <= ' ' || c == 127; });
}

void Check(const VisualMesh& mesh) {
  const auto within = [](const Eigen::Vector3i& t, std::size_t count) {
    return t.minCoeff() >= 0 && static_cast<std::size_t>(t.maxCoeff()) < count;
  };
  std::set<std::string> names;
  for (const VisualSurface& surface : mesh.surfaces) {
    const std::string& name = surface.material.name;
    Require(IsWord(name) && names.insert(name).second, ErrorCode::kInvalidArgument,
            "visual mesh: the material \"" + name +
                "\" needs a name of its own without blanks and control characters");
    Require(surface.texcoords.empty() || surface.texcoords.size() == surface.triangles.size(),
            ErrorCode::kInvalidArgument,
            "visual mesh: some triangles of \"" + name + "\" have texture coordinates, some not");
    for (const Eigen::Vector3i& t : surface.triangles)
      Require(within(t, mesh.vertices.size()), ErrorCode::kInvalidArgument,
              "visual mesh: a triangle of \"" + name + "\" has a vertex out of range");
    for (const Eigen::Vector3i& t : surface.texcoords)
      Require(within(t, mesh.texcoords.size()), ErrorCode::kInvalidArgument,
              "visual mesh: a triangle of \"" + name + "\" has texture coordinates out of range");
  }
}

// The shortest digits that read back as the same float, so that equal meshes have equal files.
template <class Vector>
void AppendVector(const char* key, const Vector& vector, std::string& text) {
  text += key;
  for (const double number : vector) {
    text += ' ';
    AppendNumber(text, static_cast<float>(number));
  }
  text += '\n';
}

std::string MaterialsText(const VisualMesh& mesh) {
  std::string text;
  for (const VisualSurface& surface : mesh.surfaces) {
    const VisualMaterial& material = surface.material;
    text += "newmtl " + material.name + '\n';
    AppendVector("Kd", Eigen::Vector3d(material.color_rgba.head<3>()), text);
    AppendVector("d", Eigen::Matrix<double, 1, 1>(material.color_rgba[3]), text);
    if (material.texture != nullptr) text += "map_Kd " + FileNameOf(*material.texture) + '\n';
  }
  return text;
}

std::string MeshText(const VisualMesh& mesh, const std::string& materials_file) {
  std::string text = "mtllib " + materials_file + '\n';
  // a vertex has about 40 characters, so the text is seldom moved as it grows
  text.reserve(mesh.vertices.size() * 40 + mesh.texcoords.size() * 30);
  for (const Eigen::Vector3d& vertex : mesh.vertices) AppendVector("v", vertex, text);
  for (const Eigen::Vector2d& texcoord : mesh.texcoords) AppendVector("vt", texcoord, text);
  for (const VisualSurface& surface : mesh.surfaces) {
    text += "usemtl " + surface.material.name + '\n';
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      text += 'f';
      for (int k = 0; k < 3; ++k) {
        text += ' ' + std::to_string(surface.triangles[i][k] + 1);
        if (!surface.texcoords.empty()) text += '/' + std::to_string(surface.texcoords[i][k] + 1);
      }
      text += '\n';
    }
  }
  return text;
}

// A text file of ours, line by line; failures name file and line.
class RecordedLines {
 public:
  RecordedLines(std::string name, std::string text)
      : name_(std::move(name)), text_(std::move(text)), rest_(text_) {}

  bool Next() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }

  // People edit files, and their editors end lines in two ways.
  bool IsBlank() const { return line_.empty() || line_.starts_with('#'); }

  /// What follows `key` and a blank, or nothing.
  std::optional<std::string_view> After(std::string_view key) const {
    if (!line_.starts_with(key) || line_.size() <= key.size() || line_[key.size()] != ' ')
      return std::nullopt;
    return line_.substr(key.size() + 1);
  }

  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorCode::kFormat, name_ + ":" + std::to_string(number_) + ": " + problem +
                                        "; make the part or door again");
  }

 private:
  std::string name_;
  std::string text_;
  std::string_view rest_;
  std::string_view line_;
  int number_ = 0;
};

template <int kSize>
Eigen::Matrix<double, kSize, 1> NumbersOf(std::string_view words, const RecordedLines& lines) {
  Eigen::Matrix<double, kSize, 1> numbers;
  LineCursor cursor(words);
  for (double& number : numbers) {
    float read = 0;
    if (!cursor.NextNumber(read) || !std::isfinite(read))
      lines.Fail("expected " + std::to_string(kSize) + " finite numbers");
    number = static_cast<double>(read);
  }
  if (!cursor.AtEnd()) lines.Fail("more than " + std::to_string(kSize) + " numbers");
  return numbers;
}

using MaterialsByName = std::map<std::string, VisualMaterial, std::less<>>;
using Textures = std::map<std::string, std::shared_ptr<const VisualTexture>, std::less<>>;

std::string BaseName(const std::string& path) { return path.substr(path.rfind('/') + 1); }

Textures ReadTextures(const VisualFiles& files, const FileReader& read) {
  Textures textures;
  for (const RecordedFile& file : files.textures) {
    // what is wrong with a picture does not say which picture it was
    try {
      textures[BaseName(file.path)] = MakeVisualTexture(read(file));
    } catch (const Error& error) {
      const std::string problem = error.what();
      const bool named = problem.find(file.path) != std::string::npos;
      throw Error(error.code(), named ? problem : file.path + ": " + problem);
    }
  }
  return textures;
}

Eigen::Vector4d Shares(const Eigen::Vector4d& rgba, const RecordedLines& lines) {
  if (rgba.minCoeff() < 0 || rgba.maxCoeff() > 1) lines.Fail("a share is not within 0 and 1");
  return rgba;
}

MaterialsByName ReadMaterials(const VisualFiles& files, const Textures& textures,
                              const FileReader& read) {
  MaterialsByName materials;
  RecordedLines lines(files.materials.path, read(files.materials));
  VisualMaterial* material = nullptr;
  while (lines.Next()) {
    if (lines.IsBlank()) continue;
    if (const auto name = lines.After("newmtl")) {
      const auto [entry, is_new] = materials.try_emplace(std::string(*name));
      if (!is_new) lines.Fail("material \"" + std::string(*name) + "\" a second time");
      material = &entry->second;
      material->name = *name;
    } else if (material == nullptr) {
      lines.Fail("nothing but newmtl may come first");
    } else if (const auto color = lines.After("Kd")) {
      material->color_rgba.head<3>() = NumbersOf<3>(*color, lines);
    } else if (const auto opacity = lines.After("d")) {
      material->color_rgba[3] = NumbersOf<1>(*opacity, lines)[0];
    } else if (const auto picture = lines.After("map_Kd")) {
      const auto texture = textures.find(*picture);
      if (texture == textures.end())
        lines.Fail("the record names no texture \"" + std::string(*picture) + '"');
      material->texture = texture->second;
    } else {
      lines.Fail("expected newmtl, Kd, d or map_Kd");
    }
    Shares(material->color_rgba, lines);
  }
  return materials;
}

// Reads what MeshText() writes and nothing else of OBJ: anything more was not written by us, and
// passing it over would show another surface than the one that is recorded.
class MeshLines {
 public:
  MeshLines(const VisualFiles& files, const MaterialsByName& materials, const FileReader& read)
      : files_(files), materials_(materials), lines_(files.mesh.path, read(files.mesh)) {}

  VisualMesh Read() {
    while (lines_.Next()) ReadLine();
    if (mesh_.surfaces.empty()) lines_.Fail("has no surface");
    return std::move(mesh_);
  }

 private:
  void ReadLine() {
    if (lines_.IsBlank()) return;
    if (const auto vertex = lines_.After("v")) {
      mesh_.vertices.emplace_back(NumbersOf<3>(*vertex, lines_));
      if (!IsWithinReach(mesh_.vertices.back())) lines_.Fail(BeyondReach(mesh_.vertices.back()));
    } else if (const auto texcoord = lines_.After("vt")) {
      mesh_.texcoords.emplace_back(NumbersOf<2>(*texcoord, lines_));
    } else if (const auto face = lines_.After("f")) {
      ReadFace(*face);
    } else if (const auto name = lines_.After("usemtl")) {
      Begin(std::string(*name));
    } else if (const auto library = lines_.After("mtllib")) {
      if (*library != BaseName(files_.materials.path))
        lines_.Fail("names \"" + std::string(*library) + "\", the record " + files_.materials.path);
    } else {
      lines_.Fail("expected mtllib, v, vt, usemtl or f");
    }
  }

  // A material is a surface, so it comes once; two runs of one would be two surfaces of one name.
  void Begin(const std::string& name) {
    const auto material = materials_.find(name);
    if (material == materials_.end()) lines_.Fail("unknown material \"" + name + '"');
    if (!used_.insert(name).second) lines_.Fail("material \"" + name + "\" a second time");
    mesh_.surfaces.push_back({material->second, {}, {}});
  }

  void ReadFace(std::string_view words) {
    if (mesh_.surfaces.empty()) lines_.Fail("a face without a material");
    Eigen::Vector3i corners;
    Eigen::Vector3i texcoords;
    bool textured = false;
    LineCursor cursor(words);
    for (int k = 0; k < 3; ++k) {
      corners[k] = IndexFrom(cursor, mesh_.vertices.size());
      const bool slash = cursor.Skip('/');
      if (k > 0 && slash != textured) lines_.Fail("texture coordinates for some corners alone");
      textured = slash;
      if (textured) texcoords[k] = IndexFrom(cursor, mesh_.texcoords.size());
    }
    if (!cursor.AtEnd()) lines_.Fail("a face is a triangle");
    VisualSurface& surface = mesh_.surfaces.back();
    if (!surface.triangles.empty() && textured == surface.texcoords.empty())
      lines_.Fail("texture coordinates for some triangles of a material alone");
    surface.triangles.push_back(corners);
    if (textured) surface.texcoords.push_back(texcoords);
  }

  int IndexFrom(LineCursor& cursor, std::size_t count) const {
    int index = 0;
    if (!cursor.NextNumber(index)) lines_.Fail("not a face's corner");
    if (index < 1 || static_cast<std::size_t>(index) > count)
      lines_.Fail("index " + std::to_string(index) + " is out of range, allowed 1.." +
                  std::to_string(count));
    return index - 1;
  }

  const VisualFiles& files_;
  const MaterialsByName& materials_;
  RecordedLines lines_;
  VisualMesh mesh_;
  std::set<std::string> used_;
};

}  // namespace

std::optional<TextureFormat> TextureFormatOf(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return TextureFormat::kPng;
  if (bytes.starts_with("\xff\xd8\xff")) return TextureFormat::kJpeg;
  return std::nullopt;
}

std::shared_ptr<const VisualTexture> MakeVisualTexture(std::string bytes) {
  if (bytes.size() > kMaxTextureBytes)
    throw Error(ErrorCode::kFormat, "a texture of " + std::to_string(bytes.size()) +
                                        " bytes, allowed " + std::to_string(kMaxTextureBytes));
  const std::optional<TextureFormat> format = TextureFormatOf(bytes);
  if (!format) throw Error(ErrorCode::kFormat, "is no PNG and no JPEG file");
  std::string sha256 = Sha256Hex(bytes);
  return std::make_shared<const VisualTexture>(
      VisualTexture{std::move(bytes), std::move(sha256), *format});
}

std::string FileNameOf(const VisualTexture& texture) {
  return Named(texture.sha256, EndingOf(texture.format));
}

VisualMesh PlacedAsFiled(VisualMesh mesh, const RigidTransform& a_from_mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = RoundedToFloat(a_from_mesh * vertex);
  for (Eigen::Vector2d& texcoord : mesh.texcoords) texcoord = texcoord.unaryExpr(&AsFiled);
  for (VisualSurface& surface : mesh.surfaces)
    surface.material.color_rgba = surface.material.color_rgba.unaryExpr(&AsFiled);
  return mesh;
}

VisualTexts ToTexts(const VisualMesh& mesh) {
  Check(mesh);
  VisualTexts texts;
  texts.materials = MaterialsText(mesh);
  texts.mesh = MeshText(mesh, MaterialFileName(texts.materials));
  return texts;
}

std::string MaterialFileName(const std::string& materials_text) {
  return Named(Sha256Hex(materials_text), ".mtl");
}

std::vector<std::shared_ptr<const VisualTexture>> TexturesOf(const VisualMesh& mesh) {
  std::vector<std::shared_ptr<const VisualTexture>> textures;
  for (const VisualSurface& surface : mesh.surfaces) {
    const auto& texture = surface.material.texture;
    const bool known =
        texture == nullptr || std::any_of(textures.begin(), textures.end(), [&](const auto& other) {
          return other->sha256 == texture->sha256;
        });
    if (!known) textures.push_back(texture);
  }
  return textures;
}

VisualFiles VisualFilesIn(const std::string& folder, const std::string& name,
                          const VisualMesh& mesh) {
  const VisualTexts texts = ToTexts(mesh);
  const std::string prefix = folder + "/";
  VisualFiles files;
  files.mesh = {prefix + name + ".obj", Sha256Hex(texts.mesh)};
  files.materials = {prefix + MaterialFileName(texts.materials), Sha256Hex(texts.materials)};
  for (const auto& texture : TexturesOf(mesh))
    files.textures.push_back({prefix + FileNameOf(*texture), texture->sha256});
  return files;
}

VisualMesh ReadVisualMesh(const VisualFiles& files, const FileReader& read) {
  const Textures textures = ReadTextures(files, read);
  const MaterialsByName materials = ReadMaterials(files, textures, read);
  return MeshLines(files, materials, read).Read();
}

}  // namespace doorforge
