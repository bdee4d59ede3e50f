// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/stage_policies.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/policy/stage_policy.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

void CheckStages(const CollectionWords& words, Stage stage) {
  Require(words.handler == kExpertPolicy || stage == Stage::kGrasp, ErrorCode::kInvalidArgument,
          "--handler: belongs to `datagen grasp`, where the handle is turned after the stage that "
          "is recorded");
  Require(words.opener == kExpertPolicy || stage != Stage::kOpen, ErrorCode::kInvalidArgument,
          "--opener: belongs to `datagen handle` and `datagen grasp`, where the door is opened "
          "after the stage that is recorded");
}

// A policy that takes the clouds of the collection.
TrainedPolicy ReadFitting(const std::string& folder, Stage stage, const std::string& role,
                          const CloudConfig& cloud) {
  TrainedPolicy policy = ReadTrainedPolicy(folder, stage, role);
  Require(policy.cloud_points == 0 || policy.cloud_points == cloud.point_count,
          ErrorCode::kInvalidArgument,
          folder + ": --" + role + " takes clouds of " + std::to_string(policy.cloud_points) +
              " points; config.cloud.point_count is " + std::to_string(cloud.point_count));
  return policy;
}

std::optional<TrainedPolicy> LearnerOf(const StageConfig& config, const CollectionWords& words) {
  CheckStages(words, config.stage);
  if (words.learner.empty()) return std::nullopt;
  return ReadFitting(words.learner, config.stage, "learner", config.cloud);
}

std::optional<TrainedPolicy> TrainedOf(const PolicyChoice& choice, Stage stage,
                                       const std::string& role, const CloudConfig& cloud) {
  if (!choice.IsFolder()) return std::nullopt;
  return ReadFitting(choice.folder.string(), stage, role, cloud);
}

PolicySetFactory FactoryOf(const StageConfig& config, const CollectionWords& words,
                           const PolicyRegistry& registry) {
  PolicySettings settings;
  settings.random_grasp = config.grasp;
  settings.opening_expert = config.expert;
  if (config.stage != Stage::kOpen) settings.handle_expert = config.handle;
  const bool takes_hold = config.stage == Stage::kGrasp && !words.learner.empty();
  const PolicyWords all{words.opener, words.handler, takes_hold ? words.learner : "random"};
  return {registry, all, settings, SwitchSource::kSimulator};
}

// A learner is corrected on the clouds that are recorded, so they are to be such as it takes.
void CheckLearnersClouds(const std::optional<TrainedPolicy>& learner, const StageConfig& config) {
  if (!learner || config.stage != Stage::kHandle) return;
  const RememberedViewConfig& its = learner->remembered;
  const RememberedViewConfig& recorded = config.remembered;
  const bool alike = its.resolution_scale == recorded.resolution_scale &&
                     (!its.IsOn() || std::abs(its.crop_radius_m - recorded.crop_radius_m) < 1e-6);
  char settings[120];
  std::snprintf(settings, sizeof settings, "--set remembered.finer=%d --set remembered.within_m=%g",
                its.resolution_scale, its.crop_radius_m);
  Require(alike, ErrorCode::kInvalidArgument,
          learner->folder.string() +
              ": the learner takes clouds that remember something else than those that are "
              "recorded; pass " +
              settings);
}

Json ActorRecord(const std::optional<TrainedPolicy>& trained, const PolicyChoice& choice) {
  return trained ? DatasetPolicyToJson(trained->identity) : Json(choice.Name());
}

std::string OwnText(const PolicyChoice& choice, const std::string& role) {
  return choice.IsOwn() ? "# " + role + ": the policy " + choice.Name() + "\n" : "";
}

}  // namespace

StagePolicies::StagePolicies(const StageConfig& config, const CollectionWords& words,
                             const PolicyRegistry& registry)
    : stage_(config.stage),
      learner_(LearnerOf(config, words)),
      factory_(FactoryOf(config, words, registry)),
      handler_(TrainedOf(factory_.handler(), Stage::kHandle, "handler", config.cloud)),
      opener_(TrainedOf(factory_.opener(), Stage::kOpen, "opener", config.cloud)),
      sets_([this] { return factory_.Make(); }) {
  if (handler_) remembered_ = handler_->remembered;
  // weights of another network are refused here, not in the first episode
  sets_.Take();
  if (!learner_ || stage_ == Stage::kGrasp) return;
  drivers_ = std::make_unique<ObjectPool<std::unique_ptr<Policy>>>(
      [this] { return LoadPolicy(learner_->folder, {}, stage_); });
  drivers_->Take();
  CheckLearnersClouds(learner_, config);
}

std::vector<TrainedPolicy> StagePolicies::Trained() const {
  std::vector<TrainedPolicy> trained;
  for (const auto& policy : {handler_, opener_, learner_}) {
    if (policy) trained.push_back(*policy);
  }
  return trained;
}

std::string StagePolicies::Text() const {
  std::string text;
  for (const TrainedPolicy& policy : Trained())
    text += "# " + TrainedPolicyText(policy) + ", loops for " + InferenceKernelName() + "\n";
  return text + OwnText(factory_.handler(), "handler") + OwnText(factory_.opener(), "opener");
}

Json StagePolicies::Record(bool samples_grasp) const {
  const bool learner_holds = learner_ && stage_ == Stage::kGrasp;
  const Json sampled = learner_holds ? DatasetPolicyToJson(learner_->identity) : Json("sampled");
  Json record = {{"grasp", samples_grasp ? sampled : Json(kExpertPolicy)},
                 {"unlock", ActorRecord(handler_, factory_.handler())},
                 {"open", ActorRecord(opener_, factory_.opener())}};
  if (HasDriver()) record["learner"] = DatasetPolicyToJson(learner_->identity);
  return record;
}

}  // namespace doorforge
