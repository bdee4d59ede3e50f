// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_options.h"

#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

void RequireFolder(Stage stage, const std::string& word, const std::string& option,
                   const std::string& why) {
  if (word.empty() || BuiltInPolicies().Find(stage, word, option).IsFolder()) return;
  throw Error(ErrorCode::kInvalidArgument, option + " " + word + ": " + why +
                                               "; name a folder that `doorforge train " +
                                               std::string(NameOf(stage)) + "` wrote");
}

}  // namespace

void AddPolicyOptions(CLI::App& app, const PolicyRegistry& registry, PolicyWords& words) {
  AddWord(app, "--opener", words.opener, "who opens the door: " + registry.Choices(Stage::kOpen));
  AddWord(app, "--handler", words.handler,
          "who turns the handle: " + registry.Choices(Stage::kHandle));
  AddWord(app, "--grasper", words.grasper,
          "who chooses where to take hold: " + registry.Choices(Stage::kGrasp));
  AddWord(app, "--whole", words.whole,
          "who does all of it, in the place of these: a folder that `doorforge reinforce` wrote");
}

void RequireTrainedPolicies(const PolicyWords& words, const std::string& why) {
  RequireFolder(Stage::kOpen, words.opener, "--opener", why);
  RequireFolder(Stage::kHandle, words.handler, "--handler", why);
  RequireFolder(Stage::kGrasp, words.grasper, "--grasper", why);
}

}  // namespace doorforge
