// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "doorforge/collect/stage_run.h"
#include "doorforge/dataset/slurm_script.h"

namespace doorforge {

/// A collection that is given to Slurm instead of being run here.
struct CollectionScriptRequest {
  StageRequest stage;
  std::filesystem::path file;  ///< The script was written there.
  /// What the tasks are and may take. Here `dataset` may be relative; `arguments` are those of the
  /// call that asks for the script, of which a task gets what is its own; of `tasks`, 0 means one a
  /// shard, at most 1000; of `threads`, 0 means 1. An empty `program` is the doorforge beside this
  /// one, an empty `work_folder` the current folder.
  SlurmScript script;
  /// True: another script in `file` is replaced, and a dataset in `script.dataset` removed.
  bool replace = false;
};

/// What the written script will run.
struct CollectionScript {
  int tasks = 0;
  std::size_t shards = 0;  ///< The plan has so many.
  std::size_t arrays = 0;
};

/// Checks the collection as if it were run, and writes the script that runs it as Slurm arrays. The
/// same script again is no fault.
///
/// @throws Error(kInvalidArgument) if another file is in the script's place, or the dataset's
/// folder
///     holds something else; as StageRun and SlurmScriptText().
CollectionScript WriteCollectionScript(const CollectionScriptRequest& request);

/// "FILE: 8 tasks of 16 shards in 1 arrays".
std::string ScriptText(const CollectionScript& written, const std::filesystem::path& file);

}  // namespace doorforge
