// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_registry.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

bool IsWord(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

void RequireNew(const std::vector<std::string>& names, const std::string& name, Stage stage) {
  Require(IsWord(name), ErrorCode::kInvalidArgument,
          "a policy's name: found \"" + name + "\", expected letters, digits, _ and -");
  Require(std::ranges::find(names, name) == names.end(), ErrorCode::kInvalidArgument,
          "two policies of the stage \"" + std::string(NameOf(stage)) + "\" are called \"" + name +
              "\"; give one of them another name");
}

std::string FolderText(Stage stage) {
  return "a folder that `doorforge train " + std::string(NameOf(stage)) + "` wrote";
}

// A word that could be no name was meant as a path.
bool LooksLikeAPath(const std::string& word) { return !IsWord(word); }

}  // namespace

std::string PolicyChoice::Name() const {
  if (!IsFolder()) return word;
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void PolicyRegistry::Add(MotionPolicyRow row) {
  Require(row.stage != Stage::kGrasp && row.make != nullptr, ErrorCode::kInvalidArgument,
          "the policy \"" + row.name + "\" opens or turns the handle, and says how it is made");
  RequireNew(Names(row.stage), row.name, row.stage);
  motion_.push_back(std::move(row));
}

void PolicyRegistry::Add(GraspPolicyRow row) {
  Require(row.make != nullptr && row.resolution_scale >= 1, ErrorCode::kInvalidArgument,
          "the grasp policy \"" + row.name +
              "\" says how it is made and sees at least what the scene's camera does");
  RequireNew(Names(Stage::kGrasp), row.name, Stage::kGrasp);
  grasp_.push_back(std::move(row));
}

std::vector<std::string> PolicyRegistry::Names(Stage stage) const {
  std::vector<std::string> names;
  if (stage == Stage::kGrasp) {
    for (const GraspPolicyRow& row : grasp_) names.push_back(row.name);
    return names;
  }
  for (const MotionPolicyRow& row : motion_) {
    if (row.stage == stage) names.push_back(row.name);
  }
  return names;
}

std::string PolicyRegistry::Choices(Stage stage) const {
  std::string text;
  for (const std::string& name : Names(stage)) text += name + ", ";
  return text + "or " + FolderText(stage);
}

PolicyChoice PolicyRegistry::Find(Stage stage, const std::string& word,
                                  const std::string& option) const {
  PolicyChoice choice{word};
  for (const MotionPolicyRow& row : motion_) {
    if (stage == row.stage && word == row.name) choice.motion = row;
  }
  for (const GraspPolicyRow& row : grasp_) {
    if (stage == Stage::kGrasp && word == row.name) choice.grasp = row;
  }
  if (choice.motion || choice.grasp) return choice;
  if (fs::is_directory(word)) {
    choice.folder = word;
    return choice;
  }
  const std::string takes = option + " takes " + Choices(stage);
  if (LooksLikeAPath(word))
    throw Error(ErrorCode::kMissing, option + " " + word + ": no such folder; " + takes);
  throw Error(ErrorCode::kInvalidArgument,
              option + " " + word + ": no policy and no folder is called so; did you mean \"" +
                  NearestName(word, Names(stage)) + "\"? " + takes);
}

}  // namespace doorforge
