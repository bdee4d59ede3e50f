// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "rgb_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "doorforge/core/rng.h"
#include "doorforge/sensor/pinhole_view.h"
#include "doorforge/sensor/ray_packet.h"

namespace doorforge {

// Directions through pixels, whose length along the optical axis is 1.
class PixelDirections {
 public:
  explicit PixelDirections(const CameraModel& camera) : view_(ViewOf(camera)) {}

  Eigen::Vector3f origin() const { return view_.world_from_camera.translation().cast<float>(); }
  Eigen::Vector3f Through(double u, double v) const {
    const Eigen::Vector3d in_camera((u - view_.cx) / view_.fx, (v - view_.cy) / view_.fy, 1);
    return (view_.world_from_camera.linear() * in_camera).cast<float>();
  }

 private:
  PinholeView view_;
};

namespace {

constexpr int kBlock = 4;  // pixels a side that share what they find
constexpr std::uint16_t kFirstPane = 32768;
constexpr std::uint16_t kFirstRoomPart = 65000;
constexpr std::size_t kAround = kMostLamps;  // place of the surroundings among the shares
constexpr float kSkin = 5e-4F;               // [m] rays begin so far off a surface
constexpr float kAroundReach = 0.8F;         // [m] what is farther keeps no light out of a corner
constexpr float kSameNormal = 0.9F;          // cosine
constexpr float kSamePlane = 0.03F;          // [m]
constexpr float kThroughPane = 0.04F;        // [m]
constexpr float kFullTurn = 6.2831853F;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Pixel i of a block looks for place kPlaces[i]: neighbours look far apart.
constexpr std::array<int, 16> kPlaces = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

// The place on the unit disc, of 16 that cover it evenly.
Eigen::Vector2f OnDisc(int place) {
  const float radius = std::sqrt((static_cast<float>(place / 4) + 0.5F) / 4);
  const float angle =
      kFullTurn * (static_cast<float>(place % 4) + 0.25F * static_cast<float>(place / 4)) / 4;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

const std::array<Eigen::Vector2f, 16>& Disc() {
  static const std::array<Eigen::Vector2f, 16> kDisc = [] {
    std::array<Eigen::Vector2f, 16> disc;
    for (int place = 0; place < 16; ++place)
      disc.at(static_cast<std::size_t>(place)) = OnDisc(place);
    return disc;
  }();
  return kDisc;
}

Eigen::Vector3f AcrossOf(const Eigen::Vector3f& axis) {
  const Eigen::Vector3f helper =
      std::fabs(axis.x()) < 0.6F ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitY();
  return axis.cross(helper).normalized();
}

// Light above 0.8 is compressed towards 1 instead of being cut off.
float Compressed(float light) {
  constexpr float kKnee = 0.8F;
  return light <= kKnee ? light
                        : kKnee + (1 - kKnee) * (1 - std::exp((kKnee - light) / (1 - kKnee)));
}

// Of 4096 steps of light.
const std::array<std::uint8_t, 4097>& SrgbTable() {
  static const std::array<std::uint8_t, 4097> kTable = [] {
    std::array<std::uint8_t, 4097> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double c = static_cast<double>(i) / 4096;
      const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      table[i] = static_cast<std::uint8_t>(std::lround(255 * srgb));
    }
    return table;
  }();
  return kTable;
}

Eigen::AlignedBox3f BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex.cast<float>());
  return box;
}

}  // namespace

RgbRenderer::RgbRenderer(const PictureScene& scene, const PicturesConfig& config,
                         SceneGeometry& geometry)
    : geometry_(geometry),
      room_(scene, config),
      appearance_(DrawAppearance(scene, geometry.meshes(), room_)),
      samples_(config.samples),
      rounds_(std::max(1, config.samples / (kBlock * kBlock))),
      seed_(Rng(scene.scene.seed, "pictures/" + scene.scene.door_id + "/" +
                                      std::to_string(scene.scene.episode) + "/noise")
                .NextUint32()) {
  for (const VisibleMesh& mesh : geometry.meshes()) {
    const bool has_pane = scene.door.category == Category::kWindow && mesh.link == kLeafLink &&
                          mesh.label == PointLabel::kBody;
    pane_boxes_.push_back(has_pane ? BoundsOf(mesh.mesh) : Eigen::AlignedBox3f());
  }
}

