// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/core/error.h"

namespace doorforge {

/// Parses the arguments of a verb (argv[0] is its name). Prints the help and ends the process where
/// it was asked for; throws Error(kInvalidArgument) on wrong use.
inline void ParseVerb(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    std::exit(app.exit(help));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::kInvalidArgument,
                std::string(error.what()) + "; see `" + app.get_name() + " --help`");
  }
}

/// Verbs take this that work on many objects, or on a mesh from elsewhere.
inline void AddMaxSeconds(CLI::App& app, double& max_seconds) {
  app.add_option("--max-seconds", max_seconds,
                 "processor time that one object may take before it is given up (300)")
      ->check(CLI::PositiveNumber);
}

}  // namespace doorforge
