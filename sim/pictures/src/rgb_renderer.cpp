// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "rgb_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "doorforge/core/rng.h"
#include "doorforge/sensor/ray_packet.h"

#include "develop.h"
#include "pinhole_directions.h"

namespace doorforge {
namespace {

constexpr int kLampPlaces = 16;        // of a lamp, that a block of pixels looks for
constexpr float kThroughPane = 0.04F;  // [m]
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNearestLamp = 0.04F;  // [m2] light grows no more than up to it

Eigen::AlignedBox3f BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex.cast<float>());
  return box;
}

}  // namespace

RgbRenderer::Highlight::Highlight(float exponent) : least_(std::exp2(-12 / exponent)) {
  scale_ = static_cast<float>(kSteps) / (1 - least_);
  for (std::size_t step = 0; step <= kSteps; ++step)
    table_[step] = std::pow(least_ + static_cast<float>(step) / scale_, exponent);
}

RgbRenderer::RgbRenderer(const PictureScene& scene, const PicturesConfig& config,
                         SceneGeometry& geometry)
    : geometry_(geometry),
      room_(scene, config),
      appearance_(DrawAppearance(scene, geometry.meshes(), room_)),
      lit_{geometry_, room_, appearance_},
      samples_(config.samples),
      rounds_(std::max(1, config.samples / kLampPlaces)),
      seed_(Rng(scene.scene.seed, "pictures/" + scene.scene.door_id + "/" +
                                      std::to_string(scene.scene.episode) + "/noise")
                .NextUint32()),
      frames_(geometry.meshes().size()) {
  for (const VisibleMesh& mesh : geometry.meshes()) {
    const bool has_pane = scene.door.category == Category::kWindow && mesh.link == kLeafLink &&
                          mesh.label == PointLabel::kBody;
    pane_boxes_.push_back(has_pane ? BoundsOf(mesh.mesh) : Eigen::AlignedBox3f());
  }
  // drawn appearances paint over what authors drew
  if (scene.scene.appearance == SceneAppearance::kOff) drawn_.emplace(scene.door);
  if (drawn_ && drawn_->empty()) drawn_.reset();
  for (const DoorLink& link : scene.door.links) door_meshes_ += link.geometry.size();
  const auto add = [&](const Finish& finish) {
    materials_.push_back({finish, Highlight(finish.exponent)});
  };
  for (const Finish& finish : appearance_.meshes) add(finish);
  add(appearance_.pane);
  for (const Finish& finish : appearance_.room) add(finish);
}

std::vector<std::uint8_t> RgbRenderer::Render(const CameraModel& camera,
                                              const SurfaceImage& surfaces, std::size_t look,
                                              PicturePart part) {
  image_.width = surfaces.depth.width;
  image_.height = surfaces.depth.height;
  PlaceMeshes();
  if (drawn_) drawn_->MoveWith(geometry_);
  FindPoints(camera, surfaces);
  image_.FindSeams();
  image_.wanted.clear();
  if (part == PicturePart::kSurfaces) {
    std::vector<std::uint8_t> is_seen(surfaces.mesh.size());
    for (std::size_t i = 0; i < is_seen.size(); ++i) is_seen[i] = surfaces.mesh[i] < 0 ? 0 : 1;
    image_.WantAround(is_seen);
  }
  light_ = ShareLight(lit_, image_, rounds_);
  ShadePixels();
  SmoothEdges(camera);
  if (appearance_.exposure.blur_px > 0) BlurPicture(colors_, image_.width, appearance_.exposure);
  return DevelopPicture(colors_, appearance_.exposure,
                        seed_ + static_cast<std::uint32_t>(look) * 0x85EBCA77U);
}

void RgbRenderer::PlaceMeshes() {
  for (std::size_t mesh = 0; mesh < frames_.size(); ++mesh) {
    const RigidTransform& pose = geometry_.world_from_mesh(mesh);
    frames_[mesh] = {pose.linear().cast<float>(), pose.translation().cast<float>()};
  }
}

