// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace doorforge {

/// Adds `--set KEY=VALUE`, which every verb with settings has. Each takes one setting and leaves
/// what follows it to the others; several are given as several `--set`.
///
/// @param about What it does, for the help: "a.b=c overrides one setting".
/// @param settings Those given, in order; must live until the arguments are parsed.
CLI::Option* AddSettings(CLI::App& app, std::vector<std::string>& settings,
                         const std::string& about);

/// Parses the arguments of a verb (argv[0] is its name). Prints the help and ends the process where
/// it was asked for.
///
/// @throws Error(kInvalidArgument) on wrong use. An option or a subcommand that there is not is
///     told before all else, with the nearest one that there is: what is missing often was
///     misspelled.
void ParseVerb(CLI::App& app, int argc, char** argv);

}  // namespace doorforge
