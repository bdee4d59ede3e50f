// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/evaluate/evaluate_opener.h"

namespace doorforge {

/// The verb `doorforge eval`, for the main function of a program: reads the command line
/// (docs/evaluate.md), evaluates, prints the table and writes the report. With policies of one's
/// own the options --policy (or --handler) in their place are gone, and all others are the same.
///
/// @param argv argv[0] is not read.
/// @returns The exit code; what goes wrong is told on standard error.
int RunEvalVerb(int argc, char** argv, const OwnPolicies& own = {});

}  // namespace doorforge
