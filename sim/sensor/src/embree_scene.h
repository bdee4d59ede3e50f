// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <embree3/rtcore.h>

#include "doorforge/sensor/scene_geometry.h"

#include "mesh_tree.h"

namespace doorforge {

/// Owner of the Embree objects. Instance id = index of the mesh.
class SceneGeometry::Runtime {
 public:
  Runtime(std::vector<VisibleMesh> meshes, RayIsa isa);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  void MoveLinks(std::span<const RigidTransform> world_from_link);

  RTCScene top() const { return top_; }
  RayIsa isa() const { return isa_; }
  int link_count() const { return link_count_; }
  const std::vector<VisibleMesh>& meshes() const { return meshes_; }
  const std::vector<RigidTransform>& world_from_mesh() const { return world_from_mesh_; }
  const internal::TrianglePlane& PlaneOf(std::size_t mesh, std::size_t triangle) const {
    return trees_[mesh]->planes()[triangle];
  }
  const internal::CornerNormals& CornerNormalsOf(std::size_t mesh) const {
    return trees_[mesh]->corner_normals();
  }

 private:
  void AddMesh(unsigned index);

  std::vector<VisibleMesh> meshes_;
  std::vector<RigidTransform> world_from_mesh_;
  std::vector<RTCGeometry> instances_;  // null for a mesh without triangles
  RayIsa isa_;
  int link_count_ = 0;
  std::shared_ptr<const internal::EmbreeDevice> device_;
  std::vector<std::shared_ptr<const internal::MeshTree>> trees_;  // by mesh
  RTCScene top_ = nullptr;
};

/// Makes tiny floats count as zero while it lives, as Embree asks for (manual, 5.1), and restores
/// the thread's setting afterwards.
class DenormalsAreZero {
 public:
  DenormalsAreZero();
  ~DenormalsAreZero();
  DenormalsAreZero(const DenormalsAreZero&) = delete;
  DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

 private:
  unsigned saved_;
};

}  // namespace doorforge
