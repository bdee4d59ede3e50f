// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// A mesh that the camera can see, fixed to a link.
struct VisibleMesh {
  TriangleMesh mesh;  ///< In the link's frame. May be open or empty; both sides are seen.
  int link = 0;       ///< Index into the poses given to MoveLinks(), >= 0.
  PointLabel label = PointLabel::kOther;
  Eigen::Vector3d color_rgb{0.7, 0.7, 0.7};  ///< sRGB, each in [0, 1]; for pictures only.
};

/// Vector instructions with which rays are traced.
enum class RayIsa { kSse42, kAvx2, kAvx512 };

/// AVX2 where the processor has it, otherwise SSE 4.2. Not the widest: of two triangles that meet
/// in the edge that a ray passes through, another one may win at another width, and data sets
/// should not depend on the machine. Record it (NameOf) beside what was rendered.
RayIsa DefaultRayIsa();
bool IsSupported(RayIsa isa);
std::string_view NameOf(RayIsa isa);  ///< "sse4.2", "avx2", "avx512".

/// Library, version and default instruction set, such as "Embree 3.13.5, avx2". For provenance.
std::string RayCasterVersion();

/// Meshes prepared for ray casting: one search tree a mesh, shared with the scenes that the thread
/// made before of equal meshes; one instance a mesh, moved with its link. Belongs to one thread at
/// a time; several objects may be used side by side.
class SceneGeometry {
 public:
  /// All links start at the identity pose. Vertices are rounded to float.
  ///
  /// @throws Error(kInvalidArgument) on a vertex that is not finite, a triangle index out of range,
  ///     a negative link, more than 32767 meshes, or an instruction set the processor lacks.
  explicit SceneGeometry(std::vector<VisibleMesh> meshes, RayIsa isa = DefaultRayIsa());
  ~SceneGeometry();
  SceneGeometry(SceneGeometry&&) noexcept;
  SceneGeometry& operator=(SceneGeometry&&) noexcept;

  /// Puts every link where `world_from_link` says and rebuilds only the tree over the instances.
  ///
  /// @throws Error(kInvalidArgument) if there are fewer poses than links, or a pose is not finite.
  void MoveLinks(std::span<const RigidTransform> world_from_link);

  const std::vector<VisibleMesh>& meshes() const;
  const RigidTransform& world_from_mesh(std::size_t mesh) const;
  /// Normal in the mesh's frame at a point of a triangle, smoothed across edges flatter than 40
  /// degrees; unit but for rounding, out of closed meshes. Kept with the mesh's tree.
  ///
  /// @param u,v Barycentric coordinates of the second and the third corner.
  Eigen::Vector3f SmoothNormal(std::size_t mesh, std::size_t triangle, float u, float v) const;
  int link_count() const;  ///< Largest link index + 1.
  RayIsa isa() const;

  class Runtime;  ///< Private to this room's sources.
  Runtime& runtime() { return *runtime_; }

 private:
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace doorforge
