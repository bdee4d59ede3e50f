// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of `doorforge dataset`.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/cli/forwarded_options.h"
#include "doorforge/collect/episode_charts.h"
#include "doorforge/collect/regenerate_dataset.h"
#include "doorforge/collect/reobserve.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/dataset/collection_status.h"
#include "doorforge/dataset/dataset_card.h"
#include "doorforge/dataset/describe_dataset.h"
#include "doorforge/dataset/describe_episodes.h"
#include "doorforge/dataset/export_lerobot.h"
#include "doorforge/dataset/export_robomimic.h"
#include "doorforge/dataset/merge_dataset.h"
#include "doorforge/dataset/task_number.h"
#include "doorforge/dataset/verify_dataset.h"
#include "doorforge/robot_meshes/robot_meshes.h"
#include "doorforge/sensor/picture.h"

#include "verbs.h"

namespace doorforge {
namespace {

/// A subcommand of `doorforge dataset`.
struct Subcommand {
  CLI::App* app = nullptr;
  std::function<int()> run;  ///< After it was parsed; returns the exit code.
};

constexpr const char* kRobotOption =
    "URDF of the dataset's robot, where its config.yaml names a file outside its folder";

struct DatasetVerifyOptions {
  ThoroughVerification request;
  bool json = false;
};

int Verify(const DatasetVerifyOptions& options) {
  const auto [findings, note] = VerifyThoroughly(options.request);
  if (!note.empty()) PrintNote(note);
  PrintAnswer(options.json, FindingsToJson(findings),
              FindingsText(findings, options.request.verify.folder));
  return AnyFault(findings) ? 1 : 0;
}

// What a dataset was made with, for who makes episodes again.
std::vector<CLI::Option*> AddMadeWithOptions(CLI::App& app, RegenerateDatasetRequest& given) {
  CollectionWords& who = given.policies;
  given.robot_meshes = RobotMeshes();
  return {app.add_option("--doors", given.doors, "the doors that the dataset was made with"),
          app.add_option("--robot", given.robot, kRobotOption),
          app.add_option("--handler", who.handler, "the policy that turned the handle"),
          app.add_option("--opener", who.opener, "the policy that opened"),
          app.add_option("--learner", who.learner, "the policy that drove or took hold")};
}

Subcommand AddVerify(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetVerifyOptions>();
  CLI::App* app = dataset.add_subcommand(
      "verify", "every byte against its checksum or origin, every value against what it may be");
  app->add_option("folder", options->request.verify.folder, "the dataset's folder")->required();
  AddJson(*app, options->json);
  AddThreads(*app, options->request.verify.threads, "threads, 0: all");
  auto* share = app->add_option("--regenerate", options->request.share,
                                "make a share again, such as 1%, and compare every byte");
  for (CLI::Option* option : AddMadeWithOptions(*app, options->request.regenerate))
    option->needs(share);
  share->needs(app->get_option("--doors"));
  app->footer(
      "examples:\n  doorforge dataset verify data/open\n"
      "  doorforge dataset verify data/open --regenerate 1% --doors doors/train");
  return {app, [options] { return Verify(*options); }};
}

struct DatasetMergeOptions {
  MergeRequest request;
  bool json = false;
};

int Merge(const DatasetMergeOptions& options) {
  const auto& folder = options.request.folder;
  const FolderLock lock(folder, "doorforge dataset merge", Writers::kOne);
  const MergeSummary summary = MergeDataset(options.request);
  PrintNote(folder.string() + ": " + std::to_string(summary.shards) + " shards, " +
            std::to_string(summary.linked) + " linked, " + std::to_string(summary.copied) +
            " copied");
  const nlohmann::ordered_json description = DescribeDataset(folder);
  PrintAnswer(options.json, description, DescriptionText(description));
  return 0;
}

Subcommand AddMerge(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetMergeOptions>();
  CLI::App* app = dataset.add_subcommand(
      "merge", "joins the tasks of a collection and checks that all of them are there");
  app->add_option("folder", options->request.folder, "the dataset's folder")->required();
  AddJson(*app, options->json);
  app->add_option("parts", options->request.parts,
                  "folders of tasks; none where all tasks wrote into the dataset's folder");
  app->footer(
      "examples:\n  doorforge dataset merge data\n"
      "  doorforge dataset merge data node1/data node2/data");
  return {app, [options] { return Merge(*options); }};
}

int Reobserve(const ReobserveRequest& request) {
  const CollectSummary summary = ReobserveDataset(request);
  if (summary.stopped_by_signal != 0)
    return ExitCodeOfStopped(
        summary.stopped_by_signal,
        "what is done is kept in " + request.out.string() + ", the same command goes on");
  PrintText(DescriptionText(DescribeDataset(request.out)));
  return 0;
}

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
  app->add_option("--robot", request->robot, kRobotOption);
  app->add_flag("--without-robot", request->without_robot,
                "only the door is seen: the pair of what the robot hides");
  AddThreads(*app, request->threads, "threads, 0: all; does not change the bytes");
  app->footer(
      "examples:\n"
      "  doorforge dataset re-observe data --doors doors --out data_free --without-robot\n"
      "  doorforge dataset re-observe data --doors doors --out data_noisy --set "
      "cloud.noise.sensor=structured_light");
  return {app, [request] { return Reobserve(*request); }};
}

struct DatasetStatusOptions {
  StatusRequest request;
  double every_s = 5;
  bool watch = false;
  bool json = false;
};

int Status(const DatasetStatusOptions& options) {
  const auto show = [&](const CollectionStatus& status, double now_s) {
    // on a terminal each look takes the place of the one before
    if (options.watch && !options.json && ::isatty(STDOUT_FILENO) == 1) PrintText("\033[H\033[J");
    PrintText(options.json ? JsonText(StatusToJson(status, now_s), options.watch ? -1 : 2) + "\n"
                           : StatusText(status, now_s) + (options.watch ? "\n" : ""));
  };
  const std::chrono::duration<double> every(options.every_s);
  const std::optional<CollectionStatus> status = options.watch
                                                     ? WatchCollection(options.request, every, show)
                                                     : LookAtCollection(options.request, show);
  if (!status) return 128 + StopRequested();
  return status->is_complete ? 0 : 4;
}

Subcommand AddStatus(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetStatusOptions>();
  CLI::App* app = dataset.add_subcommand(
      "status", "how far a collection is, while its tasks run or after: shards, rate, time left");
  app->add_option("folder", options->request.folders,
                  "the dataset's folder, and those of tasks that write into others")
      ->required();
  app->add_option("--tasks", options->request.tasks,
                  "N of `datagen --task i/N`, to tell how far each of them is")
      ->check(CLI::Range(1, kMostTasks));
  app->add_flag("--watch", options->watch, "look again and again until all shards are there");
  app->add_option("--every", options->every_s, "seconds between the looks of --watch")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  AddJson(*app, options->json, "print JSON: one document, or a line a look");
  app->footer(
      "Reads only, and takes no lock: writers never notice. Exit code 0 if the dataset is "
      "complete,\n4 if not.\n\n"
      "examples:\n  doorforge dataset status data --watch\n"
      "  doorforge dataset status data --tasks 16 --json");
  return {app, [options] { return Status(*options); }};
}

struct DatasetInfoOptions {
  std::string folder;
  std::string png;
  std::string html;
  std::string films;
  int examples = 2;
  int threads = 0;
  bool overwrite = false;
  bool json = false;
};

int Info(const DatasetInfoOptions& options) {
  RequireNoFile(options.png, options.overwrite);
  RequireNoFile(options.html, options.overwrite);
  nlohmann::ordered_json dataset = DescribeDataset(options.folder);
  const EpisodeDescription episodes = DescribeEpisodes(
      options.folder, options.html.empty() ? 0 : options.examples, options.threads);
  if (!options.png.empty()) WritePng(options.png, EpisodeCharts(episodes));
  if (!options.html.empty())
    CommitFile(options.html,
               DatasetPage(dataset, episodes, page::AddressOn(options.html, options.films)));
  const std::string text = DescriptionText(dataset) + StagesText(episodes);
  dataset["stages"] = StagesToJson(episodes);
  PrintAnswer(options.json, dataset, text);
  return 0;
}

Subcommand AddInfo(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetInfoOptions>();
  CLI::App* app = dataset.add_subcommand(
      "info", "counts, success by category and mechanism, angles, causes of failure");
  app->add_option("folder", options->folder, "the dataset's folder")->required();
  app->add_option("--png", options->png, "picture of the hinge angles, one chart a category");
  auto* html = app->add_option("--html", options->html,
                               "one page with everything, that needs no other file");
  app->add_option("--films", options->films,
                  "page of `doorforge view` with the films of `dataset films`: every failure on "
                  "the page is linked to its own")
      ->needs(html)
      ->check(CLI::ExistingFile);
  app->add_option("--examples", options->examples, "episodes a category that the page shows")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  AddThreads(*app, options->threads, "threads, 0: all");
  AddOverwrite(*app, options->overwrite, "replace --png and --html if they are there");
  AddJson(*app, options->json);
  app->footer("example:\n  doorforge dataset info data --html data.html --png data.png");
  return {app, [options] { return Info(*options); }};
}

struct DatasetExportOptions {
  RobomimicRequest request;
  std::string to;
  std::string python = "python3";
  bool json = false;
};

int Export(const CLI::App& app, DatasetExportOptions& options) {
  RobomimicRequest& request = options.request;
  if (options.to == "lerobot")
    return RunLerobotExport(options.python, request.folder, GivenWords(app, {"--to", "--python"}));
  RefuseForwarded(app, LerobotOptions(), "--to lerobot");
  Progress progress("export", CountEpisodes(request.folder, request.stage));
  request.on_episode = [&] { progress.Advance(); };
  const RobomimicSummary summary = ExportRobomimic(request);
  if (summary.stopped_by_signal != 0)
    return ExitCodeOfStopped(summary.stopped_by_signal,
                             "nothing was left in " + request.out.string());
  PrintAnswer(options.json, ExportToJson(request, summary), ExportText(request, summary));
  return 0;
}

Subcommand AddExport(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetExportOptions>();
  CLI::App* app = dataset.add_subcommand("export", "writes the episodes as other tools want them");
  app->add_option("folder", options->request.folder, "the dataset's folder")->required();
  app->add_option("--to", options->to, "robomimic: one HDF5 file; lerobot: a folder of Parquet")
      ->required()
      ->check(CLI::IsMember({"robomimic", "lerobot"}));
  app->add_option("--stage", options->request.stage, "an export holds one stage")
      ->check(CLI::IsMember({"open", "handle", "grasp"}))
      ->capture_default_str();
  app->add_option("--out", options->request.out, "the file or folder to write")->required();
  AddOverwrite(*app, options->request.existing, "robomimic: replace the file if it is there");
  AddJson(*app, options->json);
  app->add_option("--python", options->python, "lerobot: Python 3.11 or later with pyarrow");
  AddForwarded(*app, LerobotOptions());
  app->footer(
      "examples:\n  doorforge dataset export data --to robomimic --out data.hdf5\n"
      "  doorforge dataset export data --to lerobot --out data_lerobot");
  return {app, [app, options] { return Export(*app, *options); }};
}

struct DatasetCardOptions {
  std::string folder;
  OldReadme readme = OldReadme::kRefuseOthers;
};

int WriteCard(const DatasetCardOptions& options) {
  WriteDatasetCard(options.folder, options.readme);
  PrintText(options.folder + "/README.md\n" + options.folder + "/croissant.json\n");
  return 0;
}

Subcommand AddCard(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetCardOptions>();
  CLI::App* app = dataset.add_subcommand(
      "card", "writes README.md (YAML front matter) and croissant.json into the dataset");
  app->add_option("folder", options->folder, "the dataset's folder")->required();
  const auto add_flag = [&](const char* name, OldReadme means, const char* about) {
    return app->add_flag_callback(
        name, [options, means] { options->readme = means; }, about);
  };
  auto* overwrite =
      add_flag("--overwrite", OldReadme::kReplace,
               "replace a README.md or croissant.json that was written or changed by hand");
  add_flag("--keep-readme", OldReadme::kKeep,
           "leave README.md as it is; `verify` takes it as it is from now on")
      ->excludes(overwrite);
  app->footer("example:\n  doorforge dataset card data");
  return {app, [options] { return WriteCard(*options); }};
}

struct DatasetFilmsOptions {
  FilmDatasetRequest request;
  std::string out;
  bool overwrite = false;
};

int Films(DatasetFilmsOptions& options) {
  RequireNoFile(options.out, options.overwrite);
  const std::vector<EpisodeFilm> films = FilmDataset(options.request);
  WriteFilms(options.out, films);
  PrintText(options.out + ": " + std::to_string(films.size()) + " films\n");
  return 0;
}

Subcommand AddFilms(CLI::App& dataset) {
  const auto options = std::make_shared<DatasetFilmsOptions>();
  RegenerateDatasetRequest& request = options->request.made_with;
  CLI::App* app = dataset.add_subcommand(
      "films", "the course of every planned episode that failed, made again from its seed");
  app->add_option("folder", request.folder, "the dataset's folder")->required();
  app->add_option("--out", options->out, "file for `doorforge view`: films.jsonl")->required();
  app->add_option("--stored", options->request.stored, "of the first N that are stored instead")
      ->check(CLI::PositiveNumber);
  AddMadeWithOptions(*app, request)[0]->required();
  AddThreads(*app, request.threads, "threads, 0: all");
  AddOverwrite(*app, options->overwrite, "replace --out if it is there");
  app->footer(
      "example:\n  doorforge dataset films data --doors doors --out films.jsonl\n"
      "  doorforge view films.jsonl --doors doors --out films.html\n"
      "  doorforge dataset info data --html data.html --films films.html");
  return {app, [options] { return Films(*options); }};
}

}  // namespace

int RunDatasetVerb(int argc, char** argv) {
  CLI::App app("Checks and describes datasets.", "doorforge dataset");
  app.require_subcommand(1);
  app.footer("examples:\n  doorforge dataset verify data/open\n  doorforge dataset info data/open");
  const Subcommand subcommands[] = {AddVerify(app), AddMerge(app), AddReobserve(app),
                                    AddStatus(app), AddInfo(app),  AddExport(app),
                                    AddCard(app),   AddFilms(app)};
  ParseVerb(app, argc, argv, EmptyValues::kRefuse);
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.app->parsed()) return subcommand.run();
  }
  return 0;  // not reached: the parser asks for a subcommand
}

}  // namespace doorforge
