// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/mlp.h"
#include "doorforge/policy/hand_sight.h"

namespace doorforge {

/// What a hand sees at a decision as numbers of a network that does not learn any more: the
/// features that the network of a SightPolicyRecord has of the cloud, and behind them HandSight's
/// own numbers. Immutable; serves several threads.
class FrozenSight {
 public:
  /// @throws Error(kInvalidArgument) as PointNet.
  FrozenSight(const PointNetShape& shape, std::span<const float> parameters, const HandLook& look);

  int size() const { return network_.shape().cloud_features + kSightOwn; }
  const HandLook& look() const { return look_; }
  std::vector<float> NumbersOf(const HandState& state, const LabelledCloud& cloud) const;

 private:
  HandLook look_;
  PointNet network_;
};

/// The record of the folder of a policy that acts on such numbers.
struct FrozenPolicyRecord {
  PointNetShape sight_shape = SightShape({});
  std::vector<float> sight;  ///< Of PointNetLayout(sight_shape).
  HandLook look;
  MlpShape shape;                 ///< It reads FrozenSight::size() numbers and says kHandActions.
  std::vector<float> parameters;  ///< Of MlpLayout(shape).
  HandTaskConfig task;
  HandProvenance provenance;        ///< `teacher_sha256` are the weights whose features it reads.
  std::string weights_sha256 = {};  ///< Filled in by the reader.
};

/// Writes `policy.safetensors` (in single precision, "sight" and "actor" before ".<layer>.weight"
/// and ".bias") and then `policy.json` (schema doorforge.policy, stage "whole", network
/// "frozen_point_net"). Equal arguments give equal bytes.
void WriteFrozenPolicy(const std::filesystem::path& folder, const FrozenPolicyRecord& record);

/// Throws as ReadHandPolicy().
FrozenPolicyRecord ReadFrozenPolicy(const std::filesystem::path& folder);

/// Acts by the mean of such a network, without noise.
class FrozenSightPolicy : public HandPolicy {
 public:
  explicit FrozenSightPolicy(const FrozenPolicyRecord& record);
  HandCommand Act(const HandState& state, const LabelledCloud& cloud) override;
  const HandTaskConfig& task() const override { return task_; }
  std::optional<HandLook> look() const override { return sight_.look(); }

 private:
  HandTaskConfig task_;
  FrozenSight sight_;
  Mlp network_;
};

}  // namespace doorforge
