// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "slurm_verb.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/dataset/slurm_script.h"
#include "doorforge/dataset/task_number.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr int kMostTasksByDefault = 1000;

struct Flag {
  const char* name;
  bool has_value;
};

// What a task of the script gets from the script itself, or does not need.
constexpr Flag kOwnFlags[] = {
    {"--slurm", true},          {"--submit", false},      {"--slurm-array", true},
    {"--slurm-parallel", true}, {"--slurm-memory", true}, {"--slurm-option", true},
    {"--tasks", true},          {"--threads", true},      {"-j", true},
    {"--overwrite", false},     {"--resume", false},      {"--json", false}};

// How many words from `word` on are one of these flags: 0, 1 or 2.
std::size_t OwnWords(const std::string& word) {
  for (const Flag& flag : kOwnFlags) {
    const std::string name = flag.name;
    if (word == name) return flag.has_value ? 2 : 1;
    if (word.starts_with(name + "=")) return 1;
    if (name == "-j" && word.starts_with(name)) return 1;
  }
  return 0;
}

std::vector<std::string> ArgumentsOfTask(const std::vector<std::string>& arguments) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < arguments.size();) {
    const std::size_t own = OwnWords(arguments[i]);
    if (own == 0) kept.push_back(arguments[i]);
    i += std::max<std::size_t>(own, 1);
  }
  return kept;
}

// Absolute, and without a slash at the end.
std::string FolderText(const std::string& folder) {
  fs::path path = fs::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return path.string();
}

// The same script again is no loss.
void CommitScript(const fs::path& file, const std::string& text, Existing existing) {
  const bool is_there = fs::exists(fs::symlink_status(file));
  if (is_there && existing == Existing::kRefuse) {
    if (fs::is_regular_file(file) && ReadFile(file) == text) return;
    throw Error(ErrorCode::kInvalidArgument,
                file.string() +
                    ": already exists and is another file; remove it or give --slurm another name "
                    "(--overwrite replaces it, and the dataset in --out with it)");
  }
  CommitFile(file, text, existing);
}

}  // namespace

void AddSlurmOptions(CLI::App& app, SlurmOptions& options) {
  auto* file = app.add_option("--slurm", options.file,
                              "write a script that runs this collection as Slurm arrays of --tasks "
                              "tasks, with the merge and the verification after them");
  app.add_flag("--submit", options.submit, "and submit it")->needs(file);
  app.add_option("--slurm-array", options.array_size, "Slurm's MaxArraySize")
      ->check(CLI::Range(1, 4000001))
      ->capture_default_str()
      ->needs(file);
  app.add_option("--slurm-parallel", options.parallel, "most tasks of an array at once, 0: all")
      ->check(CLI::Range(0, 4000001))
      ->needs(file);
  app.add_option("--slurm-memory", options.memory, "a task's memory, as sbatch --mem takes it")
      ->capture_default_str()
      ->needs(file);
  app.add_option("--slurm-option", options.options, "another one for sbatch: --partition=long")
      ->needs(file);
}

int RunSlurm(const SlurmJob& job, const SlurmOptions& options, Existing existing) {
  SlurmScript script;
  script.program = (ProgramFolder() / "doorforge").string();
  script.work_folder = fs::current_path().string();
  script.dataset = FolderText(job.dataset);
  script.arguments = ArgumentsOfTask(job.arguments);
  script.tasks = job.tasks > 0
                     ? job.tasks
                     : static_cast<int>(std::min<std::size_t>(job.shards, kMostTasksByDefault));
  script.array_size = options.array_size;
  script.parallel = options.parallel;
  script.threads = std::max(job.threads, 1);
  script.memory = options.memory;
  script.options = options.options;
  CommitScript(options.file, SlurmScriptText(script), existing);
  std::fprintf(stderr, "doorforge: %s: %d tasks of %zu shards in %zu arrays\n",
               options.file.c_str(), script.tasks, job.shards,
               CutIntoArrays(script.tasks, script.array_size).size());
  if (options.submit) return RunChild({"/bin/bash", fs::absolute(options.file).string()});
  std::printf("bash %s\n", options.file.c_str());
  return 0;
}

}  // namespace doorforge
