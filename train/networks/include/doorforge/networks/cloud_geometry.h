// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/networks/instruction_set.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// Points in every cloud the networks read.
inline constexpr int kCloudPoints = 4096;

/// One set abstraction of PointNet++ (single-scale, UniDoorManip's table).
struct SetAbstractionShape {
  int points;
  float radius_m;
  int samples;
};
inline constexpr std::array<SetAbstractionShape, 4> kSetAbstractions = {
    SetAbstractionShape{1024, 0.1F, 32}, SetAbstractionShape{256, 0.2F, 32},
    SetAbstractionShape{64, 0.4F, 32}, SetAbstractionShape{16, 0.8F, 32}};

/// What the encoder needs to know about where the points of one cloud lie, and nothing of any
/// weight: computed once per cloud. It covers exactly the part of the network that the features of
/// the chosen output points depend on; all indices are into that part.
struct CloudGeometry {
  /// A level's centres that matter, each with its ball in the level below.
  struct Level {
    std::vector<float> centre_xyz;  ///< n x 3, relative to the cloud's centre [m * point_scale].
    std::vector<std::uint32_t> ball_begin;  ///< n + 1 offsets into `member`.
    std::vector<std::uint16_t> member;      ///< Rows of the level below, without padding.

    std::size_t size() const { return centre_xyz.size() / 3; }
  };
  /// A level's points whose upsampled feature matters.
  struct Upsampling {
    std::vector<std::uint16_t> skip;       ///< Row of each in its level; targets are in this order.
    std::vector<std::uint16_t> neighbour;  ///< Targets x 3: targets of the next coarser upsampling
                                           ///< (of levels[3] for upsampling[3]).
    std::vector<float> weight;             ///< Targets x 3.

    std::size_t size() const { return skip.size(); }
  };
  std::vector<float> xyz;  ///< The window's points x 3, from its centre [m * point_scale]: level 0.
  std::vector<std::uint8_t> rgb;  ///< Their colours, sRGB; empty: none are known.
  std::array<Level, 4> levels;
  std::array<Upsampling, 4> upsampling;  ///< [0] ends in the output points.
  /// Which targets of upsampling[0] are read; empty: all. The others are there for the sake of
  /// statistics.
  std::vector<std::uint16_t> read;
};

/// From where a cloud is seen, and how much of it.
struct CloudWindow {
  std::array<float, 3> centre{};  ///< Subtracted from every point [m].
  /// Points farther from point 0 than this [m] are left out, but never more than leaves 1024 of
  /// them; 0: all stay.
  float crop_radius_m = 0;
  /// The window's points are told this many times as far from its centre as they are, so that the
  /// fixed radii of the network span smaller things.
  float point_scale = 1;
};

/// A cloud that somebody else keeps.
struct CloudView {
  std::span<const float> xyz;           ///< N x 3 [m], world frame.
  std::span<const std::uint8_t> rgb{};  ///< sRGB, N x 3; empty: no colours.

  CloudView(std::span<const float> points, std::span<const std::uint8_t> colors = {})
      : xyz(points), rgb(colors) {}
  CloudView(const std::vector<float>& points) : xyz(points) {}
  CloudView(const LabelledCloud& cloud) : xyz(cloud.xyz), rgb(cloud.rgb) {}
};

/// @param cloud 4096 points of finite numbers.
/// @param outputs Points whose feature will be read, ascending; the policies read point 0. All of
///     them must be in the window.
/// @throws Error(kInvalidArgument) on another number of points or colours, numbers that are not
///     finite, or an output outside of the window.
CloudGeometry BuildGeometry(const CloudView& cloud, const CloudWindow& window,
                            std::span<const std::uint16_t> outputs, InstructionSet set);

/// All points and all balls of the window, as batch normalisation wants them in training; `outputs`
/// are read, else as BuildGeometry().
CloudGeometry BuildWholeGeometry(const CloudView& cloud, const CloudWindow& window,
                                 std::span<const std::uint16_t> outputs, InstructionSet set);

/// BuildGeometry() for point 0 alone.
CloudGeometry BuildGeometry(const CloudView& cloud, const CloudWindow& window);

}  // namespace doorforge
