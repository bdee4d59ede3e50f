// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/scene_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "doorforge/core/error.h"

#include "embree_scene.h"
#include "pixel_rays.h"
#include "smooth_normals.h"

namespace doorforge {
namespace {

constexpr int kRaysOfPacket = 16;  // 2 x 2 pixels of 2 x 2 samples
constexpr float kPi = 3.14159265F;
constexpr float kCrease = 0.7F;
constexpr float kSkyReach = 3.0F;  // what is farther away does not darken [m]

using Color = Eigen::Array3f;  // linear light

// The studio: a warm sun over the left shoulder of who opens the door, a cool sky, a pale floor.
const Eigen::Vector3f kSunDirection = Eigen::Vector3f(0.62F, -0.42F, 0.85F).normalized();
const Color kSun = Color(1.0F, 0.96F, 0.88F) * 1.45F;
const Color kZenith = Color(0.62F, 0.74F, 0.95F) * 1.15F;
const Color kHorizon = Color(0.95F, 0.96F, 1.0F) * 0.95F;
const Color kFloorBounce = Color(0.95F, 0.92F, 0.88F) * 0.38F;
const Color kBackdropTop{0.56F, 0.63F, 0.72F};
const Color kBackdropBottom{0.88F, 0.89F, 0.90F};
constexpr float kSunSoftness = 0.03F;  // tangent of half the angle that penumbras span
constexpr float kGoldenTurn = 2 * kPi * 0.618034F;

Color ToLinear(const Eigen::Vector3d& srgb) {
  Color linear;
  for (int i = 0; i < 3; ++i) {
    const auto c = static_cast<float>(std::clamp(srgb[i], 0.0, 1.0));
    linear[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
  }
  return linear;
}

std::uint8_t ToSrgb(float linear) {
  const float c = std::clamp(linear, 0.0F, 1.0F);
  const float srgb = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

// Light above 0.75 is compressed towards 1 instead of being cut off.
Color CompressHighlights(const Color& light) {
  constexpr float kKnee = 0.75F;
  const Color excess = (light - kKnee).max(0.0F) / (1 - kKnee);
  return light.min(kKnee) + (1 - kKnee) * (1 - (-excess).exp());
}

Color SkyLight(const Eigen::Vector3f& direction) {
  if (direction.z() < 0) return kFloorBounce;
  return kHorizon + (kZenith - kHorizon) * std::sqrt(direction.z());
}

// Two numbers in [0, 1) for a sample of a pixel: a hash, so that neighbours differ.
std::array<float, 2> HashedPair(std::uint32_t a, std::uint32_t b) {
  std::uint32_t h = a * 0x9E3779B1U ^ (b * 0x85EBCA77U + 0xC2B2AE3DU);
  std::array<float, 2> pair{};
  for (float& number : pair) {
    h ^= h >> 16;
    h *= 0x7FEB352DU;
    h ^= h >> 15;
    h *= 0x846CA68BU;
    h ^= h >> 16;
    number = static_cast<float>(h >> 8) * 0x1p-24F;
  }
  return pair;
}

// Orthonormal directions across `axis`.
std::array<Eigen::Vector3f, 2> Across(const Eigen::Vector3f& axis) {
  const Eigen::Vector3f helper =
      std::fabs(axis.x()) < 0.6F ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitY();
  const Eigen::Vector3f first = axis.cross(helper).normalized();
  return {first, axis.cross(first)};
}

// Where a sample's ray ended.
struct Surface {
  enum class Kind { kBackdrop, kFloor, kMesh } kind = Kind::kBackdrop;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  // for light; faces the camera
  Eigen::Vector3f face_normal = Eigen::Vector3f::UnitZ();
  Eigen::Vector3f view = Eigen::Vector3f::UnitZ();  // unit, towards the camera
  Color albedo = Color::Zero();

  bool IsLit() const { return kind != Kind::kBackdrop; }
};
using Surfaces = std::array<Surface, kRaysOfPacket>;
using Directions = std::array<Eigen::Vector3f, kRaysOfPacket>;

// Where a surface's rays to the sky begin to look: across its normal, and how far along the strata.
struct Hemisphere {
  Eigen::Vector3f x, y;  // a golden turn farther with every ray
  float offset = 0;      // in the stratum, [0, 1)
};
using Hemispheres = std::array<Hemisphere, kRaysOfPacket>;

// What arrives at each of the surfaces.
struct Light {
  std::array<Color, kRaysOfPacket> sky;
  std::array<float, kRaysOfPacket> sun;  // part of the sun that is visible, in [0, 1]
};

// What shading needs of a mesh beyond its triangles.
struct MeshLook {
  std::vector<std::array<Eigen::Vector3f, 3>> corner_normals;
  Color albedo;
  Eigen::Matrix3f world_from_mesh;
};

class Painter {
 public:
  Painter(SceneGeometry& scene, const CameraModel& camera, const ScenePictureConfig& config)
      : scene_(scene.runtime()), camera_(camera), config_(config), rays_(camera) {
    rtcInitIntersectContext(&context_);
    context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcInitIntersectContext(&scattered_);
    for (std::size_t i = 0; i < scene_.meshes().size(); ++i) {
      const VisibleMesh& visible = scene_.meshes()[i];
      looks_.push_back({SmoothNormals(visible.mesh, kCrease), ToLinear(visible.color_rgb),
                        scene_.world_from_mesh()[i].linear().cast<float>()});
    }
  }

  // Paints the pixels (left, top) to (left + 1, top + 1).
  void PaintBlock(int left, int top, Picture& picture) {
    left_ = left;
    top_ = top;
    const Surfaces surfaces = TraceBlock();
    Light light;
    light.sky.fill(Color::Zero());
    light.sun.fill(0);
    const bool any_lit =
        std::any_of(surfaces.begin(), surfaces.end(), [](const Surface& s) { return s.IsLit(); });
    if (any_lit) {
      Hemispheres above = HemispheresOf(surfaces);
      for (int k = 0; k < config_.sky_rays; ++k) AddSky(surfaces, k, above, light);
      AddSun(surfaces, light);
    }
    std::array<Color, 4> pixels;
    pixels.fill(Color::Zero());
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane)
      pixels[PixelOf(lane)] += Shade(surfaces[lane], light.sky[lane], light.sun[lane]) / 4;
    for (std::size_t i = 0; i < 4; ++i) Store(i, pixels[i], picture);
  }

 private:
  static std::size_t PixelOf(std::size_t lane) { return lane / 8 * 2 + lane % 4 / 2; }

  std::uint32_t SampleNumber(std::size_t lane) const {
    const int column = 2 * left_ + static_cast<int>(lane % 4);
    const int row = 2 * top_ + static_cast<int>(lane / 4);
    return static_cast<std::uint32_t>(row) * 16411U + static_cast<std::uint32_t>(column);
  }

  Surfaces TraceBlock() {
    RTCRayHit16 packet{};
    alignas(64) std::array<int, kRaysOfPacket> valid{};
    valid.fill(-1);
    const Eigen::Vector3f origin = rays_.origin().cast<float>();
    Directions directions;
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      const std::size_t column = lane % 4;  // of the samples, two to a pixel
      const std::size_t row = lane / 4;
      directions[lane] = rays_.Direction(left_ + (static_cast<double>(column) + 0.5) / 2,
                                         top_ + (static_cast<double>(row) + 0.5) / 2);
      SetRay(packet.ray, lane, origin, directions[lane]);
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid.data(), scene_.top(), &context_, &packet);
    Surfaces surfaces;
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      surfaces[lane] = packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID
                           ? MeshSurface(packet, lane, directions[lane])
                           : FloorOrBackdrop(origin, directions[lane]);
      surfaces[lane].view = -directions[lane].normalized();
    }
    return surfaces;
  }

