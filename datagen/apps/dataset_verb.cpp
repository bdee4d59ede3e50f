// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dataset_verb.h"

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "doorforge/core/progress.h"
#include "doorforge/datagen/describe_dataset.h"
#include "doorforge/datagen/verify_dataset.h"

#include "verb_options.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string folder;
  int threads = 0;
  bool json = false;
};

std::size_t CountIndices(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    count += it->path().filename().string().ends_with(".index.json") ? 1 : 0;
  return count;
}

std::vector<DatasetFinding> VerifyWithProgress(const Options& options) {
  if (!fs::is_directory(options.folder))
    throw Error(ErrorCode::kMissing, options.folder + ": no such folder");
  Progress progress("verify", CountIndices(options.folder));
  return VerifyDataset({options.folder, options.threads, [&] { progress.Advance(); }});
}

int Verify(const Options& options) {
  const std::vector<DatasetFinding> findings = VerifyWithProgress(options);
  if (options.json) {
    std::cout << FindingsToJson(findings).dump(2) << '\n';
  } else {
    for (const DatasetFinding& finding : findings)
      std::printf("%s  %s\n        found   %s\n        allowed %s\n        fix     %s\n",
                  finding.code.c_str(), finding.where.c_str(), finding.measured.c_str(),
                  finding.allowed.c_str(), finding.fix.c_str());
    std::printf(
        "%s: %s\n", options.folder.c_str(),
        findings.empty() ? "no faults" : (std::to_string(findings.size()) + " faults").c_str());
  }
  return findings.empty() ? 0 : 1;
}

int Info(const Options& options) {
  const nlohmann::ordered_json description = DescribeDataset(options.folder);
  std::cout << (options.json ? description.dump(2) + "\n" : DescriptionText(description));
  return 0;
}

}  // namespace

int RunDatasetVerb(int argc, char** argv) {
  Options options;
  CLI::App app("Checks and describes datasets.", "doorforge dataset");
  app.require_subcommand(1);
  auto* verify = app.add_subcommand(
      "verify", "every byte against its checksum, every value against what it may be");
  auto* info = app.add_subcommand("info", "counts, success rate, causes of failure");
  for (auto* verb : {verify, info}) {
    verb->add_option("folder", options.folder, "the dataset's folder")->required();
    verb->add_flag("--json", options.json, "print one JSON document");
  }
  verify->add_option("--threads", options.threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  verify->footer("example:\n  doorforge dataset verify data/open");
  info->footer("example:\n  doorforge dataset info data/open --json");
  app.footer("examples:\n  doorforge dataset verify data/open\n  doorforge dataset info data/open");
  ParseVerb(app, argc, argv);
  return verify->parsed() ? Verify(options) : Info(options);
}

}  // namespace doorforge
