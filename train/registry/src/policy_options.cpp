// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_options.h"

#include <cstdio>

#include <CLI/CLI.hpp>

#include "doorforge/core/error.h"

namespace doorforge {

void AddPolicyOptions(CLI::App& app, const PolicyRegistry& registry, PolicyWords& words) {
  const auto add = [&](const char* name, std::string& word, Stage stage, const char* does) {
    app.add_option(name, word,
                   std::string(does) + ": " + registry.Choices(stage) +
                       (word.empty() ? "" : " (" + word + ")"));
  };
  add("--opener", words.opener, Stage::kOpen, "who opens the door");
  add("--handler", words.handler, Stage::kHandle, "who turns the handle");
  add("--grasper", words.grasper, Stage::kGrasp, "who chooses where to take hold");
}

void AddEarlierName(CLI::App& app, const std::string& earlier, const std::string& now,
                    std::string& value) {
  app.add_option_function<std::string>(
         earlier,
         [&value, earlier, now, option = app.get_option(now)](const std::string& text) {
           Require(
               option->count() == 0, ErrorCode::kInvalidArgument,
               earlier + " is called " + now + " now; both were given, leave " + earlier + " out");
           std::fprintf(stderr, "note: %s is called %s now\n", earlier.c_str(), now.c_str());
           value = text;
         })
      ->group("");
}

std::filesystem::path TrainedPolicyFolder(Stage stage, const std::string& word,
                                          const std::string& option, const std::string& needs) {
  if (word.empty()) return {};
  const PolicyChoice choice = BuiltInPolicies().Find(stage, word, option);
  Require(choice.IsFolder(), ErrorCode::kInvalidArgument,
          option + " " + word + ": " + needs + "; name a folder that `doorforge train " +
              std::string(NameOf(stage)) + "` wrote");
  return choice.folder;
}

}  // namespace doorforge
