// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "doorforge/core/command_line.h"
#include "doorforge/core/error.h"

namespace doorforge {

/// Verbs take this that work on many objects, or on a mesh from elsewhere.
inline void AddMaxSeconds(CLI::App& app, double& max_seconds) {
  app.add_option("--max-seconds", max_seconds,
                 "processor time that one object may take before it is given up (300)")
      ->check(CLI::PositiveNumber);
}

}  // namespace doorforge
