// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/dataset/collection_status.h"
#include "doorforge/dataset/task_number.h"

#include "verbs.h"

namespace doorforge {
namespace {

constexpr int kComplete = 0;
constexpr int kIncomplete = 4;

struct DatasetStatusOptions {
  std::vector<std::string> folders;
  int tasks = 0;
  double every_s = 5;
  bool watch = false;
  bool json = false;
};

double Now() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

CollectionStatus LookAndPrint(const DatasetStatusOptions& options) {
  const double now_s = Now();
  const CollectionStatus status =
      StatusOfCollection({{options.folders.begin(), options.folders.end()}, options.tasks, now_s});
  if (options.json) {
    std::cout << JsonText(StatusToJson(status, now_s), options.watch ? -1 : 2) << std::endl;
  } else {
    // on a terminal each look takes the place of the one before
    if (options.watch && ::isatty(STDOUT_FILENO) == 1) std::cout << "\033[H\033[J";
    std::cout << StatusText(status, now_s) << (options.watch ? "\n" : "") << std::flush;
  }
  return status;
}

// False if a signal asked to stop.
bool Wait(double seconds) {
  constexpr std::chrono::milliseconds kStep(100);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    if (StopRequested() != 0) return false;
    std::this_thread::sleep_for(kStep);
  }
  return StopRequested() == 0;
}

int Status(const DatasetStatusOptions& options) {
  CollectionStatus status = LookAndPrint(options);
  // what is left to do when all shards are there is no matter of waiting
  while (options.watch && status.Count(ShardState::kDone) < status.shards.size()) {
    if (!Wait(options.every_s)) return 128 + StopRequested();
    status = LookAndPrint(options);
  }
  return status.is_complete ? kComplete : kIncomplete;
}

}  // namespace

Subcommand AddStatus(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetStatusOptions>();
  CLI::App* app = dataset.add_subcommand(
      "status", "how far a collection is, while its tasks run or after: shards, rate, time left");
  app->add_option("folder", options->folders,
                  "the dataset's folder, and those of tasks that write into others")
      ->required();
  app->add_option("--tasks", options->tasks,
                  "N of `datagen --task i/N`, to tell how far each of them is")
      ->check(CLI::Range(1, kMostTasks));
  app->add_flag("--watch", options->watch, "look again and again until all shards are there");
  app->add_option("--every", options->every_s, "seconds between the looks of --watch")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  app->add_flag("--json", options->json, "print JSON: one document, or a line a look");
  app->footer(
      "Reads only, and takes no lock: writers never notice. Exit code 0 if the dataset is "
      "complete,\n4 if not.\n\n"
      "examples:\n  doorforge dataset status data --watch\n"
      "  doorforge dataset status data --tasks 16 --json");
  return {app, [options] { return Status(*options); }};
}

}  // namespace doorforge
