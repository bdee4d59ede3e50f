// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/turning_policy.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

TurningPolicy::TurningPolicy(std::unique_ptr<Policy> policy, const TurnedClassifier& classifier,
                             double switch_probability)
    : policy_(std::move(policy)),
      mirrors_(dynamic_cast<MirroringPolicy*>(policy_.get())),
      classifier_(classifier),
      switch_probability_(switch_probability) {
  Require(switch_probability > 0 && switch_probability < 1, ErrorCode::kInvalidConfig,
          "policy.switch_probability: must lie between 0 and 1");
}

void TurningPolicy::Reset() {
  policy_->Reset();
  first_.reset();
  first_before_.reset();
  turned_ = turned_before_ = false;
}

Action TurningPolicy::Act(const Observation& observation) {
  Action action = policy_->Act(observation);
  first_before_ = first_;
  turned_before_ = turned_;
  if (!first_) first_ = observation.proprioception;
  HandMotion motion = HandMotionOf(*first_, observation.proprioception, ToVector(action));
  // the classifier, too, has learned doors hinged left with usual handles
  if (mirrors_ != nullptr && mirrors_->guess().side == HingeSide::kRight)
    motion = MirroredSideways(motion);
  if (mirrors_ != nullptr && mirrors_->IsUpsideDown()) motion = MirroredUpright(motion);
  turned_ = turned_ || classifier_.Probability(motion) >= switch_probability_ ||
            (mirrors_ != nullptr && mirrors_->IsStalled());
  return action;
}

void TurningPolicy::TakeBack() {
  if (mirrors_ != nullptr) mirrors_->TakeBack();
  first_ = first_before_;
  turned_ = turned_before_;
}

std::unique_ptr<TurningPolicy> LoadTurningPolicy(const std::filesystem::path& folder,
                                                 const PolicyOptions& options,
                                                 std::shared_ptr<DoorBelief> belief) {
  PolicyRecord record = ReadPolicy(folder, "handle");
  const auto classifier = ReadTurnedClassifier(folder, record.provenance.dataset_sha256);
  if (!classifier)
    throw Error(ErrorCode::kInvalidArgument,
                folder.string() +
                    ": this policy cannot tell when the handle is turned (it has no "
                    "turned.safetensors, which earlier builds did not write); run its training "
                    "command again with --resume, which adds it, or use the privileged switch");
  return std::make_unique<TurningPolicy>(
      MakePolicy({std::move(record.networks), Stage::kHandle}, options, std::move(belief)),
      *classifier, options.switch_probability);
}

}  // namespace doorforge
