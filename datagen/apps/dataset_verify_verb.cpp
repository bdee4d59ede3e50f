// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "doorforge/collect/regenerate_dataset.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/progress.h"
#include "doorforge/dataset/verify_dataset.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct DatasetVerifyOptions {
  std::string folder;
  int threads = 0;
  std::string share;  // to be made again, "1%"; empty: none
  RegenerateDatasetRequest regenerate;
  bool json = false;
};

void CheckRegenerate(DatasetVerifyOptions& options) {
  if (options.share.empty()) return;
  options.regenerate.fraction = ParseFraction(options.share);
  Require(!options.regenerate.doors.empty(), ErrorCode::kInvalidArgument,
          "--regenerate: needs --doors, with what the dataset was made with");
}

std::vector<DatasetFinding> VerifyWithProgress(const DatasetVerifyOptions& options) {
  Progress progress("verify", CountShards(options.folder));
  return VerifyDataset({options.folder, options.threads, [&] { progress.Advance(); }});
}

void Regenerate(const DatasetVerifyOptions& options, std::vector<DatasetFinding>& findings) {
  RegenerateDatasetRequest request = options.regenerate;
  request.folder = options.folder;
  request.threads = options.threads;
  request.robot_meshes = RobotMeshes();
  const RegenerateResult result = RegenerateDataset(request);
  std::fprintf(stderr, "doorforge: %zu episodes made again, %zu differences\n", result.episodes,
               result.findings.size());
  findings.insert(findings.end(), result.findings.begin(), result.findings.end());
}

int Verify(DatasetVerifyOptions& options) {
  CheckRegenerate(options);
  std::vector<DatasetFinding> findings = VerifyWithProgress(options);
  if (!AnyFault(findings) && !options.share.empty()) Regenerate(options, findings);
  std::cout << (options.json ? JsonText(FindingsToJson(findings), 2) + "\n"
                             : FindingsText(findings, options.folder));
  return AnyFault(findings) ? 1 : 0;
}

}  // namespace

std::vector<CLI::Option*> AddMadeWithOptions(CLI::App& app, RegenerateDatasetRequest& given) {
  CollectionWords& policies = given.policies;
  return {
      app.add_option("--doors", given.doors, "the doors that the dataset was made with"),
      app.add_option("--robot", given.robot,
                     "URDF of the dataset's robot; needed where its config.yaml names a file that "
                     "is not in the dataset's folder"),
      app.add_option("--handler", policies.handler, "the policy that turned the handle"),
      app.add_option("--opener", policies.opener, "the policy that opened"),
      app.add_option("--learner", policies.learner, "the policy that drove or took hold")};
}

Subcommand AddVerify(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetVerifyOptions>();
  CLI::App* app = dataset.add_subcommand(
      "verify",
      "every byte of every file against its checksum or what it is made from, every value against "
      "what it may be");
  app->add_option("folder", options->folder, "the dataset's folder")->required();
  app->add_flag("--json", options->json, "print one JSON document");
  app->add_option("--threads", options->threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  auto* share = app->add_option("--regenerate", options->share,
                                "make a share of the episodes again from their seeds, such as 1%, "
                                "and compare every byte");
  for (CLI::Option* option : AddMadeWithOptions(*app, options->regenerate)) option->needs(share);
  app->footer(
      "examples:\n  doorforge dataset verify data/open\n"
      "  doorforge dataset verify data/open --regenerate 1% --doors doors/train");
  return {app, [options] { return Verify(*options); }};
}

}  // namespace doorforge
