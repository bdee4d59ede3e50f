// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include "doorforge/datagen/dataset_card.h"

#include "dataset_downstream.h"

namespace doorforge {

std::function<int()> AddCard(CLI::App& verb) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* app = verb.add_subcommand(
      "card", "writes README.md (YAML front matter) and croissant.json into the dataset");
  app->add_option("folder", *folder, "the dataset's folder")->required();
  app->footer("example:\n  doorforge dataset card data");
  return [folder, app] {
    if (!app->parsed()) return -1;
    WriteDatasetCard(*folder);
    std::printf("%s/README.md\n%s/croissant.json\n", folder->c_str(), folder->c_str());
    return 0;
  };
}

}  // namespace doorforge
