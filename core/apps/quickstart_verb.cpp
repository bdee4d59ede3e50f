// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "quickstart_verb.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"

#include "quickstart_split.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

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
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    std::exit(app.exit(help));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::kInvalidArgument,
                std::string(error.what()) + "; see `doorforge quickstart --help`");
  }
}

std::string Program(const char* name) { return (ProgramFolder() / name).string(); }

struct Step {
  std::string title;
  std::vector<std::string> argv;
  std::string when_resumed = {};   // flag that lets the verb go on with what an earlier try left
  bool findings_are_fine = false;  // exit code 1 means faulty items; the others are done
};

// Runs each step as its own program and leaves a marker once it is done.
class Steps {
 public:
  explicit Steps(const Options& options) : options_(options), start_(Clock::now()) {}

  void Run(const Step& step) {
    Announce(step.title);
    const fs::path marker =
        fs::path(options_.out) / "steps" / (std::to_string(count_) + "-" + step.argv[1] + ".done");
    if (options_.resume && fs::exists(marker)) {
      std::fprintf(stderr, "   done before\n");
      return;
    }
    std::vector<std::string> argv = step.argv;
    if (options_.resume && !step.when_resumed.empty()) argv.push_back(step.when_resumed);
    std::string line = "doorforge";
    for (std::size_t i = 1; i < argv.size(); ++i) line += " " + argv[i];
    std::fprintf(stderr, "   $ %s\n", line.c_str());
    const int code = RunChild(argv);
    if (code == 130 || code == 143) throw Stopped{code};
    if (code != 0 && !(code == 1 && step.findings_are_fine))
      throw Error(ErrorCode::kIncomplete, "step \"" + step.title + "\" ended with exit code " +
                                              std::to_string(code) +
                                              "; repair its cause and run again with --resume");
    CommitFile(marker, line + "\n");
  }

  void Announce(const std::string& title) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    std::fprintf(stderr, "\n== %d. %s   (at %.0f s)\n", ++count_, title.c_str(), seconds);
  }

  struct Stopped {
    int code;
  };

 private:
  const Options& options_;
  Clock::time_point start_;
  int count_ = 0;
};

void ComposeDoors(const std::vector<DoorPair>& pairs, const fs::path& out, const Options& options) {
  Progress progress("compose", pairs.size());
  ParallelFor(pairs.size(), options.threads, [&](std::size_t i) {
    const DoorPair& pair = pairs[i];
    const fs::path door = out / pair.subset / (pair.body_id + "__" + pair.handle_id);
    if (!fs::exists(door / "door.json")) {
      const int code =
          RunChild({Program("doorforge-assets"), "compose", "--body", pair.body_folder.string(),
                    "--handle", pair.handle_folder.string(), "--out", door.string(), "--quiet"});
      if (code != 0)
        throw Error(ErrorCode::kIncomplete,
                    door.string() + ": compose ended with exit code " + std::to_string(code));
    }
    progress.Advance();
  });
}

void PrintSuccess(const fs::path& report) {
  const auto json = ReadJsonFile(report / "report.json");
  std::printf("\n%-18s %8s   %s\n", "success > 45 deg", "rate", "95 % interval   episodes");
  for (const auto& [name, row] : MemberOf(json, "success", "report.json").items()) {
    std::printf("%-18s %6.1f %%   %.1f - %.1f %%   %d\n", name.c_str(),
                100 * ValueOf<double>(row, "rate", name), 100 * ValueOf<double>(row, "low", name),
                100 * ValueOf<double>(row, "high", name), ValueOf<int>(row, "episodes", name));
  }
  std::printf("\nreport: %s\n", fs::absolute(report / "report.html").lexically_normal().c_str());
}

void PrepareFolder(const Options& options) {
  const fs::path out = options.out;
  if (options.overwrite) fs::remove_all(out);
  if (!options.resume && fs::exists(out) && !fs::is_empty(out))
    throw Error(ErrorCode::kInvalidArgument,
                options.out + ": already exists; pass --resume to go on there, or --overwrite");
  fs::create_directories(out);
}

void RunChain(const Options& options) {
  const fs::path out = options.out;
  const std::string threads = std::to_string(options.threads);
  const std::string seed = std::to_string(options.seed);
  const std::string parts = out / "parts";
  const std::string train_doors = out / "doors/train";
  const std::string test_doors = out / "doors/test";
  const std::string shards = out / "data";
  const std::string policy = out / "policy";
  Steps steps(options);
  if (options.assets.empty()) {
    steps.Run(
        {"Parts of the embedded catalogue",
         {Program("doorforge-assets"), "catalog", "build", "--split", "quickstart", "--out", parts},
         "--overwrite"});
  } else {
    steps.Run({"Parts from real objects",
               {Program("doorforge-assets"), "import", options.assets, "--only",
                "interior,storagefurniture", "--out", parts, "--threads", threads},
               "--overwrite",
               true});
  }
  steps.Announce("Doors: training and held-out parts never meet");
  ComposeDoors(SplitIntoDoors(parts, options.seed), out / "doors", options);
  steps.Run(
      {"Validation", {Program("doorforge-assets"), "validate", train_doors, test_doors}, {}, true});
  steps.Run(
      {"Shards: the expert opens the training doors",
       {Program("doorforge-datagen"), "datagen", "open", "--doors", train_doors, "--out", shards,
        "--episodes", std::to_string(options.episodes), "--seed", seed, "--threads", threads},
       "--resume"});
  steps.Run({"Checksums", {Program("doorforge-datagen"), "dataset", "verify", shards}});
  steps.Run({"Training",
             {Program("doorforge-train"), "train", "open", "--data", shards, "--out", policy,
              "--epochs", std::to_string(options.epochs), "--seed", seed, "--threads", threads},
             "--resume"});
  steps.Run({"Evaluation on doors whose parts were never seen",
             {Program("doorforge-eval"), "eval", "--policy", policy, "--doors", test_doors,
              "--data", shards, "--out", out / "report", "--seeds", "3", "--episodes-per-door", "2",
              "--threads", threads},
             "--overwrite"});
}

}  // namespace

int RunQuickstartVerb(int argc, char** argv) {
  Options options;
  ParseOptions(argc, argv, options);
  PrepareFolder(options);
  try {
    RunChain(options);
  } catch (const Steps::Stopped& stopped) {
    std::fprintf(stderr, "doorforge: stopped; run again with --resume\n");
    return stopped.code;
  }
  PrintSuccess(fs::path(options.out) / "report");
  return 0;
}

}  // namespace doorforge
