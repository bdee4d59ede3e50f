// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "doorforge/collect/reobserve.h"

namespace doorforge {

/// `dataset re-observe`.
CLI::App* AddReobserve(CLI::App& app, ReobserveRequest& request);
/// Returns the exit code.
int RunReobserve(ReobserveRequest request);

}  // namespace doorforge
