// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "reobserve_verb.h"

#include <cstdio>
#include <iostream>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/robot_meshes/robot_meshes.h"

namespace doorforge {

CLI::App* AddReobserve(CLI::App& app, ReobserveRequest& request) {
  auto* verb = app.add_subcommand(
      "re-observe", "renders the clouds anew from the stored joint states, without physics");
  verb->add_option("folder", request.folder, "the dataset's folder")->required();
  verb->add_option("--out", request.out, "folder of the new dataset")->required();
  verb->add_option("--doors", request.doors, "folders with the doors of the dataset")->required();
  verb->add_option("--config", request.config, "YAML file with settings");
  AddSettings(*verb, request.settings,
              "a.b=c overrides one setting: cloud.* and camera.* as of `datagen`");
  verb->add_option("--robot", request.robot,
                   "URDF of the dataset's robot; needed where its config.yaml names a file that is "
                   "not in the dataset's folder");
  verb->add_flag("--without-robot", request.without_robot,
                 "only the door is seen: the pair of what the robot hides");
  verb->add_option("-j,--threads", request.threads, "threads, 0: all; does not change the bytes")
      ->check(CLI::Range(0, 1024));
  verb->footer(
      "examples:\n"
      "  doorforge dataset re-observe data --doors doors --out data_free --without-robot\n"
      "  doorforge dataset re-observe data --doors doors --out data_noisy --set "
      "cloud.noise.sensor=structured_light");
  return verb;
}

int RunReobserve(ReobserveRequest request) {
  request.robot_meshes = RobotMeshes();
  const FolderLock lock(request.out, "doorforge dataset re-observe", Writers::kTogether);
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

}  // namespace doorforge
