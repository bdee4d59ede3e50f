// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/depth_camera.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "doorforge/core/error.h"

#include "embree_scene.h"
#include "pixel_rays.h"

namespace doorforge {
namespace {

constexpr int kTile = 4;   // pixels a side of a packet
constexpr int kRays = 16;  // rays of a packet
constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool SameCamera(const CameraModel& a, const CameraModel& b) {
  return a.position_m == b.position_m && a.target_m == b.target_m && a.up == b.up &&
         a.width == b.width && a.height == b.height && a.horizontal_fov_rad == b.horizontal_fov_rad;
}

// Directions of a packet's rays, and which of them lie in the image.
struct TileRays {
  alignas(64) float x[kRays];
  alignas(64) float y[kRays];
  alignas(64) float z[kRays];
  alignas(64) int valid[kRays];
  std::uint32_t in_image;  // the same as bits
};

TileRays MakeTile(const PixelRays& rays, const CameraModel& camera, int left, int top) {
  TileRays tile{};
  for (int lane = 0; lane < kRays; ++lane) {
    const int column = left + lane % kTile;
    const int row = top + lane / kTile;
    const Eigen::Vector3f direction = rays.Direction(column + 0.5, row + 0.5);
    tile.x[lane] = direction.x();
    tile.y[lane] = direction.y();
    tile.z[lane] = direction.z();
    tile.valid[lane] = column < camera.width && row < camera.height ? -1 : 0;
    if (tile.valid[lane] != 0) tile.in_image |= 1U << static_cast<unsigned>(lane);
  }
  return tile;
}

// A mesh as the camera sees it: what turns a triangle's plane into a depth.
struct MeshView {
  Eigen::Matrix3d world_from_mesh;
  Eigen::Vector3d origin_in_mesh;  // of the camera
  std::int16_t link;
  std::uint8_t label;
};

std::vector<MeshView> ViewsOf(const SceneGeometry::Runtime& scene, const Eigen::Vector3d& origin) {
  std::vector<MeshView> views;
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    const RigidTransform& pose = scene.world_from_mesh()[i];
    views.push_back({pose.linear(), pose.inverse() * origin,
                     static_cast<std::int16_t>(scene.meshes()[i].link),
                     static_cast<std::uint8_t>(scene.meshes()[i].label)});
  }
  return views;
}

// A triangle's plane as the camera sees it: depth = height / normal.dot(direction).
struct SeenPlane {
  unsigned mesh = RTC_INVALID_GEOMETRY_ID;
  unsigned triangle = RTC_INVALID_GEOMETRY_ID;
  Eigen::Vector3d normal_in_world;
  double height;  // of the plane over the camera, along the normal
};

SeenPlane PlaneSeenFrom(const internal::TrianglePlane& plane, const MeshView& view) {
  SeenPlane seen;
  seen.normal_in_world = view.world_from_mesh * plane.normal;
  seen.height = plane.offset - plane.normal.dot(view.origin_in_mesh);
  return seen;
}

// The planes that a packet's rays hit, lane by lane, so that the compiler can take several at once.
struct PlaneLanes {
  alignas(64) std::array<double, kRays> x{};  // normals in the world
  alignas(64) std::array<double, kRays> y{};
  alignas(64) std::array<double, kRays> z{};
  alignas(64) std::array<double, kRays> height{};

