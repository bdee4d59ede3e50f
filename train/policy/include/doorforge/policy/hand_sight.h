// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/point_net.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/hand_policy.h"

namespace doorforge {

/// Numbers of a point that a hand which looks is told: where it is, three, and which of four parts
/// it is of.
inline constexpr int kSightPoint = 7;
/// Numbers that it is told of itself.
inline constexpr int kSightOwn = 19;

/// What a hand sees and knows of itself at a decision; nothing of the door's joints.
struct HandSight {
  std::vector<float> xyz;           ///< N x 3, from the tool centre along the world's axes [0.1 m].
  std::vector<std::uint8_t> label;  ///< PointLabel of each.
  /// The tool centre [m], its velocity [0.2 m/s] and that of its turn [1 rad/s], both fingers'
  /// openings [0.04 m], the mean of their speeds [0.1 m/s], 1 where they are told to close, else
  /// -1; z and y of the tool. In the world, clipped to [-5, 5].
  std::array<float, kSightOwn> own{};
};

/// Reads nothing of `state` but the tool and the fingers. A cloud without points is one point at
/// the tool centre that is of no part.
HandSight HandSightOf(const HandState& state, const LabelledCloud& cloud);

/// Appends what a network reads of points: the position and 1 for the part among handle, leaf,
/// frame and robot that it is of, else 0.
void AppendSightPoints(std::span<const float> xyz, std::span<const std::uint8_t> label,
                       std::vector<float>& numbers);

/// The sizes of a network with these layers that reads a HandSight and says kHandActions numbers.
PointNetShape SightShape(PointNetShape layers);

/// The record of the folder of a policy that looks and does all of an episode.
struct SightPolicyRecord {
  PointNetShape shape = SightShape({});
  std::vector<float> parameters;  ///< Of PointNetLayout(shape).
  HandTaskConfig task;
  HandLook look;
  HandProvenance provenance;
  std::string weights_sha256 = {};  ///< Filled in by the reader.
};

/// Writes `policy.safetensors` (in single precision, "actor.<layer>.weight" and ".bias") and then
/// `policy.json` (schema doorforge.policy, stage "whole", network "point_net"). Equal arguments
/// give equal bytes.
void WriteSightPolicy(const std::filesystem::path& folder, const SightPolicyRecord& record);

/// Throws as ReadHandPolicy(), and Error(kFormat) for a policy of true states.
SightPolicyRecord ReadSightPolicy(const std::filesystem::path& folder);

/// Acts by such a network.
class HandSightPolicy : public HandPolicy {
 public:
  explicit HandSightPolicy(const SightPolicyRecord& record);
  HandCommand Act(const HandState& state, const LabelledCloud& cloud) override;
  const HandTaskConfig& task() const override { return task_; }
  std::optional<HandLook> look() const override { return look_; }

 private:
  HandTaskConfig task_;
  HandLook look_;
  PointNet network_;
};

}  // namespace doorforge
