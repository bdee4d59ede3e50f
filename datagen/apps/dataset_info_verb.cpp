// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "doorforge/collect/episode_charts.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/describe_episodes.h"
#include "doorforge/sensor/picture.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct DatasetInfoOptions {
  std::string folder;
  std::string png;
  std::string html;
  std::string films;
  int examples = 2;
  int threads = 0;
  bool overwrite = false;
  bool json = false;
};

// As the page names it.
std::string FilmsAddress(const DatasetInfoOptions& options) {
  if (options.films.empty()) return {};
  const fs::path folder = fs::absolute(options.html).parent_path();
  return fs::absolute(options.films).lexically_relative(folder).generic_string();
}

int Info(const DatasetInfoOptions& options) {
  RequireNoFile(options.png, options.overwrite);
  RequireNoFile(options.html, options.overwrite);
  nlohmann::ordered_json dataset = DescribeDataset(options.folder);
  const EpisodeDescription episodes = DescribeEpisodes(
      options.folder, options.html.empty() ? 0 : options.examples, options.threads);
  if (!options.png.empty()) WritePng(options.png, EpisodeCharts(episodes));
  if (!options.html.empty())
    CommitFile(options.html, DatasetPage(dataset, episodes, FilmsAddress(options)));
  if (options.json) {
    dataset["stages"] = StagesToJson(episodes);
    std::cout << JsonText(dataset, 2) << '\n';
  } else {
    std::cout << DescriptionText(dataset) << StagesText(episodes);
  }
  return 0;
}

}  // namespace

Subcommand AddInfo(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetInfoOptions>();
  CLI::App* app = dataset.add_subcommand(
      "info", "counts, success by category and mechanism, angles, causes of failure");
  app->add_option("folder", options->folder, "the dataset's folder")->required();
  app->add_option("--png", options->png, "picture of the hinge angles, one chart a category");
  auto* html = app->add_option("--html", options->html,
                               "one page with everything, that needs no other file");
  app->add_option(
         "--films", options->films,
         "page of `doorforge view` with the films of `dataset films`: every failure on the "
         "page is linked to its own")
      ->needs(html)
      ->check(CLI::ExistingFile);
  app->add_option("--examples", options->examples, "episodes a category that the page shows")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  app->add_option("--threads", options->threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app->add_flag("--overwrite", options->overwrite, "replace --png and --html if they are there");
  app->add_flag("--json", options->json, "print one JSON document");
  app->footer("example:\n  doorforge dataset info data --html data.html --png data.png");
  return {app, [options] { return Info(*options); }};
}

}  // namespace doorforge
