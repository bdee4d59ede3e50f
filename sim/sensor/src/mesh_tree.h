// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <embree3/rtcore.h>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge::internal {

/// Plane of a triangle in its mesh's frame: normal * p = offset. The normal has unit length; it is
/// zero for a triangle without area.
struct alignas(32) TrianglePlane {  // never across two cache lines
  Eigen::Vector3d normal;
  double offset;
};

/// They are those of each triangle's corners, in the mesh's frame.
using CornerNormals = std::vector<std::array<Eigen::Vector3f, 3>>;

/// Embree for one thread and one instruction set.
class EmbreeDevice {
 public:
  explicit EmbreeDevice(RayIsa isa);
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice handle() const { return handle_; }
  /// Throws Error(kIo) if a call of this thread failed since the last call of this.
  void ThrowOnError() const;

 private:
  RTCDevice handle_;
};

/// A mesh prepared for rays. It depends on the mesh alone and never changes, so that all scenes of
/// a device may share it.
class MeshTree {
 public:
  MeshTree(std::shared_ptr<const EmbreeDevice> device, const TriangleMesh& mesh);
  ~MeshTree();
  MeshTree(const MeshTree&) = delete;
  MeshTree& operator=(const MeshTree&) = delete;

  RTCScene tree() const { return tree_; }  ///< To be instanced; null for a mesh without triangles.
  const std::vector<TrianglePlane>& planes() const { return planes_; }
  /// Smoothed across edges flatter than 40 degrees; made when they are first asked for. A tree
  /// belongs to one thread.
  const CornerNormals& corner_normals() const;
  bool IsOf(const TriangleMesh& mesh) const;  ///< Whether that mesh has the same bytes.

 private:
  std::shared_ptr<const EmbreeDevice> device_;
  TriangleMesh mesh_;
  std::vector<TrianglePlane> planes_;
  mutable CornerNormals corner_normals_;
  RTCScene tree_ = nullptr;
};

/// The device and the trees of this thread. Robot and door come back with every camera of an
/// episode, and the robot with every episode: the trees that were used last are kept, as many as
/// have kMostKeptTriangles together, and given again for equal meshes.
class MeshTrees {
 public:
  static constexpr std::size_t kMostKeptTriangles = 100'000;
  static constexpr std::size_t kMostKept = 256;

  static MeshTrees& OfThisThread(RayIsa isa);

  explicit MeshTrees(RayIsa isa);
  std::shared_ptr<const EmbreeDevice> device() const { return device_; }
  /// The mesh's indices must be within its vertices.
  std::shared_ptr<const MeshTree> TreeOf(const TriangleMesh& mesh);

 private:
  void Forget();

  std::shared_ptr<const EmbreeDevice> device_;
  std::vector<std::shared_ptr<const MeshTree>> kept_;  // used last at the end
  std::size_t triangles_ = 0;                          // of those kept
};

}  // namespace doorforge::internal
