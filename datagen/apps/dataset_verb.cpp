// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dataset_verb.h"

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "doorforge/collect/regenerate_dataset.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/progress.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/merge_dataset.h"
#include "doorforge/dataset/verify_dataset.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "dataset_downstream.h"
#include "reobserve_verb.h"
#include "verb_options.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct RegenerateOptions {
  std::string share;  // "1%"; empty: nothing is made again
  std::vector<std::string> doors;
  std::string robot;
  PolicyFolders policies;
};

struct Options {
  std::string folder;
  int threads = 0;
  std::vector<std::string> parts;  // of merge
  RegenerateOptions regenerate;
  ReobserveRequest reobserve;
  bool json = false;
};

void AddRegenerateOptions(CLI::App& app, RegenerateOptions& options) {
  auto* share = app.add_option("--regenerate", options.share,
                               "make a share of the episodes again from their seeds, such as 1%, "
                               "and compare every byte");
  app.add_option("--doors", options.doors, "the doors that the dataset was made with")
      ->needs(share);
  app.add_option("--robot", options.robot,
                 "URDF of the dataset's robot; needed where its config.yaml names a file that is "
                 "not in the dataset's folder")
      ->needs(share);
  PolicyFolders& policies = options.policies;
  app.add_option("--handler", policies.handler, "the policy that turned the handle")->needs(share);
  app.add_option("--opener", policies.opener, "the policy that opened")->needs(share);
  app.add_option("--learner", policies.learner, "the policy that drove or took hold")->needs(share);
}

void CheckRegenerateOptions(const RegenerateOptions& options) {
  ParseFraction(options.share);
  Require(!options.doors.empty(), ErrorCode::kInvalidArgument,
          "--regenerate: needs --doors, with what the dataset was made with");
}

std::vector<DatasetFinding> Regenerate(const Options& options) {
  const RegenerateOptions& given = options.regenerate;
  const RegenerateResult result =
      RegenerateDataset({options.folder, ParseFraction(given.share), given.doors, given.robot,
                         given.policies, options.threads, RobotMeshes()});
  std::fprintf(stderr, "doorforge: %zu episodes made again, %zu differences\n", result.episodes,
               result.findings.size());
  return result.findings;
}

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

int Info(const Options& options) {
  const nlohmann::ordered_json description = DescribeDataset(options.folder);
  std::cout << (options.json ? JsonText(description, 2) + "\n" : DescriptionText(description));
  return 0;
}

int Merge(const Options& options) {
  const FolderLock lock(options.folder, "doorforge dataset merge", Writers::kOne);
  const MergeSummary summary =
      MergeDataset({options.folder, {options.parts.begin(), options.parts.end()}});
  std::fprintf(stderr, "doorforge: %s: %llu shards, %llu linked, %llu copied\n",
               options.folder.c_str(), static_cast<unsigned long long>(summary.shards),
               static_cast<unsigned long long>(summary.linked),
               static_cast<unsigned long long>(summary.copied));
  return Info(options);
}

int Verify(const Options& options) {
  std::vector<DatasetFinding> findings = VerifyWithProgress(options);
  if (!AnyFault(findings) && !options.regenerate.share.empty())
    for (DatasetFinding& finding : Regenerate(options)) findings.push_back(std::move(finding));
  if (options.json) {
    std::cout << JsonText(FindingsToJson(findings), 2) << '\n';
  } else {
    std::size_t faults = 0;
    for (const DatasetFinding& finding : findings) {
      if (finding.severity == DatasetSeverity::kNote) {
        std::printf("note    %s: %s\n", finding.where.c_str(), finding.measured.c_str());
        continue;
      }
      ++faults;
      std::printf("%s  %s\n        found   %s\n        allowed %s\n        fix     %s\n",
                  finding.code.c_str(), finding.where.c_str(), finding.measured.c_str(),
                  finding.allowed.c_str(), finding.fix.c_str());
    }
    std::printf("%s: %s\n", options.folder.c_str(),
                faults == 0 ? "no faults" : (std::to_string(faults) + " faults").c_str());
  }
  return AnyFault(findings) ? 1 : 0;
}

}  // namespace

int RunDatasetVerb(int argc, char** argv) {
  Options options;
  CLI::App app("Checks and describes datasets.", "doorforge dataset");
  app.require_subcommand(1);
  auto* verify = app.add_subcommand(
      "verify",
      "every byte of every file against its checksum or what it is made from, every value against "
      "what it may be");
  auto* merge = app.add_subcommand(
      "merge", "joins the tasks of a collection and checks that all of them are there");
  const auto* reobserve = AddReobserve(app, options.reobserve);
  for (auto* verb : {verify, merge}) {
    verb->add_option("folder", options.folder, "the dataset's folder")->required();
    verb->add_flag("--json", options.json, "print one JSON document");
  }
  verify->add_option("--threads", options.threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  AddRegenerateOptions(*verify, options.regenerate);
  verify->footer(
      "examples:\n  doorforge dataset verify data/open\n"
      "  doorforge dataset verify data/open --regenerate 1% --doors doors/train");
  merge->add_option("parts", options.parts,
                    "folders of tasks; none where all tasks wrote into the dataset's folder");
  merge->footer(
      "examples:\n  doorforge dataset merge data\n"
      "  doorforge dataset merge data node1/data node2/data");
  app.footer("examples:\n  doorforge dataset verify data/open\n  doorforge dataset info data/open");
  const std::vector<std::function<int()>> downstream = {AddStatus(app), AddInfo(app),
                                                        AddExport(app), AddCard(app)};
  ParseDataVerb(app, argc, argv);
  if (!options.regenerate.share.empty()) CheckRegenerateOptions(options.regenerate);
  if (merge->parsed()) return Merge(options);
  if (reobserve->parsed()) return RunReobserve(options.reobserve);
  for (const auto& run : downstream) {
    const int code = run();
    if (code >= 0) return code;
  }
  return Verify(options);
}

}  // namespace doorforge