void RgbRenderer::FindPoints(const CameraModel& camera, const SurfaceImage& surfaces) {
  const PinholeDirections directions(camera);
  const Eigen::Vector3f& origin = directions.origin();
  image_.points.resize(surfaces.mesh.size());
  for (int row = 0; row < image_.height; ++row) {
    for (int column = 0; column < image_.width; ++column) {
      const std::size_t i = image_.At(column, row);
      const Eigen::Vector3f direction =
          directions.Through(static_cast<float>(column) + 0.5F, static_cast<float>(row) + 0.5F);
      SeenPoint& point = image_.points[i];
      if (surfaces.mesh[i] < 0) {
        point = RoomPoint(origin, direction);
      } else {
        point = MeshPoint(static_cast<std::size_t>(surfaces.mesh[i]), surfaces.triangle[i],
                          {surfaces.u[i], surfaces.v[i]},
                          origin + surfaces.depth.depth_m[i] * direction);
        point.face = surfaces.normal[i];
        if (point.normal.dot(point.face) < 0) point.normal = -point.normal;
      }
      point.view = direction * (-1 / direction.norm());
    }
  }
}

SeenPoint RgbRenderer::MeshPoint(std::size_t mesh, std::size_t triangle, const Eigen::Vector2f& uv,
                                 const Eigen::Vector3f& position) const {
  const MeshFrame& frame = frames_[mesh];
  SeenPoint point;
  point.position = position;
  point.normal = frame.world_from_mesh * geometry_.SmoothNormal(mesh, triangle, uv.x(), uv.y());
  point.face = point.normal;
  const bool in_pane = !pane_boxes_[mesh].isEmpty() && IsPane(mesh, frame.InMesh(position));
  point.part = in_pane ? PaneMaterial() : static_cast<std::uint16_t>(mesh);
  return point;
}

// A window's leaf is thin where it has its pane.
bool RgbRenderer::IsPane(std::size_t mesh, const Eigen::Vector3f& in_mesh) const {
  constexpr float kRim = 0.22F;  // of the thickness, on either side
  const Eigen::AlignedBox3f& box = pane_boxes_[mesh];
  const float inward = (in_mesh.x() - box.min().x()) / box.sizes().x();
  return inward > kRim && inward < 1 - kRim && box.exteriorDistance(in_mesh) < kSkin &&
         std::min((in_mesh - box.min()).tail<2>().minCoeff(),
                  (box.max() - in_mesh).tail<2>().minCoeff()) > 0.02F;
}

SeenPoint RgbRenderer::RoomPoint(const Eigen::Vector3f& origin,
                                 const Eigen::Vector3f& direction) const {
  const RoomHit hit = room_.Meet(origin, direction);
  SeenPoint point;
  point.position = origin + hit.distance * direction;
  point.normal = point.face = hit.normal;
  point.part = static_cast<std::uint16_t>(PaneMaterial() + 1 + static_cast<int>(hit.part));
  return point;
}

LinearColor RgbRenderer::AlbedoOf(const SeenPoint& point) {
  if (drawn_ && point.part < door_meshes_) {
    if (const auto color = drawn_->ColorAt(point.part, point.position, point.face)) return *color;
  }
  const Finish& finish = materials_[point.part].finish;
  if (finish.texture == Texture::kPlain) return finish.color;
  return ColorAt(finish, point.part < frames_.size() ? frames_[point.part].InMesh(point.position)
                                                     : point.position);
}