  void Set(std::size_t lane, const SeenPlane& plane) {
    x[lane] = plane.normal_in_world.x();
    y[lane] = plane.normal_in_world.y();
    z[lane] = plane.normal_in_world.z();
    height[lane] = plane.height;
  }
};

// Ray parameters at the planes. Embree's own (`ray.tfar`) stands where the ray runs almost within
// the plane, or the triangle has no area.
std::array<float, kRays> DepthsAt(const PlaneLanes& planes, const RTCRay16& ray) {
  std::array<float, kRays> depths;
  for (std::size_t lane = 0; lane < kRays; ++lane) {
    const double slope = planes.x[lane] * static_cast<double>(ray.dir_x[lane]) +
                         (planes.y[lane] * static_cast<double>(ray.dir_y[lane]) +
                          planes.z[lane] * static_cast<double>(ray.dir_z[lane]));
    const double depth = planes.height[lane] / slope;
    const double traced = ray.tfar[lane];
    const bool plausible = std::fabs(depth - traced) <= 1e-4 * traced;
    depths[lane] = static_cast<float>(plausible ? depth : traced);
  }
  return depths;
}

std::uint32_t LanesThatHit(const RTCHit16& hit) {
  std::uint32_t lanes = 0;
  for (std::uint32_t lane = 0; lane < kRays; ++lane)
    lanes |= static_cast<std::uint32_t>(hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) << lane;
  return lanes;
}

class TileRenderer {
 public:
  // `surfaces` receives what lies under the pixels, if it is not null.
  TileRenderer(const SceneGeometry::Runtime& scene, const Eigen::Vector3d& origin,
               DepthImage& image, SurfaceImage* surfaces = nullptr)
      : scene_(scene), views_(ViewsOf(scene, origin)), image_(image), surfaces_(surfaces) {
    rtcInitIntersectContext(&context_);
    context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int lane = 0; lane < kRays; ++lane) {
      packet_.ray.org_x[lane] = static_cast<float>(origin.x());
      packet_.ray.org_y[lane] = static_cast<float>(origin.y());
      packet_.ray.org_z[lane] = static_cast<float>(origin.z());
      packet_.ray.tnear[lane] = 0;
      packet_.ray.time[lane] = 0;
      packet_.ray.mask[lane] = 0xFFFFFFFFU;  // Debian's Embree tests masks; 0 would see nothing
      packet_.ray.id[lane] = 0;
      packet_.ray.flags[lane] = 0;
    }
  }

  void Render(const TileRays& tile, int left, int top) {
    std::copy_n(tile.x, kRays, packet_.ray.dir_x);
    std::copy_n(tile.y, kRays, packet_.ray.dir_y);
    std::copy_n(tile.z, kRays, packet_.ray.dir_z);
    std::fill_n(packet_.ray.tfar, kRays, kInfinity);
    std::fill_n(packet_.hit.geomID, kRays, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet_.hit.instID[0], kRays, RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(tile.valid, scene_.top(), &context_, &packet_);
    // of a packet whose rays run side by side, Embree casts those, too, that are marked as not
    // there
    const std::uint32_t lanes = LanesThatHit(packet_.hit) & tile.in_image;
    const auto width = static_cast<std::size_t>(image_.width);
    if (lanes != 0)
      Store(lanes, static_cast<std::size_t>(top) * width + static_cast<std::size_t>(left));
  }

 private:
  void Store(std::uint32_t lanes, std::size_t corner) {
    // All planes are asked for before the first is used: waiting for them one by one would be most
    // of what a render costs beyond Embree.
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      __builtin_prefetch(&scene_.PlaneOf(packet_.hit.instID[0][lane], packet_.hit.primID[lane]));
    }
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      LookAt(packet_.hit.instID[0][lane], packet_.hit.primID[lane]);
      planes_.Set(lane, plane_);
    }
    const std::array<float, kRays> depths = DepthsAt(planes_, packet_.ray);
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const std::size_t pixel =
          corner + static_cast<std::size_t>(lane / kTile) * static_cast<std::size_t>(image_.width) +
          static_cast<std::size_t>(lane % kTile);
      const MeshView& view = views_[packet_.hit.instID[0][lane]];
      image_.depth_m[pixel] = depths[static_cast<std::size_t>(lane)];
      image_.link[pixel] = view.link;
      image_.label[pixel] = view.label;
      if (surfaces_ != nullptr) StoreSurface(static_cast<std::size_t>(lane), pixel);
    }
  }

  void StoreSurface(std::size_t lane, std::size_t pixel) {
    const Eigen::Vector3d normal(planes_.x[lane], planes_.y[lane], planes_.z[lane]);
    const Eigen::Vector3d direction(static_cast<double>(packet_.ray.dir_x[lane]),
                                    static_cast<double>(packet_.ray.dir_y[lane]),
                                    static_cast<double>(packet_.ray.dir_z[lane]));
    surfaces_->mesh[pixel] = static_cast<std::int16_t>(packet_.hit.instID[0][lane]);
    surfaces_->triangle[pixel] = packet_.hit.primID[lane];
    surfaces_->u[pixel] = packet_.hit.u[lane];
    surfaces_->v[pixel] = packet_.hit.v[lane];
    surfaces_->normal[pixel] = (normal.dot(direction) > 0 ? -normal : normal).cast<float>();
  }

  void LookAt(unsigned mesh, unsigned triangle) {
    if (mesh == plane_.mesh && triangle == plane_.triangle)
      return;  // neighbours often hit the same
    plane_ = PlaneSeenFrom(scene_.PlaneOf(mesh, triangle), views_[mesh]);
    plane_.mesh = mesh;
    plane_.triangle = triangle;
  }

  const SceneGeometry::Runtime& scene_;
  std::vector<MeshView> views_;
  DepthImage& image_;
  SurfaceImage* surfaces_;
  SeenPlane plane_{};  // the last one looked at
  PlaneLanes planes_{};
  RTCIntersectContext context_{};
  RTCRayHit16 packet_{};
};

