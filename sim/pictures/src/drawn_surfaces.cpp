// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "drawn_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "doorforge/sensor/ray_packet.h"

namespace doorforge {
namespace {

constexpr float kNearestDrawn = 0.01F;  // [m] a repaired surface is within millimetres of the drawn

const std::array<float, 256>& LinearLevels() {
  static const std::array<float, 256> kLevels = [] {
    std::array<float, 256> levels{};
    for (std::size_t i = 0; i < levels.size(); ++i)
      levels[i] = LinearOf(Eigen::Vector3d::Constant(static_cast<double>(i) / 255)).x();
    return levels;
  }();
  return kLevels;
}

// The pixel at a place of a texture, which repeats; (0, 0) is its lower left corner.
LinearColor TexelAt(const Picture& texture, const Eigen::Vector2d& place) {
  const auto pixel = [](double share, int size) {
    const double within = share - std::floor(share);
    return std::clamp(static_cast<int>(within * size), 0, size - 1);
  };
  const int column = pixel(place.x(), texture.width);
  const int row = texture.height - 1 - pixel(place.y(), texture.height);
  const std::size_t i =
      3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) +
           static_cast<std::size_t>(column));
  const std::array<float, 256>& levels = LinearLevels();
  return {levels[texture.rgb[i]], levels[texture.rgb[i + 1]], levels[texture.rgb[i + 2]]};
}

}  // namespace

DrawnSurfaces::DrawnSurfaces(const DoorAsset& door) {
  std::vector<VisibleMesh> surfaces;
  std::map<std::string, std::shared_ptr<const Picture>> textures;  // by hash
  std::size_t mesh = 0;
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      const VisualMesh& drawn = geometry.visual;
      const auto places = std::make_shared<const std::vector<Eigen::Vector2d>>(drawn.texcoords);
      for (const VisualSurface& surface : drawn.surfaces) {
        Material material{mesh, LinearOf(surface.material.color_rgba.head<3>()), nullptr,
                          surface.texcoords, places};
        if (surface.material.texture && !surface.texcoords.empty()) {
          const VisualTexture& texture = *surface.material.texture;
          auto& picture = textures[texture.sha256];
          if (!picture)
            picture = std::make_shared<const Picture>(
                DecodePicture(texture.bytes, door.id + ": " + FileNameOf(texture)));
          material.texture = picture;
        }
        materials_.push_back(std::move(material));
        VisibleMesh visible;
        visible.mesh = {drawn.vertices, surface.triangles};
        visible.link = static_cast<int>(mesh);
        surfaces.push_back(std::move(visible));
      }
      ++mesh;
    }
  }
  world_from_mesh_.resize(mesh);
  if (!surfaces.empty()) geometry_.emplace(std::move(surfaces));
}

void DrawnSurfaces::MoveWith(const SceneGeometry& seen) {
  for (std::size_t mesh = 0; mesh < world_from_mesh_.size(); ++mesh)
    world_from_mesh_[mesh] = seen.world_from_mesh(mesh);
  if (geometry_) geometry_->MoveLinks(world_from_mesh_);
}

std::optional<LinearColor> DrawnSurfaces::ColorAt(std::size_t mesh, const Eigen::Vector3f& position,
                                                  const Eigen::Vector3f& normal) {
  RayPacket both;
  both.Set(0, position, normal, kNearestDrawn);
  both.Set(1, position, -normal, kNearestDrawn);
  const PacketHits hits = CastRays(*geometry_, both);
  std::optional<std::size_t> nearest;
  for (std::size_t way = 0; way < 2; ++way) {
    if ((hits.hits >> way & 1U) == 0) continue;
    if (materials_[static_cast<std::size_t>(hits.mesh[way])].mesh != mesh) continue;
    if (!nearest || hits.distance[way] < hits.distance[*nearest]) nearest = way;
  }
  if (!nearest) return std::nullopt;
  return ColorOf(materials_[static_cast<std::size_t>(hits.mesh[*nearest])], hits.triangle[*nearest],
                 {hits.u[*nearest], hits.v[*nearest]});
}

LinearColor DrawnSurfaces::ColorOf(const Material& material, std::size_t triangle,
                                   const Eigen::Vector2f& uv) const {
  if (!material.texture) return material.color;
  const Eigen::Vector3i& corners = material.texcoords[triangle];
  const auto place = [&](int corner) {
    return (*material.places)[static_cast<std::size_t>(corners[corner])];
  };
  const Eigen::Vector2d shares = uv.cast<double>();
  return material.color *
         TexelAt(*material.texture,
                 place(0) * (1 - shares.sum()) + place(1) * shares.x() + place(2) * shares.y());
}

}  // namespace doorforge
