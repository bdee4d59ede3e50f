// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <embree3/rtcore.h>

#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {

/// Plane of a triangle in its mesh's frame: normal * p = offset. The normal has unit length; it is
/// zero for a triangle without area.
struct alignas(32) TrianglePlane {  // never across two cache lines
  Eigen::Vector3d normal;
  double offset;
};

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
  const TrianglePlane& PlaneOf(std::size_t mesh, std::size_t triangle) const {
    return planes_[mesh][triangle];
  }

 private:
  void AddMesh(unsigned index);
  void ThrowOnDeviceError() const;

  std::vector<VisibleMesh> meshes_;
  std::vector<std::vector<TrianglePlane>> planes_;
  std::vector<RigidTransform> world_from_mesh_;
  std::vector<RTCGeometry> instances_;  // null for a mesh without triangles
  RayIsa isa_;
  int link_count_ = 0;
  RTCDevice device_ = nullptr;
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