  template <class Packet>
  static void SetRay(Packet& packet, std::size_t lane, const Eigen::Vector3f& origin,
                     const Eigen::Vector3f& direction) {
    packet.org_x[lane] = origin.x();
    packet.org_y[lane] = origin.y();
    packet.org_z[lane] = origin.z();
    packet.dir_x[lane] = direction.x();
    packet.dir_y[lane] = direction.y();
    packet.dir_z[lane] = direction.z();
    packet.tnear[lane] = 0;
    packet.tfar[lane] = std::numeric_limits<float>::infinity();
    packet.mask[lane] = 0xFFFFFFFFU;
  }

  Surface MeshSurface(const RTCRayHit16& packet, std::size_t lane,
                      const Eigen::Vector3f& direction) const {
    const MeshLook& look = looks_[packet.hit.instID[0][lane]];
    const auto& corners = look.corner_normals[packet.hit.primID[lane]];
    const float u = packet.hit.u[lane];
    const float v = packet.hit.v[lane];
    Surface surface;
    surface.kind = Surface::Kind::kMesh;
    surface.position = rays_.origin().cast<float>() + packet.ray.tfar[lane] * direction;
    surface.normal =
        (look.world_from_mesh * ((1 - u - v) * corners[0] + u * corners[1] + v * corners[2]))
            .normalized();
    const Eigen::Vector3f geometric(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane],
                                    packet.hit.Ng_z[lane]);
    surface.face_normal = (look.world_from_mesh * geometric).normalized();
    if (surface.face_normal.dot(direction) > 0) surface.face_normal *= -1;
    if (surface.normal.dot(surface.face_normal) < 0) surface.normal *= -1;
    surface.albedo = look.albedo;
    return surface;
  }

