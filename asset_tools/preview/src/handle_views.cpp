// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "handle_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "doorforge/sensor/scene_picture.h"

namespace doorforge {
namespace {

constexpr double kStep = 0.01;    // [m] of the bar
constexpr int kSteps = 5;         // in it
constexpr double kThick = 0.003;  // [m] of bar and axes
constexpr double kAxis = 0.025;   // [m] long
constexpr double kRoom = 0.03;    // [m] around the handle
constexpr double kFar = 40;       // distance of the camera over the width of what it sees

/// From where to look: unit vectors.
struct View {
  const char* side;
  const char* caption;
  Eigen::Vector3d forward;
  Eigen::Vector3d up;

  Eigen::Vector3d right() const { return forward.cross(up); }
};

const std::array<View, 3>& Views() {
  static const std::array<View, 3> kViews = {{
      {"front", "handle from the front: y (green) right, z (blue) up; bar 50 mm",
       -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()},
      {"side", "from the side: x (red, out of the door) right, z up", Eigen::Vector3d::UnitY(),
       Eigen::Vector3d::UnitZ()},
      {"above", "from above: y right, x (red, out of the door) down", -Eigen::Vector3d::UnitZ(),
       -Eigen::Vector3d::UnitX()},
  }};
  return kViews;
}

Eigen::AlignedBox3d BoundsOf(const std::vector<VisibleMesh>& meshes) {
  Eigen::AlignedBox3d bounds;
  for (const VisibleMesh& mesh : meshes) {
    for (const Eigen::Vector3d& vertex : mesh.mesh.vertices) bounds.extend(vertex);
  }
  return bounds;
}

using Polygon = std::vector<Eigen::Vector3d>;

// What of a convex polygon has coordinate `axis` times `sign` of at most `most`.
Polygon CutBy(const Polygon& polygon, int axis, double sign, double most) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& at = polygon[i];
    const Eigen::Vector3d& next = polygon[(i + 1) % polygon.size()];
    const double here = sign * at[axis] - most;
    const double there = sign * next[axis] - most;
    if (here <= 0) kept.push_back(at);
    if ((here <= 0) != (there <= 0)) kept.emplace_back(at + here / (here - there) * (next - at));
  }
  return kept;
}

bool IsOnEdge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::AlignedBox3d& box) {
  constexpr double kSame = 1e-9;
  for (const int axis : {1, 2}) {
    for (const double at : {box.min()[axis], box.max()[axis]}) {
      if (std::abs(a[axis] - at) < kSame && std::abs(b[axis] - at) < kSame) return true;
    }
  }
  return false;
}

void AddPolygon(const Polygon& polygon, TriangleMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), polygon.begin(), polygon.end());
  for (int i = 2; i < static_cast<int>(polygon.size()); ++i)
    mesh.triangles.emplace_back(first, first + i - 1, first + i);
}

// A surface that is cut is as thin as paper, and would vanish for who looks along it.
void AddRim(const Polygon& polygon, const Eigen::AlignedBox3d& box, TriangleMesh& mesh) {
  const Eigen::Vector3d normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
  const Eigen::Vector3d inward = -kThick * normal.stableNormalized();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& at = polygon[i];
    const Eigen::Vector3d& next = polygon[(i + 1) % polygon.size()];
    if (IsOnEdge(at, next, box)) AddPolygon({at, next, next + inward, at + inward}, mesh);
  }
}

// The rest of the leaf would hide the handle from the side.
TriangleMesh CutOut(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box) {
  TriangleMesh cut;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Polygon polygon;
    for (const int index : t) polygon.push_back(mesh.vertices[static_cast<std::size_t>(index)]);
    for (const int axis : {1, 2}) {
      polygon = CutBy(polygon, axis, 1, box.max()[axis]);
      polygon = CutBy(polygon, axis, -1, -box.min()[axis]);
    }
    if (polygon.size() < 3) continue;
    AddPolygon(polygon, cut);
    AddRim(polygon, box, cut);
  }
  return cut;
}

void AddBlock(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& color,
              std::vector<VisibleMesh>& meshes) {
  const Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  meshes.push_back({std::move(mesh), 0, PointLabel::kOther, color});
}

