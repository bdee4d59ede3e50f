// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "doorforge/core/json_file.h"
#include "doorforge/core/progress.h"
#include "doorforge/dataset/export_robomimic.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct DatasetExportOptions {
  RobomimicRequest request;
  std::string to;
  bool overwrite = false;
  bool json = false;
};

int Export(const DatasetExportOptions& options) {
  RobomimicRequest request = options.request;
  Progress progress("export", CountEpisodes(request.folder, request.stage));
  request.existing = options.overwrite ? Existing::kReplace : Existing::kRefuse;
  request.on_episode = [&] { progress.Advance(); };
  const RobomimicSummary summary = ExportRobomimic(request);
  if (summary.stopped_by_signal != 0) {
    std::fprintf(stderr, "doorforge: stopped; nothing was left in %s\n", request.out.c_str());
    return 128 + summary.stopped_by_signal;
  }
  std::cout << (options.json ? JsonText(ExportToJson(request, summary), 2) + "\n"
                             : ExportText(request, summary));
  return 0;
}

}  // namespace

Subcommand AddExport(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetExportOptions>();
  CLI::App* app = dataset.add_subcommand("export", "writes the episodes as other tools want them");
  app->add_option("folder", options->request.folder, "the dataset's folder")->required();
  app->add_option("--to", options->to, "robomimic: one HDF5 file with data/demo_N and mask/<split>")
      ->required()
      ->check(CLI::IsMember({"robomimic"}));
  app->add_option("--stage", options->request.stage, "one file holds one stage")
      ->check(CLI::IsMember({"open", "handle", "grasp"}))
      ->capture_default_str();
  app->add_option("--out", options->request.out, "the file to write")->required();
  app->add_flag("--overwrite", options->overwrite, "replace the file if it is there");
  app->add_flag("--json", options->json, "print one JSON document");
  app->footer("example:\n  doorforge dataset export data --to robomimic --out data.hdf5");
  return {app, [options] { return Export(*options); }};
}

}  // namespace doorforge
