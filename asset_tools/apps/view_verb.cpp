// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/program.h"
#include "doorforge/robot_meshes/robot_meshes.h"
#include "doorforge/validate/validate_door.h"
#include "doorforge/view/episode_page.h"
#include "doorforge/view/gallery_page.h"
#include "doorforge/view/record_page.h"
#include "doorforge/view/report_films_page.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostInOneList = 40;

struct ViewOptions {
  std::vector<std::string> paths;
  std::string out;
  int threads = 0;
  bool gallery = false, episode = false;
  std::vector<std::string> doors;  // of a data set
  std::string stage, key, films;   // of it
  std::string robot;
  std::uint64_t seed = 1;
  int episodes = 12;
  int points = 1024;
  bool open = false;
  bool overwrite = false;
};

ViewOptions ParseView(int argc, char** argv) {
  ViewOptions options;
  CLI::App app("Doors, parts and episodes in 3D, on one page that needs no network.",
               "doorforge view");
  app.add_option("PATH,--door", options.paths,
                 "folders of doors or parts, or folders that hold some; one data set; one report "
                 "of eval, or a file of films")
      ->required();
  app.add_option("--out", options.out, "HTML file")->required();
  auto* episode = app.add_flag("--episode", options.episode, "the expert opening each door");
  app.add_option("--seed", options.seed, "of the scene, with --episode")->needs(episode);
  auto* doors =
      app.add_option("--doors", options.doors, "of a data set or report: folders with its doors");
  app.add_option("--stage", options.stage, "of a data set: only episodes of this stage")
      ->needs(doors)
      ->check(CLI::IsMember({"open", "handle", "grasp"}));
  app.add_option("--key", options.key, "of a data set: one episode, such as ep000012")
      ->needs(doors);
  app.add_option("--episodes", options.episodes, "of a data set: at most so many")
      ->needs(doors)
      ->check(CLI::Range(1, 1000));
  app.add_option("--films", options.films, "of a data set: of `dataset films --stored`")
      ->needs(doors);
  app.add_option("--points", options.points, "of each cloud of an episode; 0: none")
      ->check(CLI::Range(0, 65536));
  app.add_option("--robot", options.robot,
                 "URDF of the robot of episodes; the built-in one if left out");
  AddThreads(app, options.threads);
  app.add_flag("--gallery", options.gallery,
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

ViewPage PageOf(const ViewOptions& options) {
  const std::vector<fs::path> doors(options.doors.begin(), options.doors.end());
  const ShownRobot robot{options.robot, RobotMeshes()};
  if (options.paths.size() == 1 && IsReport(options.paths[0]))
    return MakeReportPage({options.paths[0], doors, robot, options.threads});
  if (!options.doors.empty()) {
    Require(options.paths.size() == 1, ErrorCode::kInvalidArgument, "--doors: is of one data set");
    return MakeDatasetPage({.dataset = options.paths[0],
                            .doors = doors,
                            .stage = options.stage,
                            .key = options.key,
                            .most = options.episodes,
                            .points = options.points,
                            .threads = options.threads,
                            .robot = robot,
                            .films = options.films});
  }
  std::vector<fs::path> folders;
  for (const std::string& path : options.paths) {
    for (fs::path& folder : FindRecords(path)) folders.push_back(std::move(folder));
  }
  if (options.episode)
    return MakeExpertPage(folders, {.seed = options.seed,
                                    .points = options.points,
                                    .threads = options.threads,
                                    .robot = robot});
  if (options.gallery || folders.size() > kMostInOneList)
    return MakeGalleryPage(folders, {.threads = options.threads});
  return MakeRecordPage(folders, {.threads = options.threads});
}

}  // namespace

int RunViewVerb(int argc, char** argv) {
  const ViewOptions options = ParseView(argc, argv);
  RequireNoFile(options.out, options.overwrite);
  const ViewPage page = PageOf(options);
  CommitFile(options.out, page.html);
  for (const std::string& fault : page.faults)
    std::fprintf(stderr, "doorforge: %s\n", fault.c_str());
  std::printf("%s: %zu shown, %.2f MB\n", options.out.c_str(), page.shown,
              static_cast<double>(page.html.size()) / 1e6);
  if (options.open) RunChild({"xdg-open", options.out});
  return page.faults.empty() ? 0 : 1;
}

}  // namespace doorforge
