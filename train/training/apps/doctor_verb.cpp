// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/training/examine_installation.h"
#include "doorforge/training/linear_algebra.h"

#include "verbs.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

bool ParseJsonFlag(int argc, char** argv) {
  bool json = false;
  CLI::App app("What is installed, and what to do about it. Exit code 1 if something is amiss.",
               "doorforge doctor");
  AddJson(app, json);
  app.footer("example:\n  doorforge doctor");
  ParseVerb(app, argc, argv);
  return json;
}

void Print(const Json& json) {
  const auto text = [&](const char* key) { return json[key].get<std::string>(); };
  std::string sets;
  for (const Json& set : json["instruction_sets"]) sets += " " + set.get<std::string>();
  std::printf("doorforge           %s\n", text("code_version").c_str());
  std::printf("processors          %d\n", json["processors"].get<int>());
  std::printf("instruction sets   %s (the encoder uses %s)\n", sets.c_str(),
              text("instruction_set").c_str());
  std::printf("libtorch            %s\n", text("torch_version").c_str());
  std::printf("BLAS                %s\n", text("blas_library").c_str());
  std::printf("matrix product      %.1f GFLOP/s on one thread (at least %.0f wanted)\n",
              json["gflops"].get<double>(), kLeastGflops);
  const int landlock = json["landlock"].get<int>();
  std::printf("confinement         %s, %s: how far foreign files are kept from the rest\n",
              landlock > 0 ? ("Landlock " + std::to_string(landlock)).c_str() : "no Landlock",
              json["seccomp"].get<bool>() ? "seccomp" : "no seccomp");
  if (json["healthy"].get<bool>()) {
    std::printf("all well\n");
    return;
  }
  std::printf("\nlibtorch runs on a slow BLAS. As root:\n%s\n", text("remedy").c_str());
}

}  // namespace

int RunDoctorVerb(int argc, char** argv) {
  const bool as_json = ParseJsonFlag(argc, argv);
  const Json json = ExamineInstallation();
  if (as_json)
    PrintJson(json);
  else
    Print(json);
  return json["healthy"].get<bool>() ? 0 : 1;
}

}  // namespace doorforge
