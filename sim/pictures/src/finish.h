// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace doorforge {

using LinearColor = Eigen::Array3f;  ///< Linear light, each in [0, 1] for surfaces.

/// sRGB, each in [0, 1], as linear light.
LinearColor LinearOf(const Eigen::Vector3d& srgb);

/// How two colours are laid over a surface, as a function of the point alone.
enum class Texture : std::uint8_t {
  kPlain,    ///< One colour.
  kWood,     ///< Grain along z, rings across.
  kSpeckle,  ///< Grains, as of carpet or terrazzo.
  kBrushed,  ///< Fine lines along z.
  kTiles,    ///< Squares with joints.
  kPlanks,   ///< Boards along x, each of its own shade.
};
inline constexpr std::uint32_t kTextureCount = 6;

/// What a surface is made of.
struct Finish {
  LinearColor color{0.5F, 0.5F, 0.5F};
  LinearColor second{0.5F, 0.5F, 0.5F};  ///< Where the texture is at 1.
  Texture texture = Texture::kPlain;
  float scale_m = 0.1F;    ///< The texture repeats after it.
  float gloss = 0.05F;     ///< Height of a lamp's highlight,
  float exponent = 20.0F;  ///< and how sharp it is.
  float mirror = 0.0F;     ///< Share of the room that is mirrored, seen straight on.
  float clear = 0.0F;      ///< Share of what lies behind that is seen through it.
};

/// The colour at a point, in metres in the frame of what has the finish.
LinearColor ColorAt(const Finish& finish, const Eigen::Vector3f& point_m);

/// A number in [0, 1) that depends on all three.
float HashedNumber(std::uint32_t a, std::uint32_t b, std::uint32_t c);

}  // namespace doorforge
