// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/core/error.h"

namespace doorforge {

/// Refuses options that were given an empty text: `--task "$UNSET"` must not pass for none.
inline void RefuseEmptyValues(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results())
      if (value.empty())
        throw Error(ErrorCode::kInvalidArgument,
                    option->get_name() +
                        ": its value is empty; is a variable unset? Leave the option out to do "
                        "without it");
  }
  for (const CLI::App* verb : app.get_subcommands()) RefuseEmptyValues(*verb);
}

/// Parses the arguments of a verb (argv[0] is its name). Prints the help and ends the process where
/// it was asked for; throws Error(kInvalidArgument) on wrong use.
inline void ParseVerb(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    RefuseEmptyValues(app);
  } catch (const CLI::CallForHelp& help) {
    std::exit(app.exit(help));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::kInvalidArgument,
                std::string(error.what()) + "; see `" + app.get_name() + " --help`");
  }
}

}  // namespace doorforge