LinearColor RgbRenderer::Shade(const SeenPoint& point, const LightShares& shares) {
  const float share = 1 / static_cast<float>(kLampPlaces * rounds_);  // of a place that is in sight
  const auto& [finish, shine] = materials_[point.part];
  const float around = share / static_cast<float>(LightShares::kAroundUnit);
  LinearColor light =
      appearance_.ambient * (around * static_cast<float>(shares.Of(LightShares::kAround)));
  LinearColor highlight = LinearColor::Zero();
  const std::span<const Lamp> lamps = lit_.LampsAt(point);
  const float facing = point.normal.dot(point.view);
  for (std::size_t l = 0; l < lamps.size(); ++l) {
    const std::uint32_t seen = shares.Of(l);
    if (seen == 0) continue;
    const Eigen::Vector3f to_lamp = lamps[l].position_m - point.position;
    const float squared = to_lamp.squaredNorm();
    const Eigen::Vector3f direction = to_lamp * (1 / std::sqrt(squared));
    const LinearColor arriving =
        lamps[l].power * (share * static_cast<float>(seen) / std::max(squared, kNearestLamp));
    const float upright = point.normal.dot(direction);
    light += arriving * std::max(0.0F, upright);
    // cosine to the bisector of the two directions
    const float halfway =
        (facing + upright) / std::sqrt(std::max(2 + 2 * point.view.dot(direction), 1e-6F));
    const float height = shine.At(halfway);
    if (height > 0) highlight += arriving * height;
  }
  LinearColor color = AlbedoOf(point) * light;
  if (finish.clear > 0)
    color = (1 - finish.clear) * color + finish.clear * finish.color * Behind(point);
  if (finish.mirror > 0) {
    const float away = 1 - std::clamp(facing, 0.0F, 1.0F);
    const float mirror = finish.mirror + (1 - finish.mirror) * (away * away) * (away * away) * away;
    const Eigen::Vector3f reflected = 2 * facing * point.normal - point.view;
    color =
        (1 - mirror) * color + mirror * RoomLight(point.position + kSkin * point.face, reflected);
  }
  return color + finish.gloss * highlight;
}

// What the bare room sends back along a ray, without shadows.
LinearColor RgbRenderer::RoomLight(const Eigen::Vector3f& origin,
                                   const Eigen::Vector3f& direction) {
  const SeenPoint point = RoomPoint(origin, direction);
  LinearColor light = appearance_.ambient;
  for (const Lamp& lamp : lit_.LampsAt(point)) {
    const Eigen::Vector3f to_lamp = lamp.position_m - point.position;
    const float squared = std::max(to_lamp.squaredNorm(), kNearestLamp);
    light +=
        lamp.power * (std::max(0.0F, point.normal.dot(to_lamp)) / (squared * std::sqrt(squared)));
  }
  return AlbedoOf(point) * light;
}

LinearColor RgbRenderer::Behind(const SeenPoint& pane) {
  RayPacket packet;
  const Eigen::Vector3f origin = pane.position - kThroughPane * pane.view;
  packet.Set(0, origin, -pane.view, kInfinity);
  const PacketHits hits = CastRays(geometry_, packet);
  if (hits.hits == 0 || room_.Meet(origin, -pane.view).distance < hits.distance[0])
    return RoomLight(origin, -pane.view);
  const SeenPoint point = MeshPoint(static_cast<std::size_t>(hits.mesh[0]), hits.triangle[0],
                                    {hits.u[0], hits.v[0]}, origin - hits.distance[0] * pane.view);
  if (point.part == PaneMaterial()) return RoomLight(origin, -pane.view);
  LinearColor light = appearance_.ambient;
  for (const Lamp& lamp : lit_.LampsAt(point)) {
    const Eigen::Vector3f to_lamp = lamp.position_m - point.position;
    light += lamp.power * (std::fabs(point.normal.dot(to_lamp.normalized())) /
                           std::max(to_lamp.squaredNorm(), kNearestLamp));
  }
  return AlbedoOf(point) * light;
}

void RgbRenderer::ShadePixels() {
  colors_.assign(image_.points.size(), LinearColor::Zero());
  for (int row = 0; row < image_.height; ++row) {
    for (int column = 0; column < image_.width; ++column) {
      if (!image_.IsWanted(column, row)) continue;
      const std::size_t i = image_.At(column, row);
      colors_[i] = Shade(image_.points[i], light_[i]);
    }
  }
}

}  // namespace doorforge
