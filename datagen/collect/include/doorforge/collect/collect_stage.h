// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "doorforge/collect/stage_run.h"
#include "doorforge/dataset/collect.h"

namespace doorforge {

/// A stage's collection, and the folder that it goes to.
struct CollectStageRequest {
  StageRequest stage;
  std::filesystem::path out;  ///< Folder of the dataset; made if it is not there.
  CollectionTask task;        ///< The whole plan by default.
  /// True: a dataset that is in `out` is removed first. False: it is gone on with if it is of the
  /// same settings, and refused if not.
  bool replace = false;
  /// Is told, before the first episode, what may go wrong later. May be empty.
  std::function<void(const std::string&)> warn;
};

/// Runs the episodes of a stage and writes them as a dataset. While it runs, the folder is locked:
/// the tasks of one collection write side by side, who replaces a dataset writes alone.
///
/// @throws Error(kInvalidArgument) if `out` is a file, holds something else than a dataset, or is
///     written by somebody else; Error(kIo) if the disk has certainly no room for clouds and
///     pictures; as StageRun and Collect().
CollectSummary CollectStage(const CollectStageRequest& request);

}  // namespace doorforge
