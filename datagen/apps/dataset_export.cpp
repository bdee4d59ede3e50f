// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/core/json_file.h"
#include "doorforge/core/progress.h"
#include "doorforge/dataset/export_robomimic.h"

#include "dataset_downstream.h"

namespace doorforge {
namespace {

struct Options {
  std::string folder;
  std::string to;
  std::string stage = "open";
  std::string out;
  bool overwrite = false;
  bool json = false;
};

void Print(const RobomimicSummary& summary, const Options& options) {
  if (options.json) {
    const nlohmann::ordered_json json = {{"schema", "doorforge.dataset_export"},
                                         {"schema_version", 1},
                                         {"to", options.to},
                                         {"stage", options.stage},
                                         {"out", options.out},
                                         {"demos", summary.demos},
                                         {"samples", summary.samples},
                                         {"bytes", summary.bytes}};
    std::cout << JsonText(json, 2) << '\n';
    return;
  }
  std::printf("%s: %llu demos, %llu samples, %.1f MiB\n", options.out.c_str(),
              static_cast<unsigned long long>(summary.demos),
              static_cast<unsigned long long>(summary.samples),
              static_cast<double>(summary.bytes) / (1 << 20));
}

int Export(const Options& options) {
  Progress progress("export", CountEpisodes(options.folder, options.stage));
  RobomimicRequest request;
  request.folder = options.folder;
  request.stage = options.stage;
  request.out = options.out;
  request.existing = options.overwrite ? Existing::kReplace : Existing::kRefuse;
  request.on_episode = [&] { progress.Advance(); };
  const RobomimicSummary summary = ExportRobomimic(request);
  if (summary.stopped_by_signal != 0) {
    std::fprintf(stderr, "doorforge: stopped; nothing was left in %s\n", options.out.c_str());
    return 128 + summary.stopped_by_signal;
  }
  Print(summary, options);
  return 0;
}

}  // namespace

std::function<int()> AddExport(CLI::App& verb) {
  const auto options = std::make_shared<Options>();
  CLI::App* app = verb.add_subcommand("export", "writes the episodes as other tools want them");
  app->add_option("folder", options->folder, "the dataset's folder")->required();
  app->add_option("--to", options->to, "robomimic: one HDF5 file with data/demo_N and mask/<split>")
      ->required()
      ->check(CLI::IsMember({"robomimic"}));
  app->add_option("--stage", options->stage, "one file holds one stage")
      ->check(CLI::IsMember({"open", "handle", "grasp"}))
      ->capture_default_str();
  app->add_option("--out", options->out, "the file to write")->required();
  app->add_flag("--overwrite", options->overwrite, "replace the file if it is there");
  app->add_flag("--json", options->json, "print one JSON document");
  app->footer("example:\n  doorforge dataset export data --to robomimic --out data.hdf5");
  return [options, app] { return app->parsed() ? Export(*options) : -1; };
}

}  // namespace doorforge