void AddBar(const Eigen::Vector3d& at, const View& view, std::vector<VisibleMesh>& meshes) {
  const Eigen::Vector3d thick = kThick * (view.up - view.forward);
  for (int i = 0; i < kSteps; ++i) {
    const double shade = i % 2 == 0 ? 0.02 : 0.85;
    AddBlock(at + i * kStep * view.right(), at + (i + 1) * kStep * view.right() + thick,
             Eigen::Vector3d::Constant(shade), meshes);
  }
}

// Each ends in a knob, so that the one that comes at you can be told from one that goes away.
void AddAxes(const Eigen::Vector3d& at, std::vector<VisibleMesh>& meshes) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d across = Eigen::Vector3d::Ones() - along;
    Eigen::Vector3d color = Eigen::Vector3d::Constant(0.03);
    color[axis] = 0.8;
    AddBlock(at - kThick / 2 * Eigen::Vector3d::Ones(), at + kAxis * along + kThick / 2 * across,
             color, meshes);
    AddBlock(at + kAxis * along - kThick * across,
             at + (kAxis + 2 * kThick) * along + kThick * across, color, meshes);
  }
}

/// What a view shows of the handle: half its size along the view's directions.
struct Frame {
  Eigen::Vector3d middle;
  double right;
  double up;
  double depth;
};

Frame FrameOf(const Eigen::AlignedBox3d& bounds, const View& view) {
  const Eigen::Vector3d half = bounds.sizes() / 2;
  const auto along = [&](const Eigen::Vector3d& direction) {
    return half.dot(direction.cwiseAbs());
  };
  return {bounds.center(), along(view.right()), along(view.up), along(view.forward)};
}

// Right of the middle: beside the handle and beside the bar that begins below its left end.
double PlaceOfAxes(const Frame& frame) {
  return std::max(frame.right + 0.8 * kRoom, kSteps * kStep - frame.right + 0.5 * kRoom);
}

CameraModel CameraFor(const Frame& frame, const View& view, double aspect) {
  // from above the axis out of the door points down
  const double tall = frame.up + kRoom + kAxis + 3 * kThick;
  const double wide = std::max(PlaceOfAxes(frame) + kAxis + 4 * kThick, tall * aspect);
  CameraModel camera;
  camera.target_m = frame.middle;
  camera.position_m = camera.target_m - (kFar * wide + frame.depth) * view.forward;
  camera.up = view.up;
  camera.horizontal_fov_rad = 2 * std::atan(1 / kFar);
  return camera;
}

Picture Draw(const HandleScene& scene, const View& view, int width, int height) {
  const Eigen::AlignedBox3d bounds = BoundsOf(scene.handle);
  Eigen::AlignedBox3d around = bounds;
  around.min().array() -= kRoom;
  around.max().array() += kRoom;
  std::vector<VisibleMesh> meshes = scene.handle;
  for (const VisibleMesh& leaf : scene.leaf) {
    TriangleMesh cut = CutOut(leaf.mesh, around);
    if (!cut.triangles.empty()) meshes.push_back({std::move(cut), 0, leaf.label, leaf.color_rgb});
  }
  const Frame frame = FrameOf(bounds, view);
  const Eigen::Vector3d low =
      frame.middle - (frame.up + 0.7 * kRoom) * view.up - (frame.depth + kRoom) * view.forward;
  AddBar(low - frame.right * view.right(), view, meshes);
  AddAxes(low + PlaceOfAxes(frame) * view.right(), meshes);
  CameraModel camera = CameraFor(frame, view, static_cast<double>(width) / height);
  camera.width = width;
  camera.height = height;
  SceneGeometry geometry(std::move(meshes));
  const RigidTransform here = RigidTransform::Identity();
  geometry.MoveLinks({&here, 1});
  ScenePictureConfig config;
  config.floor = false;
  return RenderPicture(geometry, camera, config);
}

}  // namespace

std::vector<CaptionedPicture> HandleViews(const HandleScene& scene, int width, int height) {
  std::vector<CaptionedPicture> pictures;
  if (BoundsOf(scene.handle).isEmpty()) return pictures;
  for (const View& view : Views())
    pictures.push_back({Draw(scene, view, width, height), view.side, view.caption});
  return pictures;
}

}  // namespace doorforge
