// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/scene_geometry.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <immintrin.h>

#include "doorforge/core/error.h"

#include "embree_scene.h"

namespace doorforge {
namespace {

constexpr std::size_t kMostMeshes = 32767;

void CheckMesh(const VisibleMesh& visible, std::size_t index) {
  const std::string where = "visible mesh " + std::to_string(index);
  Require(visible.link >= 0, ErrorCode::kInvalidArgument, where + ": negative link");
  const int count = static_cast<int>(visible.mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : visible.mesh.vertices)
    Require(vertex.allFinite(), ErrorCode::kInvalidArgument, where + ": vertex is not finite");
  for (const Eigen::Vector3i& triangle : visible.mesh.triangles) {
    const bool inside = triangle.minCoeff() >= 0 && triangle.maxCoeff() < count;
    Require(inside, ErrorCode::kInvalidArgument, where + ": triangle index out of range");
  }
}

void SetPose(RTCGeometry instance, const RigidTransform& pose) {
  std::array<float, 12> columns{};
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row)
      columns[3 * static_cast<std::size_t>(column) + static_cast<std::size_t>(row)] =
          static_cast<float>(pose.matrix()(row, column));
  }
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(instance);
}

}  // namespace

bool IsSupported(RayIsa isa) {
  switch (isa) {
    case RayIsa::kSse42:
      return __builtin_cpu_supports("sse4.2") != 0;
    case RayIsa::kAvx2:
      return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    case RayIsa::kAvx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512cd") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0;
  }
  return false;
}

RayIsa DefaultRayIsa() { return IsSupported(RayIsa::kAvx2) ? RayIsa::kAvx2 : RayIsa::kSse42; }

std::string_view NameOf(RayIsa isa) {
  constexpr std::array<std::string_view, 3> kNames = {"sse4.2", "avx2", "avx512"};
  return kNames.at(static_cast<std::size_t>(isa));
}

std::string RayCasterVersion() {
  return "Embree " RTC_VERSION_STRING ", " + std::string(NameOf(DefaultRayIsa()));
}

DenormalsAreZero::DenormalsAreZero() : saved_(_mm_getcsr()) {
  constexpr unsigned kFlushToZero = 0x8000;
  constexpr unsigned kInputsAreZero = 0x0040;
  _mm_setcsr(saved_ | kFlushToZero | kInputsAreZero);
}

DenormalsAreZero::~DenormalsAreZero() { _mm_setcsr(saved_); }

SceneGeometry::Runtime::Runtime(std::vector<VisibleMesh> meshes, RayIsa isa)
    : meshes_(std::move(meshes)),
      world_from_mesh_(meshes_.size(), RigidTransform::Identity()),
      instances_(meshes_.size(), nullptr),
      isa_(isa) {
  Require(meshes_.size() <= kMostMeshes, ErrorCode::kInvalidArgument,
          "scene geometry: " + std::to_string(meshes_.size()) + " meshes, allowed 32767");
  Require(IsSupported(isa), ErrorCode::kInvalidArgument,
          "scene geometry: this processor does not have " + std::string(NameOf(isa)));
  for (std::size_t i = 0; i < meshes_.size(); ++i) CheckMesh(meshes_[i], i);

  internal::MeshTrees& trees = internal::MeshTrees::OfThisThread(isa);
  device_ = trees.device();
  for (const VisibleMesh& visible : meshes_) trees_.push_back(trees.TreeOf(visible.mesh));
  top_ = rtcNewScene(device_->handle());
  rtcSetSceneFlags(top_, RTC_SCENE_FLAG_DYNAMIC);
  for (unsigned i = 0; i < meshes_.size(); ++i) AddMesh(i);
  rtcCommitScene(top_);
  device_->ThrowOnError();
}

SceneGeometry::Runtime::~Runtime() { rtcReleaseScene(top_); }

void SceneGeometry::Runtime::AddMesh(unsigned index) {
  link_count_ = std::max(link_count_, meshes_[index].link + 1);
  const RTCScene tree = trees_[index]->tree();
  if (tree == nullptr) return;
  RTCGeometry instance = rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, tree);
  rtcSetGeometryTimeStepCount(instance, 1);
  SetPose(instance, world_from_mesh_[index]);
  rtcAttachGeometryByID(top_, instance, index);
  instances_[index] = instance;
  rtcReleaseGeometry(instance);  // the top scene keeps it alive
}

void SceneGeometry::Runtime::MoveLinks(std::span<const RigidTransform> world_from_link) {
  Require(std::cmp_greater_equal(world_from_link.size(), link_count_), ErrorCode::kInvalidArgument,
          "scene geometry: " + std::to_string(world_from_link.size()) + " poses for " +
              std::to_string(link_count_) + " links");
  for (const RigidTransform& pose : world_from_link)
    Require(pose.matrix().allFinite(), ErrorCode::kInvalidArgument,
            "scene geometry: a link's pose is not finite");
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    world_from_mesh_[i] = world_from_link[static_cast<std::size_t>(meshes_[i].link)];
    if (instances_[i] != nullptr) SetPose(instances_[i], world_from_mesh_[i]);
  }
  rtcCommitScene(top_);
  device_->ThrowOnError();
}

SceneGeometry::SceneGeometry(std::vector<VisibleMesh> meshes, RayIsa isa)
    : runtime_(std::make_unique<Runtime>(std::move(meshes), isa)) {}
SceneGeometry::~SceneGeometry() = default;
SceneGeometry::SceneGeometry(SceneGeometry&&) noexcept = default;
SceneGeometry& SceneGeometry::operator=(SceneGeometry&&) noexcept = default;

void SceneGeometry::MoveLinks(std::span<const RigidTransform> world_from_link) {
  runtime_->MoveLinks(world_from_link);
}
const std::vector<VisibleMesh>& SceneGeometry::meshes() const { return runtime_->meshes(); }
const RigidTransform& SceneGeometry::world_from_mesh(std::size_t mesh) const {
  return runtime_->world_from_mesh()[mesh];
}
Eigen::Vector3f SceneGeometry::SmoothNormal(std::size_t mesh, std::size_t triangle, float u,
                                            float v) const {
  const auto& corners = runtime_->CornerNormalsOf(mesh)[triangle];
  return ((1 - u - v) * corners[0] + u * corners[1] + v * corners[2]).normalized();
}
int SceneGeometry::link_count() const { return runtime_->link_count(); }
RayIsa SceneGeometry::isa() const { return runtime_->isa(); }

}  // namespace doorforge
