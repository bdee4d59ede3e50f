// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/lone_policy.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/turning_policy.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {
namespace {

const int kPoints = CloudConfig{}.point_count;

}  // namespace

LonePolicy::LonePolicy(const std::string& word, Stage stage, const PolicyOptions& options)
    : word_(word) {
  Require(stage == Stage::kOpen || stage == Stage::kHandle, ErrorCode::kInvalidArgument,
          "stage: there is no policy of motions at \"" + std::string(NameOf(stage)) +
              "\"; there are handle, open");
  const PolicyChoice choice =
      BuiltInPolicies().Find(stage, word, stage == Stage::kOpen ? "--opener" : "--handler");
  belief_ = LoadDoorBelief(stage == Stage::kOpen ? choice.folder : "", options);
  if (choice.IsFolder()) {
    Load(choice.folder.string(), stage, options);
  } else {
    PolicySettings settings;
    settings.handle_expert = HandleExpertConfig{};
    policy_ = choice.motion->make(settings);
    remembered_ = choice.motion->remembered;
  }
  Reset();
}

void LonePolicy::Load(const std::string& folder, Stage stage, const PolicyOptions& options) {
  PolicyRecord record = ReadPolicy(folder, NameOf(stage));
  const auto classifier = stage == Stage::kHandle
                              ? ReadTurnedClassifier(folder, record.provenance.dataset_sha256)
                              : std::nullopt;
  if (const NetworkView& view = record.networks.normalisation.view; stage == Stage::kHandle)
    remembered_ = {view.remembered_finer, static_cast<double>(view.cloud_crop_radius_m)};
  if (remembered_.IsOn()) tcp_in_hand_m_ = LoadMobileFranka().hand_from_tcp().translation();
  policy_ = LoadPolicy(folder, options, stage, belief_);
  if (!classifier) return;
  auto turning =
      std::make_unique<TurningPolicy>(std::move(policy_), *classifier, options.switch_probability);
  switch_ = turning.get();
  policy_ = std::move(turning);
}

void LonePolicy::Begin(std::optional<LabelledCloud> before) {
  Require(!before || !before->label.empty(), ErrorCode::kInvalidArgument,
          "before: a cloud without a point; nothing of the door was seen");
  before_ = std::move(before);
  std::optional<LabelledCloud> seen;
  if (before_ && WantsPicture()) {
    // the side is told from as many points as it was learned from
    const auto* first = before_->xyz.data();
    seen = *before_;
    if (static_cast<int>(before_->label.size()) != kPoints)
      seen = SampleCloud(*before_, Eigen::Vector3f(first[0], first[1], first[2]).cast<double>(),
                         {.point_count = kPoints})
                 .cloud;
  }
  belief_->Begin(std::move(seen));
  policy_->Reset();
}

Action LonePolicy::Act(const Observation& observation) {
  if (!remembered_.IsOn()) return policy_->Act(observation);
  if (!before_)
    throw Error(ErrorCode::kInvalidArgument,
                word_ +
                    ": this policy remembers what the camera saw before the robot came, and "
                    "nobody has given it: pass that cloud as \"before\" when an episode begins, or "
                    "join the clouds yourself and say \"remembered\": true with them");
  const Proprioception& felt = observation.proprioception;
  const Eigen::Vector3d tcp_m =
      HandPositionOf(felt).cast<double>() + HandRotationOf(felt) * tcp_in_hand_m_;
  Observation joined = observation;
  joined.cloud =
      JoinedCloud(std::move(joined.cloud), *before_, tcp_m, {kPoints, remembered_.crop_radius_m});
  return policy_->Act(joined);
}

}  // namespace doorforge
