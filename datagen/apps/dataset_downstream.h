// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace doorforge {

// The subcommands of `doorforge dataset` for those who use a finished dataset. Each function adds
// its subcommand to the verb and returns what runs it if it was parsed: its exit code, else -1.

/// `dataset status DIR [--tasks N] [--json] [--watch]`
std::function<int()> AddStatus(CLI::App& verb);

/// `dataset info DIR [--json] [--png FILE] [--html FILE]`
std::function<int()> AddInfo(CLI::App& verb);

/// `dataset export DIR --to robomimic --out FILE`
std::function<int()> AddExport(CLI::App& verb);

/// `dataset card DIR`
std::function<int()> AddCard(CLI::App& verb);

}  // namespace doorforge
