// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/output_file.h"
#include "doorforge/preview/draw_records.h"
#ifdef DOORFORGE_WITH_OPENABLE
#include "doorforge/rollout/episode_sheet.h"
#endif
#include "doorforge/validate/validate_door.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct PreviewOptions {
  std::vector<std::string> paths;
  std::string out;
  PreviewConfig preview;
  bool episode = false;
  bool overwrite = false;
  std::uint64_t seed = 1;  // of the episode
  int frames = 7;          // the same
};

PreviewOptions ParsePreview(int argc, char** argv) {
  PreviewOptions options;
  CLI::App app("Pictures of doors and parts; a contact sheet where there are several.",
               "doorforge preview");
  app.add_option("PATH,--door", options.paths,
                 "folders of doors or parts, or folders that hold some")
      ->required();
  app.add_option("--out", options.out, "PNG file")->required();
  app.add_option("--hinge-deg", options.preview.hinge_deg,
                 "open doors by this angle, within their limits")
      ->check(CLI::Range(0.0, 180.0));
  app.add_option("--handle-deg", options.preview.handle_deg,
                 "turn handles by this angle, within their limits")
      ->check(CLI::Range(-90.0, 90.0));
  app.add_option("--azimuth-deg", options.preview.azimuth_deg,
                 "where to stand: 0 in front, positive towards the free edge")
      ->check(CLI::Range(-180.0, 180.0));
  app.add_option("--columns", options.preview.columns, "of a contact sheet")
      ->check(CLI::Range(1, 24));
  AddChoice(app, "--focus", options.preview.focus,
            "all: the whole and the handle large from three sides, with a bar of 50 mm and the "
            "axes (of one door or handle, if left out); whole; handle");
  app.add_option("--width", options.preview.width,
                 "of each picture in pixels; 960, with the handle beside it 640, on a sheet 320")
      ->check(CLI::Range(32, 4096));
  AddThreads(app, options.preview.threads);
  AddOverwrite(app, options.overwrite, "replace --out if it is there");
  app.add_flag("--collision", options.preview.collision, "draw the collision shapes instead");
#ifdef DOORFORGE_WITH_OPENABLE
  app.add_flag("--episode", options.episode,
               "a film strip of the expert opening the door; a row each where there are several");
  app.add_option("--seed", options.seed, "of the scene, with --episode")->needs("--episode");
  app.add_option("--frames", options.frames, "of the strip, with --episode")
      ->needs("--episode")
      ->check(CLI::Range(2, 40));
#endif
  app.footer(
      "examples:\n"
      "  doorforge preview parts --out parts.png\n"
      "  doorforge preview doors/mine --hinge-deg 40 --handle-deg 30 --out mine.png\n"
      "  doorforge preview doors --focus handle --out handles.png\n"
      "  doorforge preview --episode --door doors/mine --seed 3 --out opened.png");
  ParseVerb(app, argc, argv);
  return options;
}

}  // namespace

int RunPreviewVerb(int argc, char** argv) {
  const PreviewOptions options = ParsePreview(argc, argv);
  RequireNoFile(options.out, options.overwrite);
  const std::vector<fs::path> folders = FindRecords(options.paths);
#ifdef DOORFORGE_WITH_OPENABLE
  if (options.episode) {
    const EpisodeSheet sheet = DrawEpisodeSheet(folders, {.seed = options.seed,
                                                          .frames = options.frames,
                                                          .width = options.preview.width,
                                                          .threads = options.preview.threads});
    WritePng(options.out, sheet.picture);
    std::printf("%s", OutcomesText(folders, sheet).c_str());
    return 0;
  }
#endif
  WritePng(options.out, DrawRecords(folders, options.preview));
  std::printf("%s: %zu pictured\n", options.out.c_str(), folders.size());
  return 0;
}

}  // namespace doorforge
