// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_message.h"

#include <cstring>

namespace doorforge {
namespace {

constexpr std::uint64_t kMeshMark = 0x314853454D464F44;    // "DOFMESH1"
constexpr std::uint64_t kErrorMark = 0x31525245'4D464F44;  // "DOFMERR1"

static_assert(sizeof(Eigen::Vector3d) == 24 && sizeof(Eigen::Vector3i) == 12);

template <class Value>
void Put(std::string& message, const Value& value) {
  message.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Element>
void PutArray(std::string& message, const Element* elements, std::size_t count) {
  Put(message, std::uint64_t{count});
  message.append(reinterpret_cast<const char*>(elements), count * sizeof(Element));
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

bool IsSound(const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if (!vertex.allFinite()) return false;
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<int>(mesh.vertices.size())) return false;
  }
  return !mesh.triangles.empty();
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

std::string Encoded(const ImportedMesh& mesh) {
  std::string message;
  Put(message, kMeshMark);
  Put(message, std::uint64_t{mesh.pieces.size()});
  for (const ImportedPiece& piece : mesh.pieces) {
    PutArray(message, piece.name.data(), piece.name.size());
    PutArray(message, piece.mesh.vertices.data(), piece.mesh.vertices.size());
    PutArray(message, piece.mesh.triangles.data(), piece.mesh.triangles.size());
    Put(message, piece.color_rgba);
  }
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
  const auto count = source.Take<std::uint64_t>();
  ImportedMesh mesh;
  for (std::uint64_t i = 0; i < count && source.ok(); ++i) {
    ImportedPiece& piece = mesh.pieces.emplace_back();
    source.TakeArray(piece.name);
    source.TakeArray(piece.mesh.vertices);
    source.TakeArray(piece.mesh.triangles);
    piece.color_rgba = source.Take<Eigen::Vector4d>();
    if (!IsSound(piece.mesh)) return std::nullopt;
  }
  if (!source.AtEnd() || mesh.pieces.empty()) return std::nullopt;
  return mesh;
}

}  // namespace doorforge
