// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/ray_packet.h"

#include <algorithm>

#include "embree_scene.h"

namespace doorforge {
namespace {

constexpr std::size_t kLanes = RayPacket::kSize;

struct ValidLanes {
  alignas(64) std::array<int, kLanes> lanes{};

  explicit ValidLanes(std::uint32_t rays) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      lanes[lane] = (rays >> lane & 1U) != 0 ? -1 : 0;
  }
};

void Fill(const RayPacket& packet, RTCRay16& ray) {
  std::ranges::copy(packet.origin_x, ray.org_x);
  std::ranges::copy(packet.origin_y, ray.org_y);
  std::ranges::copy(packet.origin_z, ray.org_z);
  std::ranges::copy(packet.direction_x, ray.dir_x);
  std::ranges::copy(packet.direction_y, ray.dir_y);
  std::ranges::copy(packet.direction_z, ray.dir_z);
  std::ranges::copy(packet.reach, ray.tfar);
  std::ranges::fill(ray.tnear, 0.0F);
  std::ranges::fill(ray.time, 0.0F);
  std::ranges::fill(ray.mask, 0xFFFFFFFFU);  // Debian's Embree tests masks; 0 would see nothing
  std::ranges::fill(ray.id, 0U);
  std::ranges::fill(ray.flags, 0U);
}

}  // namespace

PacketHits CastRays(SceneGeometry& scene, const RayPacket& packet) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit16 traced;
  Fill(packet, traced.ray);
  std::ranges::fill(traced.hit.geomID, RTC_INVALID_GEOMETRY_ID);
  std::ranges::fill(traced.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
  const ValidLanes valid(packet.rays);
  const DenormalsAreZero denormals_are_zero;
  rtcIntersect16(valid.lanes.data(), scene.runtime().top(), &context, &traced);
  PacketHits found;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const bool hit = valid.lanes[lane] != 0 && traced.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    found.hits |= static_cast<std::uint32_t>(hit) << lane;
    found.distance[lane] = traced.ray.tfar[lane];
    found.u[lane] = traced.hit.u[lane];
    found.v[lane] = traced.hit.v[lane];
    found.mesh[lane] = static_cast<std::int32_t>(traced.hit.instID[0][lane]);
    found.triangle[lane] = traced.hit.primID[lane];
  }
  return found;
}

Eigen::AlignedBox3f BoundsOf(SceneGeometry& scene) {
  RTCBounds bounds;
  rtcGetSceneBounds(scene.runtime().top(), &bounds);
  return {Eigen::Vector3f(bounds.lower_x, bounds.lower_y, bounds.lower_z),
          Eigen::Vector3f(bounds.upper_x, bounds.upper_y, bounds.upper_z)};
}

std::uint32_t ObstructedRays(SceneGeometry& scene, const RayPacket& packet) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay16 traced;
  Fill(packet, traced);
  const ValidLanes valid(packet.rays);
  const DenormalsAreZero denormals_are_zero;
  rtcOccluded16(valid.lanes.data(), scene.runtime().top(), &context, &traced);
  std::uint32_t obstructed = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    obstructed |= static_cast<std::uint32_t>(valid.lanes[lane] != 0 && traced.tfar[lane] < 0)
                  << lane;
  return obstructed;
}

}  // namespace doorforge
