// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "doorforge/schemas/door_asset.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_geometry.h"

#include "finish.h"

namespace doorforge {

/// What the authors of a door's pieces drew, with their materials and textures, behind the closed
/// meshes that the camera sees. Belongs to one thread at a time.
class DrawnSurfaces {
 public:
  /// @throws Error(kFormat) if a texture is none.
  explicit DrawnSurfaces(const DoorAsset& door);

  bool empty() const { return materials_.empty(); }
  /// Puts the surfaces where the meshes of `seen` are, which begin with those of the door in its
  /// links' order, as VisibleMeshesOf().
  void MoveWith(const SceneGeometry& seen);
  /// The colour that was drawn at a point of the closed mesh `mesh`: of the surface that is nearest
  /// along the normal, within a centimetre. Nothing where none is.
  std::optional<LinearColor> ColorAt(std::size_t mesh, const Eigen::Vector3f& position,
                                     const Eigen::Vector3f& normal);

 private:
  struct Material {
    std::size_t mesh;  // the closed one that it belongs to
    LinearColor color;
    std::shared_ptr<const Picture> texture;  // null: none
    std::vector<Eigen::Vector3i> texcoords;  // of the triangles
    std::shared_ptr<const std::vector<Eigen::Vector2d>> places;
  };

  LinearColor ColorOf(const Material& material, std::size_t triangle,
                      const Eigen::Vector2f& uv) const;

  std::vector<Material> materials_;        // by mesh of the geometry
  std::optional<SceneGeometry> geometry_;  // of the drawn surfaces, each a mesh
  std::vector<RigidTransform> world_from_mesh_;
};

}  // namespace doorforge
