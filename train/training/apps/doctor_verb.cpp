// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/training/examine_installation.h"

#include "verbs.h"

namespace doorforge {
namespace {

bool ParseJsonFlag(int argc, char** argv) {
  bool json = false;
  CLI::App app("What is installed, and what to do about it. Exit code 1 if something is amiss.",
               "doorforge doctor");
  AddJson(app, json);
  app.footer("example:\n  doorforge doctor");
  ParseVerb(app, argc, argv);
  return json;
}

}  // namespace

int RunDoctorVerb(int argc, char** argv) {
  const bool as_json = ParseJsonFlag(argc, argv);
  const nlohmann::ordered_json json = ExamineInstallation();
  PrintAnswer(as_json, json, InstallationText(json));
  return json["healthy"].get<bool>() ? 0 : 1;
}

}  // namespace doorforge
