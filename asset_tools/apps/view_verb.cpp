// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/program.h"
#include "doorforge/validate/validate_door.h"
#include "doorforge/view/gallery_page.h"
#include "doorforge/view/record_page.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostInOneList = 40;

struct ViewOptions {
  std::vector<std::string> paths;
  std::string out;
  int threads = 0;
  bool gallery = false;
  bool open = false;
  bool overwrite = false;
};

ViewOptions ParseView(int argc, char** argv) {
  ViewOptions options;
  CLI::App app("Doors and parts in 3D, on one page that needs no network.", "doorforge view");
  app.add_option("PATH,--door", options.paths,
                 "folders of doors or parts, or folders that hold some")
      ->required();
  app.add_option("--out", options.out, "HTML file")->required();
  AddThreads(app, options.threads);
  app.add_flag("--gallery", options.gallery,
               "pictures to browse, with filters; without it for more than 40 doors and parts");
  app.add_flag("--open", options.open, "show it in the desktop's browser (xdg-open)");
  AddOverwrite(app, options.overwrite, "replace --out if it is there");
  app.footer(
      "examples:\n"
      "  doorforge view doors/mine --out mine.html --open\n"
      "  doorforge view parts/interior_lever_tube_01 --out lever.html\n"
      "  doorforge view doors --gallery --out doors.html");
  ParseVerb(app, argc, argv);
  return options;
}

}  // namespace

int RunViewVerb(int argc, char** argv) {
  const ViewOptions options = ParseView(argc, argv);
  RequireNoFile(options.out, options.overwrite);
  std::vector<fs::path> folders;
  for (const std::string& path : options.paths) {
    for (fs::path& folder : FindRecords(path)) folders.push_back(std::move(folder));
  }
  const ViewPage page = options.gallery || folders.size() > kMostInOneList
                            ? MakeGalleryPage(folders, {.threads = options.threads})
                            : MakeRecordPage(folders, {.threads = options.threads});
  CommitFile(options.out, page.html);
  for (const std::string& fault : page.faults)
    std::fprintf(stderr, "doorforge: %s\n", fault.c_str());
  std::printf("%s: %zu shown, %.2f MB\n", options.out.c_str(), page.shown,
              static_cast<double>(page.html.size()) / 1e6);
  if (options.open) RunChild({"xdg-open", options.out});
  return page.faults.empty() ? 0 : 1;
}

}  // namespace doorforge
