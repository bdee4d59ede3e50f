// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/slurm_script.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/dataset/task_number.h"

namespace doorforge {
namespace {

void RequireOneLine(const std::string& text) {
  Require(text.find_first_of("\n\r") == std::string::npos && text.find('\0') == std::string::npos,
          ErrorCode::kInvalidArgument, "slurm: a path or argument with a line break");
}

std::string Quoted(const std::string& text) {
  RequireOneLine(text);
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string QuotedAll(const std::vector<std::string>& texts) {
  std::string quoted;
  for (const std::string& text : texts) quoted += " " + Quoted(text);
  return quoted;
}

// "--array=0-1000%50"
std::string ArrayOption(const SlurmArray& array, int parallel) {
  return "--array=0-" + std::to_string(array.count - 1) +
         (parallel > 0 ? "%" + std::to_string(parallel) : "");
}

// `ids` are the arrays that Slurm has taken so far. Where it refuses another one (its limit of
// jobs, a MaxArraySize below ours), they must not run for nothing, and must not be there beside
// those of the next try.
std::string SubmitPart(const SlurmScript& script) {
  std::string text =
      "ids=()\n"
      "give_up() {\n"
      "  local code=$?\n"
      "  echo \"$script: sbatch refused a job${ids[*]:+; cancelling ${ids[*]}}\" >&2\n"
      "  if [ ${#ids[@]} -gt 0 ]; then scancel \"${ids[@]}\"; fi\n"
      "  exit \"$code\"\n"
      "}\n"
      "submit() {\n"
      "  mkdir -p \"$dataset.slurm\"\n"
      "  local id\n";
  for (const SlurmArray& array : CutIntoArrays(script.tasks, script.array_size))
    text += "  id=$(\"${sbatch[@]}\" --job-name=doorforge-task " +
            ArrayOption(array, script.parallel) +
            " --output=\"$logs/task-%A_%a.log\" \"$script\" task " + std::to_string(array.first) +
            ") || give_up\n  ids+=(\"${id%%;*}\")\n";
  return text +
         "  local all=${ids[*]}\n"
         "  id=$(\"${sbatch[@]}\" --job-name=doorforge-merge --dependency=\"afterok:${all// /:}\" "
         "\\\n"
         "    --kill-on-invalid-dep=yes --output=\"$logs/merge-%j.log\" \"$script\" merge) || "
         "give_up\n"
         "  local merge=${id%%;*}\n"
         "  ids+=(\"$merge\")\n"
         "  id=$(\"${sbatch[@]}\" --job-name=doorforge-verify --dependency=\"afterok:$merge\" \\\n"
         "    --kill-on-invalid-dep=yes --output=\"$logs/verify-%j.log\" \"$script\" verify) || "
         "give_up\n"
         "  echo \"tasks $all merge $merge verify ${id%%;*}\"\n"
         "}\n";
}

}  // namespace

std::vector<SlurmArray> CutIntoArrays(int tasks, int array_size) {
  std::vector<SlurmArray> arrays;
  for (int first = 0; first < tasks; first += array_size)
    arrays.push_back({first, std::min(array_size, tasks - first)});
  return arrays;
}

std::string SlurmScriptText(const SlurmScript& script) {
  Require(script.tasks >= 1 && script.tasks <= kMostTasks, ErrorCode::kInvalidArgument,
          "slurm: 1 to " + std::to_string(kMostTasks) + " tasks are possible");
  Require(script.array_size >= 1 && script.parallel >= 0 && script.threads >= 1,
          ErrorCode::kInvalidArgument, "slurm: array size, parallel tasks or threads out of range");
  const std::string tasks = std::to_string(script.tasks);
  return "#!/bin/bash\n"
         "# Collects a dataset of doorforge with Slurm: `bash THIS_FILE` submits " +
         tasks +
         " tasks, the merge and the\n"
         "# verification. Given again, it goes on; what is done ends at once.\n"
         "set -euo pipefail\n"
         "script=$(realpath \"$0\")\nprogram=" +
         Quoted(script.program) + "\ndataset=" + Quoted(script.dataset) +
         "\nlogs=${dataset//%/%%}.slurm  # sbatch writes a % for two\ncd " +
         Quoted(script.work_folder) +
         "\nsbatch=(sbatch --parsable --requeue --open-mode=append --nodes=1 --ntasks=1\n"
         "  --cpus-per-task=" +
         std::to_string(script.threads) + " --mem=" + Quoted(script.memory) +
         QuotedAll(script.options) + ")\n\n" + SubmitPart(script) +
         "\ncase ${1:-submit} in\n"
         "  submit) submit ;;\n"
         "  # the program itself takes SLURM_ARRAY_TASK_ID and refuses an empty one\n"
         "  task) exec \"$program\"" +
         QuotedAll(script.arguments) + " --threads " + std::to_string(script.threads) +
         " --tasks " + tasks +
         " --task-offset \"${2:?}\" ;;\n"
         "  merge) exec \"$program\" dataset merge \"$dataset\" ;;\n"
         "  verify) exec \"$program\" dataset verify \"$dataset\" --threads " +
         std::to_string(script.threads) +
         " ;;\n"
         "  *) echo \"$0: unknown role $1\" >&2; exit 2 ;;\n"
         "esac\n";
}

}  // namespace doorforge
