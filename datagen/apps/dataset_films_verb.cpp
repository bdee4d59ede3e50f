// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "doorforge/collect/regenerate_dataset.h"
#include "doorforge/core/output_file.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct DatasetFilmsOptions {
  RegenerateDatasetRequest request;
  std::string out;
  bool overwrite = false;
};

int Films(DatasetFilmsOptions& options) {
  RequireNoFile(options.out, options.overwrite);
  options.request.robot_meshes = RobotMeshes();
  const std::vector<EpisodeFilm> films = FilmFailures(options.request);
  WriteFilms(options.out, films);
  std::printf("%s: %zu films\n", options.out.c_str(), films.size());
  return 0;
}

}  // namespace

Subcommand AddFilms(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetFilmsOptions>();
  RegenerateDatasetRequest& request = options->request;
  CLI::App* app = dataset.add_subcommand(
      "films", "the course of every planned episode that failed, made again from its seed");
  app->add_option("folder", request.folder, "the dataset's folder")->required();
  app->add_option("--out", options->out, "file for `doorforge view`, such as films.jsonl")
      ->required();
  AddMadeWithOptions(*app, request);
  app->get_option("--doors")->required();
  app->add_option("--threads", request.threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app->add_flag("--overwrite", options->overwrite, "replace --out if it is there");
  app->footer(
      "example:\n  doorforge dataset films data --doors doors --out films.jsonl\n"
      "  doorforge view films.jsonl --doors doors --out films.html\n"
      "  doorforge dataset info data --html data.html --films films.html");
  return {app, [options] { return Films(*options); }};
}

}  // namespace doorforge
