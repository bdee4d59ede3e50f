// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <memory>

#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/merge_dataset.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct DatasetMergeOptions {
  MergeRequest request;
  bool json = false;
};

int Merge(const DatasetMergeOptions& options) {
  const auto& folder = options.request.folder;
  const FolderLock lock(folder, "doorforge dataset merge", Writers::kOne);
  const MergeSummary summary = MergeDataset(options.request);
  std::fprintf(stderr, "doorforge: %s: %llu shards, %llu linked, %llu copied\n", folder.c_str(),
               static_cast<unsigned long long>(summary.shards),
               static_cast<unsigned long long>(summary.linked),
               static_cast<unsigned long long>(summary.copied));
  const nlohmann::ordered_json description = DescribeDataset(folder);
  std::cout << (options.json ? JsonText(description, 2) + "\n" : DescriptionText(description));
  return 0;
}

}  // namespace

Subcommand AddMerge(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetMergeOptions>();
  CLI::App* app = dataset.add_subcommand(
      "merge", "joins the tasks of a collection and checks that all of them are there");
  app->add_option("folder", options->request.folder, "the dataset's folder")->required();
  app->add_flag("--json", options->json, "print one JSON document");
  app->add_option("parts", options->request.parts,
                  "folders of tasks; none where all tasks wrote into the dataset's folder");
  app->footer(
      "examples:\n  doorforge dataset merge data\n"
      "  doorforge dataset merge data node1/data node2/data");
  return {app, [options] { return Merge(*options); }};
}

}  // namespace doorforge
