// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_message.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace doorforge {
namespace {

constexpr std::uint64_t kMeshMark = 0x334853454D464F44;    // "DOFMESH3"
constexpr std::uint64_t kErrorMark = 0x31525245'4D464F44;  // "DOFMERR1"

static_assert(sizeof(Eigen::Vector2d) == 16 && sizeof(Eigen::Vector3d) == 24 &&
              sizeof(Eigen::Vector3i) == 12);

template <class Value>
void Put(std::string& message, const Value& value) {
  message.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Element>
void PutArray(std::string& message, const Element* elements, std::size_t count) {
  Put(message, std::uint64_t{count});
  message.append(reinterpret_cast<const char*>(elements), count * sizeof(Element));
}

void PutTexts(std::string& message, const std::vector<std::string>& texts) {
  Put(message, std::uint64_t{texts.size()});
  for (const std::string& text : texts) PutArray(message, text.data(), text.size());
}

// Takes values off the front; `ok` turns false where the message is too short.
class Source {
 public:
  explicit Source(std::string_view message) : rest_(message) {}

  template <class Value>
  Value Take() {
    Value value{};
    TakeBytes(&value, sizeof value);
    return value;
  }

  template <class Container>
  void TakeArray(Container& elements) {
    using Element = typename Container::value_type;
    const auto count = Take<std::uint64_t>();
    if (!ok_ || count > rest_.size() / sizeof(Element)) {
      ok_ = false;
      return;
    }
    elements.resize(count);
    TakeBytes(elements.data(), count * sizeof(Element));
  }

  std::vector<std::string> TakeTexts() {
    std::vector<std::string> texts;
    const auto count = Take<std::uint64_t>();
    for (std::uint64_t i = 0; i < count && ok_; ++i) TakeArray(texts.emplace_back());
    return texts;
  }

  bool ok() const { return ok_; }
  bool AtEnd() const { return ok_ && rest_.empty(); }

 private:
  void TakeBytes(void* into, std::size_t count) {
    ok_ = ok_ && count <= rest_.size();
    if (!ok_ || count == 0) return;
    std::memcpy(into, rest_.data(), count);
    rest_.remove_prefix(count);
  }

  std::string_view rest_;
  bool ok_ = true;
};

bool AllWithinReach(const std::vector<Eigen::Vector3d>& vertices) {
  return std::all_of(vertices.begin(), vertices.end(), [](const Eigen::Vector3d& vertex) {
    return vertex.allFinite() && vertex.cwiseAbs().maxCoeff() <= kLargestRawCoordinate;
  });
}

template <class Element>
bool AllFinite(const std::vector<Element>& elements) {
  return std::all_of(elements.begin(), elements.end(),
                     [](const Element& element) { return element.allFinite(); });
}

bool AllWithin(const std::vector<Eigen::Vector3i>& triangles, std::size_t count) {
  return std::all_of(triangles.begin(), triangles.end(), [&](const Eigen::Vector3i& t) {
    return t.minCoeff() >= 0 && static_cast<std::size_t>(t.maxCoeff()) < count;
  });
}

bool IsColor(const Eigen::Vector4d& rgba) {
  return rgba.allFinite() && rgba.minCoeff() >= 0 && rgba.maxCoeff() <= 1;
}

bool IsNumberOf(int number, std::size_t count) {
  return number >= -1 && number < static_cast<std::int64_t>(count);
}

bool IsSound(const ImportedPiece& piece) {
  const auto& coordinates = piece.texcoord_triangles;
  return !piece.mesh.triangles.empty() && AllWithinReach(piece.mesh.vertices) &&
         AllWithin(piece.mesh.triangles, piece.mesh.vertices.size()) &&
         AllFinite(piece.texcoords) && AllWithin(coordinates, piece.texcoords.size()) &&
         (coordinates.empty() || coordinates.size() == piece.mesh.triangles.size()) &&
         IsColor(piece.color_rgba);
}

bool IsSound(const FileFrame& frame) {
  return frame.up.empty() == frame.front.empty() && std::isfinite(frame.unit_m) && frame.unit_m > 0;
}

bool IsSound(const ImportedMesh& mesh) {
  if (!IsSound(mesh.frame)) return false;
  for (const auto* pieces : {&mesh.pieces, &mesh.other_sides}) {
    for (const ImportedPiece& piece : *pieces) {
      if (!IsSound(piece) || !IsNumberOf(piece.material, mesh.materials.size())) return false;
    }
  }
  for (const ImportedMaterial& material : mesh.materials) {
    if (!IsColor(material.color_rgba) || !IsNumberOf(material.picture, mesh.pictures.size()))
      return false;
  }
  return !mesh.pieces.empty();
}

[[noreturn]] void ThrowSent(Source& source) {
  const auto code = source.Take<std::int32_t>();
  std::string text;
  source.TakeArray(text);
  const bool known =
      source.AtEnd() && code >= 0 && code <= static_cast<int>(ErrorCode::kIncomplete);
  throw Error(known ? static_cast<ErrorCode>(code) : ErrorCode::kFormat, text);
}

}  // namespace

namespace {

void PutPieces(std::string& message, const std::vector<ImportedPiece>& pieces) {
  Put(message, std::uint64_t{pieces.size()});
  for (const ImportedPiece& piece : pieces) {
    PutArray(message, piece.name.data(), piece.name.size());
    PutArray(message, piece.mesh.vertices.data(), piece.mesh.vertices.size());
    PutArray(message, piece.mesh.triangles.data(), piece.mesh.triangles.size());
    Put(message, piece.color_rgba);
    Put(message, piece.material);
    PutArray(message, piece.texcoords.data(), piece.texcoords.size());
    PutArray(message, piece.texcoord_triangles.data(), piece.texcoord_triangles.size());
  }
}

void PutFrame(std::string& message, const FileFrame& frame) {
  PutTexts(message, {frame.up, frame.front});
  Put(message, frame.unit_m);
  Put(message, std::uint8_t{frame.states_unit});
}

FileFrame TakeFrame(Source& source) {
  FileFrame frame;
  std::vector<std::string> axes = source.TakeTexts();
  axes.resize(2);
  frame.up = std::move(axes[0]);
  frame.front = std::move(axes[1]);
  frame.unit_m = source.Take<double>();
  frame.states_unit = source.Take<std::uint8_t>() != 0;
  return frame;
}

std::vector<ImportedPiece> TakePieces(Source& source) {
  std::vector<ImportedPiece> pieces;
  const auto count = source.Take<std::uint64_t>();
  for (std::uint64_t i = 0; i < count && source.ok(); ++i) {
    ImportedPiece& piece = pieces.emplace_back();
    source.TakeArray(piece.name);
    source.TakeArray(piece.mesh.vertices);
    source.TakeArray(piece.mesh.triangles);
    piece.color_rgba = source.Take<Eigen::Vector4d>();
    piece.material = source.Take<int>();
    source.TakeArray(piece.texcoords);
    source.TakeArray(piece.texcoord_triangles);
  }
  return pieces;
}

}  // namespace

std::string Encoded(const ImportedMesh& mesh) {
  std::string message;
  Put(message, kMeshMark);
  PutPieces(message, mesh.pieces);
  PutPieces(message, mesh.other_sides);
  Put(message, std::uint64_t{mesh.materials.size()});
  for (const ImportedMaterial& material : mesh.materials) {
    PutArray(message, material.name.data(), material.name.size());
    Put(message, material.color_rgba);
    Put(message, material.picture);
  }
  PutTexts(message, mesh.pictures);
  PutTexts(message, mesh.notes);
  PutFrame(message, mesh.frame);
  return message;
}

std::string Encoded(const Error& error) {
  const std::string text = error.what();
  std::string message;
  Put(message, kErrorMark);
  Put(message, static_cast<std::int32_t>(error.code()));
  PutArray(message, text.data(), text.size());
  return message;
}

std::optional<ImportedMesh> DecodedMesh(std::string_view message) {
  Source source(message);
  const auto mark = source.Take<std::uint64_t>();
  if (source.ok() && mark == kErrorMark) ThrowSent(source);
  if (!source.ok() || mark != kMeshMark) return std::nullopt;
  ImportedMesh mesh;
  mesh.pieces = TakePieces(source);
  mesh.other_sides = TakePieces(source);
  const auto materials = source.Take<std::uint64_t>();
  for (std::uint64_t i = 0; i < materials && source.ok(); ++i) {
    ImportedMaterial& material = mesh.materials.emplace_back();
    source.TakeArray(material.name);
    material.color_rgba = source.Take<Eigen::Vector4d>();
    material.picture = source.Take<int>();
  }
  mesh.pictures = source.TakeTexts();
  mesh.notes = source.TakeTexts();
  mesh.frame = TakeFrame(source);
  if (!source.AtEnd() || !IsSound(mesh)) return std::nullopt;
  return mesh;
}

}  // namespace doorforge
