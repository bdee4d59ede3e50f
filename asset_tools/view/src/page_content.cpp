// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "page_content.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>
#include <zlib.h>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/rigid_transform.h"

namespace doorforge::internal {
namespace {

constexpr double kSteps = 65535;  // of a coordinate
constexpr std::size_t kNarrow = 65536;

template <class Number>
void Append(Number number, std::string& bytes) {
  static_assert(std::endian::native == std::endian::little);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof raw);
}

void Pad(std::string& bytes) { bytes.resize((bytes.size() + 3) / 4 * 4, '\0'); }

// Every index of a triangle in as few bytes as will do.
void AppendIndices(const std::vector<Eigen::Vector3i>& triangles, bool wide, std::string& bytes) {
  for (const Eigen::Vector3i& triangle : triangles) {
    for (const int index : triangle) {
      if (wide)
        Append(static_cast<std::uint32_t>(index), bytes);
      else
        Append(static_cast<std::uint16_t>(index), bytes);
    }
  }
}

}  // namespace

std::size_t PageContent::Place(const std::string& bytes) {
  const auto [entry, is_new] = places_.try_emplace(Sha256Hex(bytes), bytes_.size());
  if (is_new) {
    bytes_ += bytes;
    Pad(bytes_);
  }
  return entry->second;
}

std::size_t PageContent::Listed(Json mesh) {
  Json& list = document["meshes"];
  const auto [entry, is_new] = meshes_.try_emplace(JsonText(mesh), list.size());
  if (is_new) list.push_back(std::move(mesh));
  return entry->second;
}

PageContent::Json PageContent::MeshEntry(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  if (mesh.vertices.empty()) bounds = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Eigen::Vector3d step = (bounds.sizes() / kSteps).cwiseMax(1e-12);
  std::string bytes;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3d steps = (vertex - bounds.min()).cwiseQuotient(step);
    for (const double count : steps)
      Append(static_cast<std::uint16_t>(std::clamp(std::round(count), 0.0, kSteps)), bytes);
  }
  Pad(bytes);
  const bool wide = mesh.vertices.size() > kNarrow;
  AppendIndices(mesh.triangles, wide, bytes);
  return {{"at", Place(bytes)},
          {"vertices", mesh.vertices.size()},
          {"triangles", mesh.triangles.size()},
          {"wide", wide},
          {"least", Vector3ToJson(bounds.min())},
          {"step", Vector3ToJson(step)}};
}

std::size_t PageContent::AddMesh(const TriangleMesh& mesh) { return Listed(MeshEntry(mesh)); }

std::size_t PageContent::AddSurface(const VisualMesh& mesh, const VisualSurface& surface) {
  std::vector<int> index_of(mesh.vertices.size(), -1);
  TriangleMesh own;
  own.triangles = surface.triangles;
  for (Eigen::Vector3i& triangle : own.triangles) {
    for (int& corner : triangle) {
      int& index = index_of[static_cast<std::size_t>(corner)];
      if (index < 0) {
        index = static_cast<int>(own.vertices.size());
        own.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
      }
      corner = index;
    }
  }
  Json added = MeshEntry(own);
  if (surface.texcoords.empty()) return Listed(std::move(added));
  std::string bytes;
  for (const Eigen::Vector3i& triangle : surface.texcoords) {
    for (const int index : triangle) {
      const Eigen::Vector2d& at = mesh.texcoords[static_cast<std::size_t>(index)];
      Append(static_cast<float>(at.x()), bytes);
      Append(static_cast<float>(at.y()), bytes);
    }
  }
  added["uv"] = Place(bytes);
  return Listed(std::move(added));
}

PageContent::Json PageContent::AddBytes(std::string_view bytes) {
  return {{"at", Place(std::string(bytes))}, {"bytes", bytes.size()}};
}

std::string PageContent::Packed() const {
  const std::string text = JsonText(document);
  std::string plain;
  plain.reserve(text.size() + bytes_.size() + 8);
  Append(static_cast<std::uint32_t>(text.size()), plain);
  plain += text;
  Pad(plain);
  plain += bytes_;
  uLongf size = compressBound(plain.size());
  std::string packed(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(plain.data()), plain.size(), 9);
  if (result != Z_OK) throw Error(ErrorCode::kIo, "view: the page's content cannot be packed");
  packed.resize(size);
  return packed;
}

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace doorforge::internal