  Surface FloorOrBackdrop(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
    Surface surface;
    if (!config_.floor || origin.z() <= 0 || direction.z() >= -1e-4F) return surface;
    surface.kind = Surface::Kind::kFloor;
    surface.position = origin + origin.z() / -direction.z() * direction;
    return surface;
  }

  // Which of the rays from the lit surfaces reach `reach` without meeting a mesh; `directions` of
  // the others may be anything.
  std::array<bool, kRaysOfPacket> Unobstructed(const Surfaces& surfaces,
                                               const Directions& directions, float reach) {
    RTCRay16 packet{};  // zeros where no ray is wanted: Embree checks those lanes, too
    alignas(64) std::array<int, kRaysOfPacket> valid{};
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      const Surface& surface = surfaces[lane];
      if (!surface.IsLit()) continue;
      valid[lane] = -1;
      SetRay(packet, lane, surface.position + 4e-4F * surface.face_normal, directions[lane]);
      packet.tfar[lane] = reach;
    }
    rtcOccluded16(valid.data(), scene_.top(), &scattered_, &packet);
    std::array<bool, kRaysOfPacket> free{};
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) free[lane] = packet.tfar[lane] >= 0;
    return free;
  }

  // Two numbers in [0, 1) for a surface's sample, drawn anew for each `purpose`. The first is
  // stratified over the four samples of a pixel.
  std::array<float, 2> NumbersOf(std::size_t lane, std::uint32_t purpose) const {
    auto [a, b] = HashedPair(SampleNumber(lane), purpose);
    const std::size_t stratum = lane / 4 % 2 * 2 + lane % 2;
    return {(static_cast<float>(stratum) + a) / 4, b};
  }

  Hemispheres HemispheresOf(const Surfaces& surfaces) const {
    Hemispheres above;
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      if (!surfaces[lane].IsLit()) continue;
      const auto [offset, turn] = NumbersOf(lane, 7);
      const auto [x, y] = Across(surfaces[lane].normal);
      const float c = std::cos(2 * kPi * turn);
      const float s = std::sin(2 * kPi * turn);
      above[lane] = {c * x + s * y, c * y - s * x, offset};
    }
    return above;
  }

  // One cosine-distributed sky ray from each surface; `k` numbers the strata of the hemisphere.
  void AddSky(const Surfaces& surfaces, int k, Hemispheres& above, Light& light) {
    static const float turn_cos = std::cos(kGoldenTurn);
    static const float turn_sin = std::sin(kGoldenTurn);
    Directions directions;
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      if (!surfaces[lane].IsLit()) continue;
      Hemisphere& turned = above[lane];
      const float step =
          (static_cast<float>(k) + turned.offset) / static_cast<float>(config_.sky_rays);
      directions[lane] = std::sqrt(step) * turned.x + std::sqrt(1 - step) * surfaces[lane].normal;
      const Eigen::Vector3f x = turn_cos * turned.x + turn_sin * turned.y;
      turned.y = turn_cos * turned.y - turn_sin * turned.x;
      turned.x = x;
    }
    const std::array<bool, kRaysOfPacket> free = Unobstructed(surfaces, directions, kSkyReach);
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      if (!surfaces[lane].IsLit()) continue;
      const Color sky = SkyLight(directions[lane]) / static_cast<float>(config_.sky_rays);
      // light that another surface took away comes back in part from that surface
      light.sky[lane] += free[lane] ? sky : Color(0.18F * sky);
    }
  }

  // One ray a sample: four a pixel, on rings of the sun of equal area.
  void AddSun(const Surfaces& surfaces, Light& light) {
    const auto [x, y] = Across(kSunDirection);
    Directions directions;
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane) {
      if (!surfaces[lane].IsLit()) continue;
      const auto [a, b] = NumbersOf(lane, 13);
      const float radius = kSunSoftness * std::sqrt(a);
      const float angle = 2 * kPi * b;
      directions[lane] =
          kSunDirection + radius * std::cos(angle) * x + radius * std::sin(angle) * y;
    }
    const std::array<bool, kRaysOfPacket> free =
        Unobstructed(surfaces, directions, std::numeric_limits<float>::infinity());
    for (std::size_t lane = 0; lane < kRaysOfPacket; ++lane)
      light.sun[lane] = free[lane] ? 1.0F : 0.0F;
  }

  Color Backdrop() const {
    const float height = static_cast<float>(top_) / static_cast<float>(camera_.height);
    return kBackdropTop + (kBackdropBottom - kBackdropTop) * std::min(1.0F, 1.5F * height);
  }

  Color Shade(const Surface& surface, const Color& sky, float sun_visible) const {
    if (!surface.IsLit()) return Backdrop();
    const float facing = std::max(0.0F, surface.normal.dot(kSunDirection));
    const Color sun = sun_visible * facing * kSun;
    if (surface.kind == Surface::Kind::kFloor) {
      // the floor is the backdrop, darkened where light is missing: no seam at the horizon
      const Color open = kSunDirection.z() * kSun + 0.92F * kZenith;
      return Backdrop() * ((sun + sky) / open).min(1.0F);
    }
    const Eigen::Vector3f half = (surface.view + kSunDirection).normalized();
    const float gloss = sun_visible * std::pow(std::max(0.0F, surface.normal.dot(half)), 48.0F);
    const Color light = surface.albedo * (sun + sky) * 0.58F + 0.10F * gloss * kSun;
    return CompressHighlights(light * static_cast<float>(config_.exposure));
  }

  void Store(std::size_t index, const Color& color, Picture& picture) const {
    const int column = left_ + static_cast<int>(index % 2);
    const int row = top_ + static_cast<int>(index / 2);
    if (column >= picture.width || row >= picture.height) return;
    const auto pixel =
        3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
             static_cast<std::size_t>(column));
    for (std::size_t i = 0; i < 3; ++i)
      picture.rgb[pixel + i] = ToSrgb(color[static_cast<Eigen::Index>(i)]);
  }

  SceneGeometry::Runtime& scene_;
  const CameraModel& camera_;
  const ScenePictureConfig& config_;
  PixelRays rays_;
  std::vector<MeshLook> looks_;
  RTCIntersectContext context_{};
  RTCIntersectContext scattered_{};
  int left_ = 0;
  int top_ = 0;
};

