// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/core/command_line.h"
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

/// As ParseVerb(), and refuses empty values.
inline void ParseDataVerb(CLI::App& app, int argc, char** argv) {
  ParseVerb(app, argc, argv);
  RefuseEmptyValues(app);
}

}  // namespace doorforge