std::vector<std::uint8_t> RgbRenderer::Render(const CameraModel& camera,
                                              const SurfaceImage& surfaces, std::size_t look) {
  width_ = surfaces.depth.width;
  height_ = surfaces.depth.height;
  FindPoints(camera, surfaces);
  SampleLight();
  ShadePixels();
  SmoothEdges(camera);
  if (appearance_.exposure.blur_px > 0) Blur();
  return Develop(look);
}

void RgbRenderer::FindPoints(const CameraModel& camera, const SurfaceImage& surfaces) {
  const PixelDirections directions(camera);
  const Eigen::Vector3f origin = directions.origin();
  points_.resize(surfaces.mesh.size());
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const std::size_t i = At(column, row);
      const Eigen::Vector3f direction = directions.Through(column + 0.5, row + 0.5);
      Point& point = points_[i];
      point = surfaces.mesh[i] < 0 ? RoomPoint(origin, direction)
                                   : MeshPoint(static_cast<std::size_t>(surfaces.mesh[i]),
                                               surfaces.triangle[i], {surfaces.u[i], surfaces.v[i]},
                                               origin + surfaces.depth.depth_m[i] * direction);
      point.view = -direction.normalized();
      if (surfaces.mesh[i] >= 0) point.face = surfaces.normal[i];
      if (point.normal.dot(point.face) < 0) point.normal = -point.normal;
    }
  }
}

RgbRenderer::Point RgbRenderer::MeshPoint(std::size_t mesh, std::size_t triangle,
                                          const Eigen::Vector2f& uv,
                                          const Eigen::Vector3f& position) const {
  const RigidTransform& pose = geometry_.world_from_mesh(mesh);
  Point point;
  point.position = position;
  point.normal =
      pose.linear().cast<float>() * geometry_.SmoothNormal(mesh, triangle, uv.x(), uv.y());
  point.face = point.normal;
  point.part = static_cast<std::uint16_t>(mesh);
  if (!pane_boxes_[mesh].isEmpty() &&
      IsPane(mesh, (pose.inverse() * position.cast<double>()).cast<float>()))
    point.part = static_cast<std::uint16_t>(kFirstPane + mesh);
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

RgbRenderer::Point RgbRenderer::RoomPoint(const Eigen::Vector3f& origin,
                                          const Eigen::Vector3f& direction) const {
  const RoomHit hit = room_.Meet(origin, direction);
  Point point;
  point.position = origin + hit.distance * direction;
  point.normal = point.face = hit.normal;
  point.part = static_cast<std::uint16_t>(kFirstRoomPart + static_cast<int>(hit.part));
  return point;
}

const Finish& RgbRenderer::FinishOf(std::uint16_t part) const {
  if (part >= kFirstRoomPart) return appearance_.room[part - kFirstRoomPart];
  return part >= kFirstPane ? appearance_.pane : appearance_.meshes[part];
}

LinearColor RgbRenderer::AlbedoOf(const Point& point, const Finish& finish) const {
  if (finish.texture == Texture::kPlain) return finish.color;
  if (point.part >= kFirstPane) return ColorAt(finish, point.position);
  const RigidTransform& pose = geometry_.world_from_mesh(point.part);
  return ColorAt(finish, (pose.inverse() * point.position.cast<double>()).cast<float>());
}

std::span<const Lamp> RgbRenderer::LampsAt(const Point& point) const {
  // rounding must not put a point of the wall behind it
  if (room_.IsBehindWall(point.position + kSkin * point.face)) return {&appearance_.lamp_behind, 1};
  return appearance_.lamps;
}

void RgbRenderer::SampleLight() {
  light_.assign(points_.size(), Shares{});
  for (int round = 0; round < rounds_; ++round) {
    for (int top = 0; top < height_; top += kBlock) {
      for (int left = 0; left < width_; left += kBlock) SampleTile(left, top, round);
    }
  }
}

// One ray a pixel to each lamp, and one for the surroundings.
void RgbRenderer::SampleTile(int left, int top, int round) {
  std::array<RayPacket, kMostLamps + 1> packets;
  for (int lane = 0; lane < kBlock * kBlock; ++lane) {
    const int column = left + lane % kBlock;
    const int row = top + lane / kBlock;
    if (column >= width_ || row >= height_) continue;
    const Point& point = points_[At(column, row)];
    const Eigen::Vector3f origin = point.position + kSkin * point.face;
    const auto place = static_cast<std::size_t>(
        (kPlaces[static_cast<std::size_t>(lane)] + 5 * round) % (kBlock * kBlock));
    const Eigen::Vector2f on_disc = Disc()[place];
    const auto slot = static_cast<std::size_t>(lane);
    const std::span<const Lamp> lamps = LampsAt(point);
    for (std::size_t l = 0; l < lamps.size(); ++l) {
      const Eigen::Vector3f target =
          lamps[l].position_m + lamps[l].radius_m * Eigen::Vector3f(on_disc.x(), on_disc.y(), 0);
      const Eigen::Vector3f to_lamp = target - origin;
      if (to_lamp.dot(point.normal) > 0 && to_lamp.dot(point.face) > 0 &&
          !room_.Blocks(origin, to_lamp, 1))
        packets[l].Set(slot, origin, to_lamp, 1);
    }
    const Eigen::Vector3f across = AcrossOf(point.normal);
    const Eigen::Vector3f around =
        on_disc.x() * across + on_disc.y() * point.normal.cross(across) +
        std::sqrt(std::max(0.0F, 1 - on_disc.squaredNorm())) * point.normal;
    if (room_.Meet(origin, around).distance > kAroundReach)
      packets[kAround].Set(slot, origin, around, kAroundReach);
  }
  for (std::size_t l = 0; l < packets.size(); ++l) {
    if (packets[l].rays == 0) continue;
    const std::uint32_t free = packets[l].rays & ~ObstructedRays(geometry_, packets[l]);
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
      if ((free >> lane & 1U) == 0) continue;
      const int column = left + static_cast<int>(lane) % kBlock;
      const int row = top + static_cast<int>(lane) / kBlock;
      ++light_[At(column, row)][l];
    }
  }
}