template <class Visit>
void VisitVertices(const SceneGeometry& scene, const Visit& visit) {
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    for (const Eigen::Vector3d& vertex : scene.meshes()[i].mesh.vertices)
      visit(scene.world_from_mesh(i) * vertex);
  }
}

}  // namespace

Picture RenderPicture(SceneGeometry& scene, const CameraModel& camera,
                      const ScenePictureConfig& config) {
  const bool valid = camera.width > 0 && camera.height > 0 && camera.width <= 8192 &&
                     camera.height <= 8192 && config.sky_rays >= 1 && config.sky_rays <= 64 &&
                     config.exposure > 0;
  Require(valid, ErrorCode::kInvalidArgument,
          "scene picture: image size, sky_rays or exposure out of range");
  Picture picture{camera.width, camera.height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(camera.width) *
                     static_cast<std::size_t>(camera.height));
  const DenormalsAreZero denormals_are_zero;
  Painter painter(scene, camera, config);
  for (int top = 0; top < camera.height; top += 2) {
    for (int left = 0; left < camera.width; left += 2) painter.PaintBlock(left, top, picture);
  }
  return picture;
}

CameraModel FramingCamera(const SceneGeometry& scene, const ViewConfig& view) {
  Eigen::AlignedBox3d box;
  VisitVertices(scene, [&](const Eigen::Vector3d& point) { box.extend(point); });
  CameraModel camera;
  camera.width = view.width;
  camera.height = view.height;
  camera.horizontal_fov_rad = 0.7;
  camera.target_m = box.isEmpty() ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(box.center());
  const Eigen::Vector3d away(std::cos(view.elevation_rad) * std::cos(view.azimuth_rad),
                             std::cos(view.elevation_rad) * std::sin(view.azimuth_rad),
                             std::sin(view.elevation_rad));
  camera.position_m = camera.target_m + away;
  const RigidTransform camera_from_world = WorldFromCamera(camera).inverse();
  const double wide = std::tan(camera.horizontal_fov_rad / 2);
  const double tall = wide * view.height / view.width;
  double distance = box.isEmpty() ? 3 : 0.1;
  // a point at depth z from the unit-distance camera needs z + distance - 1 >= offset / slope
  VisitVertices(scene, [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d p = camera_from_world * point;
    const double needed = std::max(std::fabs(p.x()) / wide, std::fabs(p.y()) / tall) - p.z() + 1;
    distance = std::max(distance, needed);
  });
  camera.position_m = camera.target_m + view.margin * distance * away;
  return camera;
}

}  // namespace doorforge
