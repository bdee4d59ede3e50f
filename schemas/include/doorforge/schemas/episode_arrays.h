// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/shard.h"

namespace doorforge {

/// One array of an episode's record; see docs/format-shards.md.
struct EpisodeFeature {
  std::string name;                ///< "cloud"; the member is "cloud.npy".
  std::string type;                ///< NumPy's: "<f4" or "|u1".
  std::vector<std::size_t> shape;  ///< One decision has it; 0 stands for the number of points.
  std::string unit;
  std::string frame;
  std::string meaning;
};

/// The arrays of every episode, sorted by name: action, cloud, executed, joints, label, proprio,
/// score, state.
const std::vector<EpisodeFeature>& EpisodeFeatures();

/// Members of an episode's key: the arrays, `meta.json`, and `preview.png` unless `preview_png` is
/// empty. Deterministic.
///
/// @param meta EpisodeMetaToJson(episode), to which the caller may have added keys.
/// @throws Error(kInvalidArgument) if there are no decisions, if clouds are empty or differ in size
///     or lack labels, or if a number is not finite.
std::vector<MemberBytes> EncodeEpisode(const Episode& episode, const nlohmann::ordered_json& meta,
                                       const std::string& preview_png);

/// The arrays of an episode, within a reader's memory map. T decisions of P points.
struct EpisodeArrays {
  std::size_t decisions = 0;     ///< T >= 1
  std::size_t points = 0;        ///< P >= 1
  std::span<const float> cloud;  ///< T x P x 3, world [m]; point 0 is the nearest to the hand
  std::span<const std::uint8_t> label;  ///< T x P, PointLabel values
  std::span<const float> proprio;       ///< T x 32, see Proprioception
  std::span<const float> action;        ///< T x 9, see ActionVector
  std::span<const float> executed;      ///< T x 9, Decision::executed; empty in shards of before
  std::span<const float> joints;        ///< T x 2, hinge and handle angle before the action [rad]
  std::span<const float> score;         ///< T x 1, Decision::angle_gain_rad
  std::span<const double> state;        ///< T x 14, JointState; empty in shards of before
};

/// Throws Error(kFormat or kMissing), naming tar and member, if a member is missing or damaged or
/// its type or shape is not as above.
EpisodeArrays ViewEpisode(const ShardReader& reader, std::size_t episode);

/// The colours of an episode's clouds, sRGB, T x P x 3; empty where they have none.
///
/// @throws Error(kFormat), naming tar and member, if they are damaged or not as many as the points.
std::span<const std::uint8_t> ViewCloudColors(const ShardReader& reader, std::size_t episode);

/// The parsed meta.json. Throws Error(kFormat or kMissing).
nlohmann::ordered_json ReadEpisodeMeta(const ShardReader& reader, std::size_t episode);

}  // namespace doorforge
