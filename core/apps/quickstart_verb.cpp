// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/pipeline/pipeline_graph.h"
#include "doorforge/pipeline/pipeline_run.h"
#include "doorforge/pipeline/quickstart_split.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string assets;
  std::string out = "run/quickstart";
  int episodes = 220;
  int epochs = 4;
  int threads = 0;
  std::uint64_t seed = 7;
  bool overwrite = false;
  bool resume = false;
};

void ParseOptions(int argc, char** argv, Options& options) {
  CLI::App app(
      "The whole chain at small size: parts -> doors -> validation -> shards -> policy -> report.\n"
      "Without --assets it runs on the embedded catalogue, with it on imported real objects.",
      "doorforge quickstart");
  app.add_option("--assets", options.assets, "folder of UniDoorManip objects to import")
      ->check(CLI::ExistingDirectory);
  app.add_option("--out", options.out, "folder for everything that is made")->capture_default_str();
  app.add_option("--episodes", options.episodes, "expert episodes to collect")
      ->check(CLI::Range(4, 1000000))
      ->capture_default_str();
  app.add_option("--epochs", options.epochs, "passes over the collected samples")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "decides every random choice")->capture_default_str();
  app.add_flag("--overwrite", options.overwrite, "replace the folder --out");
  app.add_flag("--resume", options.resume, "keep the steps that are done in --out");
  app.footer("example:\n  doorforge quickstart --out run/quickstart");
  ParseVerb(app, argc, argv);
}

void ComposeDoors(const std::vector<DoorPair>& pairs, const fs::path& out, int threads) {
  const std::string program = (ProgramFolder() / "doorforge-assets").string();
  Progress progress("compose", pairs.size());
  ParallelFor(pairs.size(), threads, [&](std::size_t i) {
    const DoorPair& pair = pairs[i];
    const fs::path door = OutputBelow(out / pair.subset, pair.body_id + "__" + pair.handle_id);
    if (!fs::exists(door / "door.json")) {
      const int code =
          RunChild({program, "compose", "--body", pair.body_folder.string(), "--handle",
                    pair.handle_folder.string(), "--out", door.string(), "--quiet"});
      if (code != 0)
        throw Error(ErrorCode::kIncomplete,
                    door.string() + ": compose ended with exit code " + std::to_string(code));
    }
    progress.Advance();
  });
}

// The record of the first step, which is there as soon as anything is.
constexpr FolderKind kQuickstartFolder{"a quickstart", "pipeline/parts.json",
                                       "doorforge.pipeline_step"};

bool IsEmptyFolder(const fs::path& folder) {
  return fs::is_directory(fs::symlink_status(folder)) && fs::is_empty(folder);
}

// Not while another process makes it.
void RemoveQuickstart(const fs::path& out) {
  RequireKind(out, kQuickstartFolder);
  const auto lock = FileLock::Try(SystemFiles(), out / "pipeline" / "lock");
  Require(lock.has_value(), ErrorCode::kInvalidArgument,
          out.string() +
              ": another process runs a pipeline there; wait until it has ended, or choose "
              "another folder");
  fs::remove_all(out);
}

void PrepareFolder(const Options& options) {
  const fs::path out = options.out;
  if (options.overwrite && fs::exists(fs::symlink_status(out)) && !IsEmptyFolder(out))
    RemoveQuickstart(out);
  if (!options.resume && fs::exists(out) && !fs::is_empty(out))
    throw Error(ErrorCode::kInvalidArgument,
                options.out + ": already exists; pass --resume to go on there, or --overwrite");
  SystemFiles().CreateFolder(out);
}

// real objects in place of the catalogue
void ImportParts(Pipeline& pipeline, const std::string& assets) {
  PipelineStep& parts = pipeline.steps.at(0);
  parts.does = "Parts from real objects";
  parts.command = {"import", assets,    "--only",    "interior,storagefurniture",
                   "--out",  "{parts}", "--threads", "{threads}"};
  parts.fine_codes = {0, 1};  // some objects were refused, the others are done
}

// `doorforge quickstart doors`: the step that draws and composes the pairs
int RunDoors(int argc, char** argv) {
  std::string parts;
  std::string out;
  int threads = 0;
  std::uint64_t seed = 7;
  CLI::App app("Draws training and held-out pairs of parts, and composes them.",
               "doorforge quickstart doors");
  app.add_option("--parts", parts, "folder of parts")->required()->check(CLI::ExistingDirectory);
  app.add_option("--out", out, "folder of the doors")->required();
  app.add_option("--seed", seed, "decides which pairs")->capture_default_str();
  app.add_option("--threads", threads, "threads, 0: all")->check(CLI::Range(0, 1024));
  ParseVerb(app, argc, argv);
  ComposeDoors(SplitIntoDoors(parts, seed), out, threads);
  return 0;
}

}  // namespace

int RunQuickstartVerb(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "doors") return RunDoors(argc - 1, argv + 1);
  Options options;
  ParseOptions(argc, argv, options);
  PrepareFolder(options);
  Pipeline pipeline = ReadPipeline("quickstart", {"seed=" + std::to_string(options.seed),
                                                  "episodes=" + std::to_string(options.episodes),
                                                  "epochs=" + std::to_string(options.epochs)});
  if (!options.assets.empty()) ImportParts(pipeline, options.assets);
  return RunPipeline(
      pipeline,
      {.out = options.out, .threads = options.threads, .again = "run again with --resume"});
}

}  // namespace doorforge