DepthImage EmptyImage(const CameraModel& camera) {
  DepthImage image;
  image.width = camera.width;
  image.height = camera.height;
  const std::size_t count =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  image.depth_m.assign(count, kInfinity);
  image.link.assign(count, -1);
  image.label.assign(count, static_cast<std::uint8_t>(PointLabel::kOther));
  return image;
}

}  // namespace

struct DepthCamera::RayTable {
  std::optional<CameraModel> camera;
  std::vector<TileRays> tiles;  // row by row

  void Prepare(const CameraModel& wanted) {
    if (camera && SameCamera(*camera, wanted)) return;
    const PixelRays rays(wanted);
    tiles.clear();
    for (int top = 0; top < wanted.height; top += kTile) {
      for (int left = 0; left < wanted.width; left += kTile)
        tiles.push_back(MakeTile(rays, wanted, left, top));
    }
    camera = wanted;
  }

  void RenderWith(TileRenderer& renderer) const {
    std::size_t next = 0;
    for (int top = 0; top < camera->height; top += kTile) {
      for (int left = 0; left < camera->width; left += kTile)
        renderer.Render(tiles[next++], left, top);
    }
  }
};

DepthCamera::DepthCamera(std::vector<VisibleMesh> meshes, RayIsa isa)
    : scene_(std::move(meshes), isa), rays_(std::make_unique<RayTable>()) {}
DepthCamera::~DepthCamera() = default;
DepthCamera::DepthCamera(DepthCamera&&) noexcept = default;
DepthCamera& DepthCamera::operator=(DepthCamera&&) noexcept = default;

void DepthCamera::Prepare(const CameraModel& camera) {
  const bool valid =
      camera.width > 0 && camera.height > 0 && camera.width <= 8192 && camera.height <= 8192;
  Require(valid, ErrorCode::kInvalidArgument, "depth camera: image size out of 1..8192 pixels");
  const double handedness = WorldFromCamera(camera).linear().determinant();
  Require(std::fabs(handedness - 1) < 1e-6 && IntrinsicMatrix(camera).allFinite(),
          ErrorCode::kInvalidArgument,
          "depth camera: position, target, up and field of view give no pose");
  rays_->Prepare(camera);
}

DepthImage DepthCamera::Render(const CameraModel& camera,
                               std::span<const RigidTransform> world_from_link) {
  Prepare(camera);
  DepthImage image = EmptyImage(camera);
  const DenormalsAreZero denormals_are_zero;
  scene_.MoveLinks(world_from_link);
  TileRenderer renderer(scene_.runtime(), PixelRays(camera).origin(), image);
  rays_->RenderWith(renderer);
  return image;
}

SurfaceImage DepthCamera::RenderSurfaces(const CameraModel& camera,
                                         std::span<const RigidTransform> world_from_link) {
  Prepare(camera);
  SurfaceImage surfaces;
  surfaces.depth = EmptyImage(camera);
  const std::size_t count = surfaces.depth.link.size();
  surfaces.mesh.assign(count, -1);
  surfaces.triangle.assign(count, 0);
  surfaces.u.assign(count, 0);
  surfaces.v.assign(count, 0);
  surfaces.normal.assign(count, Eigen::Vector3f::Zero());
  const DenormalsAreZero denormals_are_zero;
  scene_.MoveLinks(world_from_link);
  TileRenderer renderer(scene_.runtime(), PixelRays(camera).origin(), surfaces.depth, &surfaces);
  rays_->RenderWith(renderer);
  return surfaces;
}

}  // namespace doorforge
