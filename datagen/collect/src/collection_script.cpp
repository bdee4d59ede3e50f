// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/collection_script.h"

#include <algorithm>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/program.h"

#include "dataset_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTasksByDefault = 1000;

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

// Writing an equal script again is no loss.
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

CollectionScript WriteCollectionScript(const CollectionScriptRequest& request) {
  const StageRun run(request.stage);
  SlurmScript script = request.script;
  if (script.program.empty()) script.program = (ProgramFolder() / "doorforge").string();
  if (script.work_folder.empty()) script.work_folder = fs::current_path().string();
  {
    const FolderLock lock = LockDatasetFolder(script.dataset, request.replace);
    PrepareDatasetFolder(script.dataset, request.replace);
  }
  const std::size_t shards = run.plan().shards.size();
  if (script.tasks == 0) script.tasks = static_cast<int>(std::min(shards, kMostTasksByDefault));
  script.threads = std::max(script.threads, 1);
  script.dataset = FolderText(script.dataset);
  script.arguments = ArgumentsOfTask(script.arguments);
  CommitScript(request.file, SlurmScriptText(script),
               request.replace ? Existing::kReplace : Existing::kRefuse);
  return {script.tasks, shards, CutIntoArrays(script.tasks, script.array_size).size()};
}

std::string ScriptText(const CollectionScript& written, const fs::path& file) {
  return file.string() + ": " + std::to_string(written.tasks) + " tasks of " +
         std::to_string(written.shards) + " shards in " + std::to_string(written.arrays) +
         " arrays";
}

}  // namespace doorforge
