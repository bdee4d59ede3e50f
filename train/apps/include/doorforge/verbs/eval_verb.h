// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/registry/policy_registry.h"

namespace doorforge {

/// The verb `doorforge eval` of a program, which may know policies of its own.
struct EvalVerbSetup {
  std::string program = "doorforge eval";       ///< What its help and its report call it.
  PolicyRegistry registry = BuiltInPolicies();  ///< With a row for each policy of its own.
  std::string opener = {};  ///< --opener where it is left out; empty: it must be given.
};

/// For the main function of a program: reads the command line (docs/evaluate.md), evaluates, prints
/// the table and writes the report.
///
/// @param argv argv[0] is not read.
/// @returns The exit code; what goes wrong is told on standard error.
int RunEvalVerb(int argc, char** argv, const EvalVerbSetup& setup = {});

}  // namespace doorforge