// What the pixels of a block around this one have found that see the same surface. Any block of 4 x
// 4 holds all 16 places.
RgbRenderer::Shares RgbRenderer::SharedLight(int column, int row) const {
  const Point& point = points_[At(column, row)];
  Shares sum{};
  std::uint32_t count = 0;
  const int left = std::clamp(column - 1, 0, std::max(0, width_ - kBlock));
  const int top = std::clamp(row - 1, 0, std::max(0, height_ - kBlock));
  for (int y = top; y < std::min(top + kBlock, height_); ++y) {
    for (int x = left; x < std::min(left + kBlock, width_); ++x) {
      const Point& other = points_[At(x, y)];
      if (other.part != point.part || other.normal.dot(point.normal) < kSameNormal ||
          std::fabs((other.position - point.position).dot(point.face)) > kSamePlane)
        continue;
      const Shares& found = light_[At(x, y)];
      for (std::size_t l = 0; l < found.size(); ++l)
        sum[l] = static_cast<std::uint16_t>(sum[l] + found[l]);
      ++count;
    }
  }
  if (count == 0) return light_[At(column, row)];
  for (std::uint16_t& share : sum)
    share = static_cast<std::uint16_t>((share * 16U + count / 2) / count);
  return sum;
}

LinearColor RgbRenderer::Shade(const Point& point, const Shares& shares) const {
  const auto most = static_cast<float>(16 * rounds_);  // a share where all rays were free
  const Finish& finish = FinishOf(point.part);
  LinearColor light = appearance_.ambient * (static_cast<float>(shares[kAround]) / most);
  LinearColor highlight = LinearColor::Zero();
  const std::span<const Lamp> lamps = LampsAt(point);
  for (std::size_t l = 0; l < lamps.size(); ++l) {
    if (shares[l] == 0) continue;
    const Eigen::Vector3f to_lamp = lamps[l].position_m - point.position;
    const float squared = std::max(to_lamp.squaredNorm(), 0.04F);
    const Eigen::Vector3f direction = to_lamp.normalized();
    const LinearColor arriving =
        lamps[l].power * (static_cast<float>(shares[l]) / (most * squared));
    light += arriving * std::max(0.0F, point.normal.dot(direction));
    const float half = std::max(0.0F, point.normal.dot((point.view + direction).normalized()));
    highlight += arriving * std::pow(half, finish.exponent);
  }
  LinearColor color = AlbedoOf(point, finish) * light;
  if (finish.clear > 0)
    color = (1 - finish.clear) * color + finish.clear * finish.color * Behind(point);
  if (finish.mirror > 0) {
    const float facing = std::clamp(point.normal.dot(point.view), 0.0F, 1.0F);
    const float mirror = finish.mirror + (1 - finish.mirror) * std::pow(1 - facing, 5.0F);
    const Eigen::Vector3f reflected = 2 * point.normal.dot(point.view) * point.normal - point.view;
    color =
        (1 - mirror) * color + mirror * RoomLight(point.position + kSkin * point.face, reflected);
  }
  return color + finish.gloss * highlight;
}

