// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <CLI/CLI.hpp>

namespace doorforge {

/// `doorforge datagen open ...`; argv[0] is "datagen". Returns the exit code.
int RunDatagenVerb(int argc, char** argv);

/// A subcommand of `doorforge dataset`.
struct Subcommand {
  CLI::App* app = nullptr;
  std::function<int()> run;  ///< After it was parsed; returns the exit code.
};

// Each adds its subcommand to `doorforge dataset`.
Subcommand AddVerify(CLI::App& dataset);
Subcommand AddMerge(CLI::App& dataset);
Subcommand AddReobserve(CLI::App& dataset);
Subcommand AddStatus(CLI::App& dataset);
Subcommand AddInfo(CLI::App& dataset);
Subcommand AddExport(CLI::App& dataset);
Subcommand AddCard(CLI::App& dataset);
Subcommand AddFilms(CLI::App& dataset);

struct RegenerateDatasetRequest;
/// What a dataset was made with, for who makes episodes again: doors, robot, policies.
std::vector<CLI::Option*> AddMadeWithOptions(CLI::App& app, RegenerateDatasetRequest& given);

}  // namespace doorforge
