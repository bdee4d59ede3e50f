// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include "doorforge/dataset/dataset_card.h"

#include "verbs.h"

namespace doorforge {

namespace {

struct DatasetCardOptions {
  std::string folder;
  bool overwrite = false;
  bool keep_readme = false;
};

OldReadme ReadmeOf(const DatasetCardOptions& options) {
  if (options.overwrite) return OldReadme::kReplace;
  return options.keep_readme ? OldReadme::kKeep : OldReadme::kRefuseOthers;
}

int WriteCard(const DatasetCardOptions& options) {
  WriteDatasetCard(options.folder, ReadmeOf(options));
  std::printf("%s/README.md\n%s/croissant.json\n", options.folder.c_str(), options.folder.c_str());
  return 0;
}

}  // namespace

Subcommand AddCard(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetCardOptions>();
  CLI::App* app = dataset.add_subcommand(
      "card", "writes README.md (YAML front matter) and croissant.json into the dataset");
  app->add_option("folder", options->folder, "the dataset's folder")->required();
  auto* overwrite =
      app->add_flag("--overwrite", options->overwrite,
                    "replace a README.md or croissant.json that was written or changed by hand");
  app->add_flag("--keep-readme", options->keep_readme,
                "leave README.md as it is; `verify` takes it as it is from now on")
      ->excludes(overwrite);
  app->footer("example:\n  doorforge dataset card data");
  return {app, [options] { return WriteCard(*options); }};
}

}  // namespace doorforge
