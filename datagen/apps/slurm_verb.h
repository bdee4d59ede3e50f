// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/core/committed_file.h"

namespace doorforge {

/// How a collection is given to Slurm instead of being run here.
struct SlurmOptions {
  std::string file;  ///< Of the script; empty: no Slurm.
  bool submit = false;
  int array_size = 1001;
  int parallel = 0;
  std::string memory = "1500M";
  std::vector<std::string> options;
};

void AddSlurmOptions(CLI::App& app, SlurmOptions& options);

/// What the script is about, apart from its options.
struct SlurmJob {
  std::string dataset;                 ///< --out
  std::vector<std::string> arguments;  ///< Of this call: "datagen", "open", ...
  int tasks = 0;                       ///< 0: one a shard, at most 1000.
  int threads = 1;                     ///< A task; 0 counts as 1.
  std::size_t shards = 0;              ///< Of the plan.
};

/// Writes the script, says how it is submitted, and does so if asked. Returns the exit code.
/// Throws Error(kInvalidArgument) if another script is there already and `existing` is kRefuse.
int RunSlurm(const SlurmJob& job, const SlurmOptions& options, Existing existing);

}  // namespace doorforge
