// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/pipeline/quickstart.h"

#include "verbs.h"

namespace doorforge {
namespace {

QuickstartRequest Parse(int argc, char** argv) {
  QuickstartRequest request;
  request.progress = PrintProgress;
  request.result = PrintText;
  CLI::App app(
      "The whole chain at small size: parts -> doors -> validation -> shards -> policy -> report.\n"
      "Without --assets it runs on the embedded catalogue, with it on imported real objects.",
      "doorforge quickstart");
  app.add_option("--assets", request.assets, "folder of UniDoorManip objects to import")
      ->check(CLI::ExistingDirectory);
  app.add_option("--out", request.out, "folder for everything that is made")->capture_default_str();
  app.add_option("--episodes", request.episodes, "expert episodes to collect")
      ->check(CLI::Range(4, 1000000))
      ->capture_default_str();
  app.add_option("--epochs", request.epochs, "passes over the collected samples")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  AddThreads(app, request.threads, "threads, 0: all");
  AddSeed(app, request.seed, "decides every random choice");
  AddOverwrite(app, request.overwrite, "replace the folder --out");
  app.add_flag("--resume", request.resume, "keep the steps that are done in --out");
  app.footer("example:\n  doorforge quickstart --out run/quickstart");
  ParseVerb(app, argc, argv);
  return request;
}

// `doorforge quickstart doors`: the step that draws and composes the pairs
int RunDoors(int argc, char** argv) {
  std::string parts;
  std::string out;
  int threads = 0;
  std::uint64_t seed = 7;
  CLI::App app("Draws training and held-out pairs of parts, and composes them.",
               "doorforge quickstart doors");
  app.add_option("--parts", parts, "folder of parts")->required()->check(CLI::ExistingDirectory);
  app.add_option("--out", out, "folder of the doors")->required();
  AddSeed(app, seed, "decides which pairs");
  AddThreads(app, threads, "threads, 0: all");
  ParseVerb(app, argc, argv);
  ComposeQuickstartDoors(parts, out, seed, threads);
  return 0;
}

}  // namespace

int RunQuickstartVerb(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "doors") return RunDoors(argc - 1, argv + 1);
  return RunQuickstart(Parse(argc, argv));
}

}  // namespace doorforge
