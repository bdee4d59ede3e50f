// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/environment_preset.h"
#include "doorforge/core/error.h"

namespace doorforge {

CLI::Option* AddConfig(CLI::App& app, std::string& config, const std::string& about) {
  return app.add_option("--config", config, about);
}

CLI::Option* AddPreset(CLI::App& app, std::string& preset) {
  std::string names;
  for (const std::string& name : EnvironmentPresets()) names += name + ", ";
  return app.add_option(
      "--preset", preset,
      "environment to begin with: " + names + "or a .yaml file; --config and --set go over it");
}

void AddEnvironment(CLI::App& app, ConfigSources& sources) {
  AddPreset(app, sources.preset);
  AddChoice(app, "--simulator",
            "whose physics moves robot and door (config: scene.physics.simulator, bullet)",
            {{"bullet", "mujoco"}, "", [&sources](const std::string& word) {
               sources.simulator = word;
             }});
}

CLI::Option* AddSettings(CLI::App& app, std::vector<std::string>& settings,
                         const std::string& about) {
  return app.add_option("--set", settings, about + "; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

CLI::Option* AddSeed(CLI::App& app, std::uint64_t& seed, const std::string& about) {
  return app.add_option("--seed", seed, about)->capture_default_str();
}

CLI::Option* AddThreads(CLI::App& app, int& threads, const std::string& about) {
  return app.add_option("-j,--threads", threads, about)
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
}

CLI::Option* AddOverwrite(CLI::App& app, bool& overwrite, const std::string& about) {
  return app.add_flag("--overwrite", overwrite, about);
}

CLI::Option* AddOverwrite(CLI::App& app, Existing& existing, const std::string& about) {
  return app.add_flag_callback(
      "--overwrite", [&existing] { existing = Existing::kReplace; }, about);
}

CLI::Option* AddChoice(CLI::App& app, const std::string& name, const std::string& about,
                       const Choice& choice) {
  CLI::Option* option = app.add_option_function<std::string>(name, choice.take, about)
                            ->check(CLI::IsMember(choice.words));
  return choice.given.empty() ? option : option->default_str(choice.given);
}

CLI::Option* AddJson(CLI::App& app, bool& json, const std::string& about) {
  return app.add_flag("--json", json, about);
}

CLI::Option* AddMaxSeconds(CLI::App& app, double& max_seconds, const std::string& about) {
  return app.add_option("--max-seconds", max_seconds, about)->check(CLI::PositiveNumber);
}

CLI::Option* AddWord(CLI::App& app, const std::string& name, std::string& word,
                     const std::string& about) {
  CLI::Option* option = app.add_option(name, word, about);
  return word.empty() ? option : option->capture_default_str();
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

}  // namespace doorforge
