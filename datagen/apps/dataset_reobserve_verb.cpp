// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>
#include <memory>

#include "doorforge/cli/command_line.h"
#include "doorforge/collect/reobserve.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "verbs.h"

namespace doorforge {
namespace {

int Reobserve(const ReobserveRequest& request) {
  const CollectSummary summary = ReobserveDataset(request);
  if (summary.stopped_by_signal != 0) {
    std::fprintf(stderr,
                 "doorforge: stopped; what is done is kept in %s, the same command goes on\n",
                 request.out.c_str());
    return 128 + summary.stopped_by_signal;
  }
  std::cout << DescriptionText(DescribeDataset(request.out));
  return 0;
}

}  // namespace

Subcommand AddReobserve(CLI::App& dataset) {
  const auto request = std::make_shared<ReobserveRequest>();
  request->robot_meshes = RobotMeshes();
  CLI::App* app = dataset.add_subcommand(
      "re-observe", "renders the clouds anew from the stored joint states, without physics");
  app->add_option("folder", request->folder, "the dataset's folder")->required();
  app->add_option("--out", request->out, "folder of the new dataset")->required();
  app->add_option("--doors", request->doors, "folders with the doors of the dataset")->required();
  app->add_option("--config", request->config, "YAML file with settings");
  AddSettings(*app, request->settings,
              "a.b=c overrides one setting: cloud.* and camera.* as of `datagen`");
  app->add_option("--robot", request->robot,
                  "URDF of the dataset's robot; needed where its config.yaml names a file that is "
                  "not in the dataset's folder");
  app->add_flag("--without-robot", request->without_robot,
                "only the door is seen: the pair of what the robot hides");
  app->add_option("-j,--threads", request->threads, "threads, 0: all; does not change the bytes")
      ->check(CLI::Range(0, 1024));
  app->footer(
      "examples:\n"
      "  doorforge dataset re-observe data --doors doors --out data_free --without-robot\n"
      "  doorforge dataset re-observe data --doors doors --out data_noisy --set "
      "cloud.noise.sensor=structured_light");
  return {app, [request] { return Reobserve(*request); }};
}

}  // namespace doorforge
