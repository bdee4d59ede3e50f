// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_tree.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <utility>

#include "doorforge/core/error.h"

#include "smooth_normals.h"

namespace doorforge::internal {
namespace {

std::vector<TrianglePlane> PlanesOf(const TriangleMesh& mesh) {
  std::vector<TrianglePlane> planes;
  planes.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
    const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(triangle[1])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(triangle[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    planes.push_back({normal, normal.dot(a)});
  }
  return planes;
}

// One mesh as an Embree scene of its own, to be instanced.
RTCScene BuildTree(RTCDevice device, const TriangleMesh& mesh) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // no rays slip through between triangles
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (const double coordinate : vertex) *vertices++ = static_cast<float>(coordinate);
  }
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangles.size()));
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (const int index : triangle) *indices++ = static_cast<unsigned>(index);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

template <class Element>
bool HaveEqualBytes(const std::vector<Element>& a, const std::vector<Element>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Element)) == 0);
}

}  // namespace

EmbreeDevice::EmbreeDevice(RayIsa isa)
    : handle_(rtcNewDevice(("threads=1,set_affinity=0,isa=" + std::string(NameOf(isa))).c_str())) {
  if (handle_ == nullptr) throw Error(ErrorCode::kIo, "scene geometry: Embree does not start");
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(handle_); }

void EmbreeDevice::ThrowOnError() const {
  const RTCError error = rtcGetDeviceError(handle_);
  if (error != RTC_ERROR_NONE)
    throw Error(ErrorCode::kIo, "scene geometry: Embree error " + std::to_string(error));
}

MeshTree::MeshTree(std::shared_ptr<const EmbreeDevice> device, const TriangleMesh& mesh)
    : device_(std::move(device)), mesh_(mesh), planes_(PlanesOf(mesh)) {
  if (!mesh.triangles.empty()) tree_ = BuildTree(device_->handle(), mesh);
}

MeshTree::~MeshTree() {
  if (tree_ != nullptr) rtcReleaseScene(tree_);
}

const CornerNormals& MeshTree::corner_normals() const {
  constexpr double kCreaseRad = 0.7;
  if (corner_normals_.empty()) corner_normals_ = SmoothNormals(mesh_, kCreaseRad);
  return corner_normals_;
}

bool MeshTree::IsOf(const TriangleMesh& mesh) const {
  return HaveEqualBytes(mesh_.vertices, mesh.vertices) &&
         HaveEqualBytes(mesh_.triangles, mesh.triangles);
}

// A device of its own for each thread: scenes of one device are built one after the other.
MeshTrees& MeshTrees::OfThisThread(RayIsa isa) {
  thread_local std::map<RayIsa, MeshTrees> trees;
  return trees.try_emplace(isa, isa).first->second;
}

MeshTrees::MeshTrees(RayIsa isa) : device_(std::make_shared<const EmbreeDevice>(isa)) {}

std::shared_ptr<const MeshTree> MeshTrees::TreeOf(const TriangleMesh& mesh) {
  const auto found = std::find_if(kept_.rbegin(), kept_.rend(),
                                  [&](const auto& tree) { return tree->IsOf(mesh); });
  if (found != kept_.rend()) {
    std::rotate(found.base() - 1, found.base(), kept_.end());
    return kept_.back();
  }
  kept_.push_back(std::make_shared<const MeshTree>(device_, mesh));
  triangles_ += mesh.triangles.size();
  const auto made = kept_.back();
  Forget();
  return made;
}

void MeshTrees::Forget() {
  auto first = kept_.begin();
  while (first != kept_.end() && (triangles_ > kMostKeptTriangles ||
                                  std::distance(first, kept_.end()) > std::ptrdiff_t{kMostKept})) {
    triangles_ -= (*first)->planes().size();
    ++first;
  }
  kept_.erase(kept_.begin(), first);
}

}  // namespace doorforge::internal
