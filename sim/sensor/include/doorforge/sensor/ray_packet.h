// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "doorforge/sensor/scene_geometry.h"

namespace doorforge {

/// Sixteen rays in the world, each of which may be left out.
struct RayPacket {
  static constexpr std::size_t kSize = 16;
  using Lanes = std::array<float, kSize>;

  alignas(64) Lanes origin_x{};
  alignas(64) Lanes origin_y{};
  alignas(64) Lanes origin_z{};
  alignas(64) Lanes direction_x{};
  alignas(64) Lanes direction_y{};
  alignas(64) Lanes direction_z{};
  alignas(64) Lanes reach{};  ///< In lengths of the direction; what is farther is not met.
  std::uint32_t rays = 0;     ///< Bit i: ray i is there.

  void Set(std::size_t lane, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
           float farthest) {
    origin_x[lane] = origin.x();
    origin_y[lane] = origin.y();
    origin_z[lane] = origin.z();
    direction_x[lane] = direction.x();
    direction_y[lane] = direction.y();
    direction_z[lane] = direction.z();
    reach[lane] = farthest;
    rays |= 1U << lane;
  }
};

/// What a packet's rays meet first.
struct PacketHits {
  alignas(64) RayPacket::Lanes distance{};  ///< In lengths of the direction.
  alignas(64) RayPacket::Lanes u{};         ///< Barycentric coordinates of the second corner,
  alignas(64) RayPacket::Lanes v{};         ///< and of the third.
  std::array<std::int32_t, RayPacket::kSize> mesh{};       ///< Index into the scene's meshes.
  std::array<std::uint32_t, RayPacket::kSize> triangle{};  ///< Index into the mesh's triangles.
  std::uint32_t hits =
      0;  ///< Bit i: ray i met something; what stands for the others means nothing.
};

/// Casts the rays of a packet at the scene, its links where they were last put. Distances are
/// Embree's own: they may differ in their last digits between instruction sets.
PacketHits CastRays(SceneGeometry& scene, const RayPacket& packet);

/// A box in the world that holds everything there is to meet; empty if there is nothing.
Eigen::AlignedBox3f BoundsOf(SceneGeometry& scene);

/// Bit i: something is on ray i. Cheaper than CastRays().
std::uint32_t ObstructedRays(SceneGeometry& scene, const RayPacket& packet);

}  // namespace doorforge
