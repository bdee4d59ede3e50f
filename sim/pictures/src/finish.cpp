// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "finish.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace doorforge {
namespace {

constexpr float kTurn = 6.2831853F;

inline std::uint32_t Mixed(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7FEB352DU;
  h ^= h >> 15;
  h *= 0x846CA68BU;
  return h ^ (h >> 16);
}

float Smooth(float t) { return t * t * (3 - 2 * t); }

float LatticeNumber(int x, int y, int z) {
  return HashedNumber(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                      static_cast<std::uint32_t>(z));
}

// Numbers in [0, 1) of the eight corners of a cell, the bits of whose index are x, y and z.
__attribute__((target_clones("avx2", "default"))) void CornerNumbers(std::uint32_t x,
                                                                     std::uint32_t y,
                                                                     std::uint32_t z,
                                                                     float* numbers) {
  constexpr std::uint32_t kX = 0x9E3779B1U;
  constexpr std::uint32_t kY = 0x85EBCA77U;
  constexpr std::uint32_t kZ = 0x27D4EB2FU;
  constexpr std::array<std::uint32_t, 8> kCorners = {0,  kX,      kY,      kX + kY,
                                                     kZ, kX + kZ, kY + kZ, kX + kY + kZ};
  const std::uint32_t first = x * kX + y * kY + z * kZ;
  for (std::size_t corner = 0; corner < kCorners.size(); ++corner)
    numbers[corner] =
        static_cast<float>(static_cast<std::int32_t>(Mixed(first + kCorners[corner]) >> 8)) *
        0x1p-24F;
}

float Between(float a, float b, float t) { return a + t * (b - a); }

// Noise of unit cells in [0, 1), smooth between their corners.
float NoiseAt(const Eigen::Vector3f& p) {
  const Eigen::Vector3f cell(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  alignas(32) std::array<float, 8> n;
  CornerNumbers(static_cast<std::uint32_t>(static_cast<int>(cell.x())),
                static_cast<std::uint32_t>(static_cast<int>(cell.y())),
                static_cast<std::uint32_t>(static_cast<int>(cell.z())), n.data());
  const float u = Smooth(p.x() - cell.x());
  const float v = Smooth(p.y() - cell.y());
  const float w = Smooth(p.z() - cell.z());
  return Between(Between(Between(n[0], n[1], u), Between(n[2], n[3], u), v),
                 Between(Between(n[4], n[5], u), Between(n[6], n[7], u), v), w);
}

float WoodAt(const Eigen::Vector3f& p) {
  const float swirl = NoiseAt({2 * p.x(), 1.5F * p.y(), 0.25F * p.z()});
  const float rings = 0.5F + 0.5F * std::sin(kTurn * (1.3F * p.y() + 0.8F * p.x() + 3 * swirl));
  const float grain = NoiseAt({30 * p.x(), 30 * p.y(), 1.2F * p.z()});
  return 0.7F * rings + 0.3F * grain;
}

float TilesAt(const Eigen::Vector3f& p) {
  constexpr float kJoint = 0.025F;
  // a face's own axis stands still on it, half a tile off any joint
  const Eigen::Array3f in_tile = (p.array() + 0.37F) - (p.array() + 0.37F).floor();
  int joints = 0;
  for (const float t : in_tile) joints += t < kJoint ? 1 : 0;
  return joints > 0 ? 1.0F : 0.15F * NoiseAt(7.0F * p);
}

float PlanksAt(const Eigen::Vector3f& p) {
  const float row = std::floor(p.y());
  const float shifted =
      p.x() / 7 + HashedNumber(static_cast<std::uint32_t>(static_cast<int>(row)), 1, 2);
  const float board = std::floor(shifted);
  const bool joint = p.y() - row < 0.03F || shifted - board < 0.004F;
  if (joint) return 1;
  const float shade = LatticeNumber(static_cast<int>(row), static_cast<int>(board), 5);
  return 0.5F * shade + 0.3F * NoiseAt({0.9F * p.x(), 9 * p.y(), shade * 50});
}

float TextureAt(Texture texture, const Eigen::Vector3f& p) {
  switch (texture) {
    case Texture::kPlain:
      return 0;
    case Texture::kWood:
      return WoodAt(p);
    case Texture::kSpeckle:
      return Smooth(NoiseAt(8.0F * p)) * NoiseAt(23.0F * p);
    case Texture::kBrushed:
      return NoiseAt({40 * p.x(), 40 * p.y(), 0.7F * p.z()});
    case Texture::kTiles:
      return TilesAt(p);
    case Texture::kPlanks:
      return PlanksAt(p);
  }
  return 0;
}

}  // namespace

LinearColor LinearOf(const Eigen::Vector3d& srgb) {
  LinearColor linear;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto c = static_cast<float>(std::clamp(srgb[i], 0.0, 1.0));
    linear[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
  }
  return linear;
}

LinearColor ColorAt(const Finish& finish, const Eigen::Vector3f& point_m) {
  if (finish.texture == Texture::kPlain) return finish.color;
  const float t = TextureAt(finish.texture, point_m / finish.scale_m);
  return finish.color + t * (finish.second - finish.color);
}

float HashedNumber(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const std::uint32_t h = Mixed(a * 0x9E3779B1U ^ Mixed(b * 0x85EBCA77U + 0xC2B2AE3DU) ^
                                (c * 0x27D4EB2FU + 0x165667B1U));
  return static_cast<float>(h >> 8) * 0x1p-24F;
}

}  // namespace doorforge
