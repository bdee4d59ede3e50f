// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge benchmark`: trains what is missing, evaluates all rows, writes benchmark.html and
/// benchmark.json and prints the table. argv[0] is the verb. Returns the exit code.
int RunBenchmarkVerb(int argc, char** argv);

}  // namespace doorforge
