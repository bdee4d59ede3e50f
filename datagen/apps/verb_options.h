// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"

namespace doorforge {

/// As ParseVerb(), and refuses empty values.
inline void ParseDataVerb(CLI::App& app, int argc, char** argv) {
  ParseVerb(app, argc, argv, EmptyValues::kRefuse);
}

}  // namespace doorforge