// What the bare room sends back along a ray, without shadows.
LinearColor RgbRenderer::RoomLight(const Eigen::Vector3f& origin,
                                   const Eigen::Vector3f& direction) const {
  const Point point = RoomPoint(origin, direction);
  LinearColor light = appearance_.ambient;
  for (const Lamp& lamp : LampsAt(point)) {
    const Eigen::Vector3f to_lamp = lamp.position_m - point.position;
    const float squared = std::max(to_lamp.squaredNorm(), 0.04F);
    light +=
        lamp.power * (std::max(0.0F, point.normal.dot(to_lamp)) / (squared * std::sqrt(squared)));
  }
  return AlbedoOf(point, FinishOf(point.part)) * light;
}

LinearColor RgbRenderer::Behind(const Point& pane) const {
  RayPacket packet;
  const Eigen::Vector3f origin = pane.position - kThroughPane * pane.view;
  packet.Set(0, origin, -pane.view, kInfinity);
  const PacketHits hits = CastRays(geometry_, packet);
  if (hits.hits == 0 || room_.Meet(origin, -pane.view).distance < hits.distance[0])
    return RoomLight(origin, -pane.view);
  Point point = MeshPoint(static_cast<std::size_t>(hits.mesh[0]), hits.triangle[0],
                          {hits.u[0], hits.v[0]}, origin - hits.distance[0] * pane.view);
  if (point.part >= kFirstPane) return RoomLight(origin, -pane.view);
  LinearColor light = appearance_.ambient;
  for (const Lamp& lamp : LampsAt(point)) {
    const Eigen::Vector3f to_lamp = lamp.position_m - point.position;
    light += lamp.power * (std::fabs(point.normal.dot(to_lamp.normalized())) /
                           std::max(to_lamp.squaredNorm(), 0.04F));
  }
  return AlbedoOf(point, FinishOf(point.part)) * light;
}

void RgbRenderer::ShadePixels() {
  colors_.resize(points_.size());
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column)
      colors_[At(column, row)] = Shade(points_[At(column, row)], SharedLight(column, row));
  }
}

bool RgbRenderer::IsEdge(int column, int row) const {
  constexpr float kCrease = 0.97F;
  const Point& point = points_[At(column, row)];
  constexpr int kNeighbours[][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  return std::any_of(std::begin(kNeighbours), std::end(kNeighbours), [&](const int* step) {
    const int x = column + step[0];
    const int y = row + step[1];
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
    const Point& other = points_[At(x, y)];
    return other.part != point.part || other.face.dot(point.face) < kCrease ||
           std::fabs((other.position - point.position).dot(point.face)) > kSamePlane;
  });
}

void RgbRenderer::SmoothEdges(const CameraModel& camera) {
  if (samples_ < 2) return;
  const PixelDirections directions(camera);
  std::vector<std::pair<std::size_t, LinearColor>> smooth;
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      if (IsEdge(column, row))
        smooth.emplace_back(At(column, row), EdgeColor(directions, column, row));
    }
  }
  for (const auto& [pixel, color] : smooth) colors_[pixel] = color;
}

