// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/mlp.h"
#include "doorforge/schemas/hand_policy.h"
#include "doorforge/schemas/seen_parts.h"

namespace doorforge {

/// The stage that a policy's record names where the policy does all of an episode.
inline constexpr const char* kWholeStage = "whole";

/// What a network is told of a HandState: 40 numbers of about the size of 1, see HandFeaturesOf().
inline constexpr int kHandFeatures = 40;
using HandFeatures = std::array<float, kHandFeatures>;

/// In this order, all in the world, clipped to [-5, 5]:
/// - from the tool centre to the grasp [0.1 m], and by what turn [0.5 rad], the nearer of the two
///   that the alike fingers have;
/// - velocity of the tool centre [0.2 m/s] and of its turn [1 rad/s];
/// - both fingers' openings [0.04 m] and the mean of their speeds [0.1 m/s]; 1 where they are told
///   to close, else -1;
/// - hinge [0.5 rad], its speed [0.5 rad/s], handle [0.5 rad], its speed [0.5 rad/s], how far the
///   handle is still to turn [0.5 rad], 1 where the leaf is locked, else 0;
/// - from the hinge's axis to the tool centre, square to it [0.5 m]; the hinge's axis;
/// - from the handle's axis to the tool centre, square to it [0.1 m]; the handle's axis;
/// - z and y of the tool.
HandFeatures HandFeaturesOf(const HandState& state);

/// The turn in the world that takes the tool to the grasp, axis times angle [rad]. The two fingers
/// are alike: of the two turns that do it, the smaller.
Eigen::Vector3d TurnToGrasp(const HandState& state);

/// What a network says: three numbers for the move, three for the turn, in units of the task's most
/// and clipped to [-1, 1]; the last closes the fingers above 0.5, opens them below -0.5, and
/// between leaves them as they are told to be.
inline constexpr int kHandActions = 7;
HandCommand HandCommandOf(std::span<const float> action, const HandState& state,
                          const HandTaskConfig& task);

/// What a policy of the stage kWholeStage was made from.
struct HandProvenance {
  std::string method;  ///< "ppo" or "dagger".
  std::string code_version;
  std::string config = {};  ///< The training's settings as one JSON text.
  std::uint64_t decisions = 0;
  SeenParts trained_on = {};
  std::string teacher_sha256 = {};  ///< The teacher's weights; empty: nobody taught it.
};

/// The record of such a policy's folder.
struct HandPolicyRecord {
  MlpShape shape = {kHandFeatures, 64, kHandActions};
  std::vector<float> parameters;  ///< Of MlpLayout(shape).
  HandTaskConfig task;
  HandProvenance provenance;
  std::string weights_sha256 = {};  ///< Filled in by the reader.
};

/// Writes `policy.safetensors` (in single precision, "actor.<layer>.weight" and ".bias") and then
/// `policy.json` (schema doorforge.policy, stage "whole"). Equal arguments give equal bytes.
void WriteHandPolicy(const std::filesystem::path& folder, const HandPolicyRecord& record);

/// Throws Error(kMissing), Error(kFormat) on a damaged record, one of another stage or of a policy
/// that looks, or weights that do not belong to it.
HandPolicyRecord ReadHandPolicy(const std::filesystem::path& folder);

/// Acts by the mean of such a network, without noise.
class HandNetworkPolicy : public HandPolicy {
 public:
  explicit HandNetworkPolicy(const HandPolicyRecord& record);
  HandCommand Act(const HandState& state, const LabelledCloud& cloud) override;
  /// What the network says, of which Act() makes a command.
  std::vector<float> ActionOf(const HandState& state) const;
  const HandTaskConfig& task() const override { return task_; }

 private:
  HandTaskConfig task_;
  Mlp network_;
};

}  // namespace doorforge
