// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace doorforge {

/// What a collection's Slurm script is made of. Everything is written into the script as it is
/// here, quoted for bash.
struct SlurmScript {
  std::string program;      ///< doorforge, absolute.
  std::string work_folder;  ///< Absolute; relative paths in the arguments hold from here.
  std::string dataset;      ///< The --out folder.
  std::vector<std::string> arguments;  ///< "datagen", "open", "--doors", ...; no task.
  int tasks = 1;                       ///< 1..1000000
  int array_size = 1001;               ///< Slurm's MaxArraySize: indices stay below it.
  int parallel = 0;                    ///< Most tasks of an array at once; 0: no limit.
  int threads = 1;                     ///< Processors a task.
  std::string memory = "1500M";        ///< A task, as sbatch --mem takes it.
  std::vector<std::string> options;    ///< More for sbatch, such as "--partition=long".
};

/// Tasks [first, first + count) as one job array with indices 0..count - 1.
struct SlurmArray {
  int first = 0;
  int count = 0;
};

/// Arrays of at most `array_size` tasks that hold [0, tasks) once each, in order.
std::vector<SlurmArray> CutIntoArrays(int tasks, int array_size);

/// A bash script that is both what sbatch runs and what submits it: `bash FILE` submits the arrays,
/// then the merge after all of them, then the verification after the merge, and prints their job
/// numbers. A task that is requeued goes on where it was. Given again, all that is done ends at
/// once. Where Slurm refuses one of the jobs, those before it are cancelled and the script ends
/// with sbatch's code.
///
/// @throws Error(kInvalidArgument) on numbers out of range or a text with a line break.
std::string SlurmScriptText(const SlurmScript& script);

}  // namespace doorforge