LinearColor RgbRenderer::EdgeColor(const PixelDirections& directions, int column, int row) const {
  const Eigen::Vector3f origin = directions.origin();
  const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(samples_))));
  LinearColor sum = LinearColor::Zero();
  for (int first = 0; first < side * side; first += static_cast<int>(RayPacket::kSize)) {
    RayPacket packet;
    std::array<Eigen::Vector3f, RayPacket::kSize> through;
    const int count = std::min(static_cast<int>(RayPacket::kSize), side * side - first);
    for (int lane = 0; lane < count; ++lane) {
      const int i = first + lane;
      const auto slot = static_cast<std::size_t>(lane);
      through[slot] =
          directions.Through(column + (i % side + 0.5) / side, row + (i / side + 0.5) / side);
      packet.Set(slot, origin, through[slot], kInfinity);
    }
    const PacketHits hits = CastRays(geometry_, packet);
    for (int lane = 0; lane < count; ++lane) {
      const auto slot = static_cast<std::size_t>(lane);
      const bool hit = (hits.hits >> slot & 1U) != 0;
      Point point = hit ? MeshPoint(static_cast<std::size_t>(hits.mesh[slot]), hits.triangle[slot],
                                    {hits.u[slot], hits.v[slot]},
                                    origin + hits.distance[slot] * through[slot])
                        : RoomPoint(origin, through[slot]);
      if (point.normal.dot(through[slot]) > 0) point.normal = -point.normal;
      point.view = -through[slot].normalized();
      const LinearColor* near = ColorNear(point, column, row);
      sum += near != nullptr ? *near : Shade(point, SharedLight(column, row));
    }
  }
  return sum / static_cast<float>(side * side);
}

// The colour of the pixel around this one that sees most nearly the same; null: none does.
const LinearColor* RgbRenderer::ColorNear(const Point& point, int column, int row) const {
  const LinearColor* nearest = nullptr;
  float best = kSameNormal;
  for (int y = std::max(0, row - 1); y <= std::min(height_ - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(width_ - 1, column + 1); ++x) {
      const Point& other = points_[At(x, y)];
      const float same = other.normal.dot(point.normal);
      if (other.part != point.part || same <= best) continue;
      best = same;
      nearest = &colors_[At(x, y)];
    }
  }
  return nearest;
}

// A spread of less than a pixel: the pixel and its four neighbours, then the same again for the
// corners.
void RgbRenderer::Blur() {
  const float spread = appearance_.exposure.blur_px;
  const float side = std::exp(-0.5F / std::max(spread * spread, 1e-3F));
  const float middle = 1 / (1 + 2 * side);
  const auto along = [&](int dx, int dy) {
    std::vector<LinearColor> blurred(colors_.size());
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column) {
        const auto at = [&](int sign) -> const LinearColor& {
          return colors_[At(std::clamp(column + sign * dx, 0, width_ - 1),
                            std::clamp(row + sign * dy, 0, height_ - 1))];
        };
        blurred[At(column, row)] = middle * (at(0) + side * (at(-1) + at(1)));
      }
    }
    colors_ = std::move(blurred);
  };
  along(1, 0);
  along(0, 1);
}

std::vector<std::uint8_t> RgbRenderer::Develop(std::size_t look) const {
  const Exposure& exposure = appearance_.exposure;
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * colors_.size());
  for (std::size_t i = 0; i < colors_.size(); ++i) {
    const LinearColor light = colors_[i] * exposure.gain;
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
      float value = light[channel];
      if (exposure.noise > 0) {
        float grain = -1.5F;  // three even numbers are nearly a normal one of spread a half
        for (std::uint32_t draw = 0; draw < 3; ++draw)
          grain += HashedNumber(seed_ + static_cast<std::uint32_t>(look),
                                static_cast<std::uint32_t>(i), 4 * channel + draw);
        value += 2 * grain * exposure.noise * std::sqrt(std::max(value, 0.0F) + 0.02F);
      }
      const float shown = std::clamp(Compressed(value), 0.0F, 1.0F);
      rgb.push_back(SrgbTable()[static_cast<std::size_t>(std::lround(4096 * shown))]);
    }
  }
  return rgb;
}

}  // namespace doorforge
