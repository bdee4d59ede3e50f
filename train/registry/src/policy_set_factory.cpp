// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_set_factory.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/policy/belief_grasp.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/turning_policy.h"
#include "doorforge/policy/whole_policy.h"

namespace doorforge {
namespace {

// Beside one who does everything nobody else acts.
const PolicyWords& Checked(const PolicyWords& words) {
  if (words.whole.empty()) return words;
  static const PolicyWords nobody_else;
  for (const std::string& word : {words.opener, words.handler, words.grasper})
    Require(word.empty() || word == kExpertPolicy, ErrorCode::kInvalidArgument,
            "--whole " + words.whole + ": does everything; leave \"" + word + "\" out, or it");
  Require(std::filesystem::is_directory(words.whole), ErrorCode::kMissing,
          "--whole " + words.whole + ": no such folder; `doorforge reinforce` writes one");
  return nobody_else;
}

}  // namespace

PolicySetFactory::PolicySetFactory(const PolicyRegistry& registry, const PolicyWords& words,
                                   PolicySettings settings, SwitchSource switch_source)
    : settings_(std::move(settings)),
      switch_source_(switch_source),
      opener_(registry.Find(Stage::kOpen, Checked(words).opener, "--opener")),
      handler_(registry.Find(Stage::kHandle, Checked(words).handler, "--handler")),
      grasper_(registry.Find(Stage::kGrasp, Checked(words).grasper, "--grasper")),
      whole_(words.whole) {}

PolicySet PolicySetFactory::Make() const {
  PolicySet set;
  const std::shared_ptr<DoorBelief> belief = LoadDoorBelief(opener_.folder, settings_.network);
  set.memory = belief;
  set.grasps = settings_.grasps;
  AddOpener(set, belief);
  AddHandler(set, belief);
  AddGrasper(set, belief);
  if (!whole_.empty()) AddWhole(set);
  return set;
}

void PolicySetFactory::AddWhole(PolicySet& set) const {
  WholePolicy whole = ReadWholePolicy(whole_);
  set.whole = std::move(whole.hand);
  if (!whole.stages) return;
  set.grasp = std::move(whole.stages->grasp);
  set.grasp_resolution_scale = whole.stages->resolution_scale;
  set.handle = std::move(whole.stages->handle);
  set.open = std::move(whole.stages->open);
}

bool PolicySetFactory::IsExpertAlone() const {
  return whole_.empty() && opener_.IsExpert() && handler_.IsExpert() && grasper_.IsExpert();
}

bool PolicySetFactory::PredictsSwitch() const {
  return handler_.IsFolder() && switch_source_ == SwitchSource::kPolicy;
}

RememberedViewConfig PolicySetFactory::Remembered() const {
  if (!handler_.IsFolder()) return handler_.motion->remembered;
  const NetworkView view =
      ReadPolicy(handler_.folder, NameOf(Stage::kHandle)).networks.normalisation.view;
  return {view.remembered_finer, static_cast<double>(view.cloud_crop_radius_m)};
}

void PolicySetFactory::AddOpener(PolicySet& set, const std::shared_ptr<DoorBelief>& belief) const {
  set.open = opener_.IsFolder()
                 ? LoadPolicy(opener_.folder, settings_.network, Stage::kOpen, belief)
                 : opener_.motion->make(settings_);
  Require(set.open != nullptr, ErrorCode::kInvalidArgument,
          "the policy \"" + opener_.word + "\" is to open doors, and its row makes none");
}

void PolicySetFactory::AddHandler(PolicySet& set, const std::shared_ptr<DoorBelief>& belief) const {
  if (!handler_.IsFolder()) {
    set.handle = handler_.motion->make(settings_);
    if (switch_source_ == SwitchSource::kPolicy)
      set.handle_turned = dynamic_cast<StageSwitch*>(set.handle.get());
  } else if (PredictsSwitch()) {
    auto handler = LoadTurningPolicy(handler_.folder, settings_.network, belief);
    set.handle_turned = handler.get();
    set.handle = std::move(handler);
  } else {
    set.handle = LoadPolicy(handler_.folder, settings_.network, Stage::kHandle, belief);
  }
}

void PolicySetFactory::AddGrasper(PolicySet& set, const std::shared_ptr<DoorBelief>& belief) const {
  if (grasper_.IsFolder()) {
    set.grasp = std::make_unique<BeliefGrasp>(
        LoadGraspPolicy(grasper_.folder, settings_.network_grasp), belief);
    set.grasp_resolution_scale = settings_.network_grasp_resolution;
  } else {
    set.grasp = grasper_.grasp->make(settings_);
    set.grasp_resolution_scale = grasper_.grasp->resolution_scale;
  }
}

}  // namespace doorforge
