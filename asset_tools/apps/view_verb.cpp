// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/program.h"
#include "doorforge/robot_meshes/robot_meshes.h"
#include "doorforge/view/view_request.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct ViewOptions {
  ViewRequest page;
  std::string out;
  bool open = false;
  bool overwrite = false;
};

ViewOptions ParseView(int argc, char** argv) {
  ViewOptions options;
  ViewRequest& page = options.page;
  page.robot.read_mesh = RobotMeshes();
  CLI::App app("Doors, parts and episodes in 3D, on one page that needs no network.",
               "doorforge view");
  app.add_option("PATH,--door", page.paths,
                 "folders of doors or parts, or folders that hold some; one data set; one report "
                 "of eval, or a file of films")
      ->required();
  app.add_option("--out", options.out, "HTML file")->required();
  auto* episode = app.add_flag("--episode", page.episode, "the expert opening each door");
  app.add_option("--seed", page.seed, "of the scene, with --episode")->needs(episode);
  auto* doors =
      app.add_option("--doors", page.doors, "of a data set or report: folders with its doors");
  app.add_option("--stage", page.stage, "of a data set: only episodes of this stage")
      ->needs(doors)
      ->check(CLI::IsMember({"open", "handle", "grasp"}));
  app.add_option("--key", page.key, "of a data set: one episode, such as ep000012")->needs(doors);
  app.add_option("--episodes", page.episodes, "of a data set: at most so many")
      ->needs(doors)
      ->check(CLI::Range(1, 1000));
  app.add_option("--films", page.films, "of a data set: of `dataset films --stored`")->needs(doors);
  app.add_option("--points", page.points, "of each cloud of an episode; 0: none")
      ->check(CLI::Range(0, 65536));
  app.add_option("--robot", page.robot.urdf,
                 "URDF of the robot of episodes; the built-in one if left out");
  AddThreads(app, page.threads);
  app.add_flag("--gallery", page.gallery,
               "pictures to browse, with filters; without it for more than 40 doors and parts");
  app.add_flag("--open", options.open, "show it in the desktop's browser (xdg-open)");
  AddOverwrite(app, options.overwrite, "replace --out if it is there");
  app.footer(
      "examples:\n"
      "  doorforge view doors/mine --out mine.html --open\n"
      "  doorforge view parts/interior_lever_tube_01 --out lever.html\n"
      "  doorforge view doors --gallery --out doors.html\n"
      "  doorforge view data --doors doors --out episodes.html\n"
      "  doorforge view report --doors doors --out films.html");
  ParseVerb(app, argc, argv);
  return options;
}

}  // namespace

int RunViewVerb(int argc, char** argv) {
  const ViewOptions options = ParseView(argc, argv);
  RequireNoFile(options.out, options.overwrite);
  const ViewPage page = MakeViewPage(options.page);
  CommitFile(options.out, page.html);
  for (const std::string& fault : page.faults)
    std::fprintf(stderr, "doorforge: %s\n", fault.c_str());
  std::printf("%s: %zu shown, %.2f MB\n", options.out.c_str(), page.shown,
              static_cast<double>(page.html.size()) / 1e6);
  if (options.open) RunChild({"xdg-open", options.out});
  return page.faults.empty() ? 0 : 1;
}

}  // namespace doorforge
