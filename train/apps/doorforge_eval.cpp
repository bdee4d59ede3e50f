// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

#include <string_view>

#include "doorforge/verbs/benchmark_verb.h"
#include "doorforge/verbs/eval_verb.h"
#include "doorforge/verbs/report_verb.h"

// `doorforge eval ...`, `doorforge report ...` and `doorforge benchmark ...` start this program
// with the verb as first argument
int main(int argc, char** argv) {
  const std::string_view verb = argc > 1 ? argv[1] : "";
  if (verb == "benchmark") return doorforge::RunBenchmarkVerb(argc - 1, argv + 1);
  if (verb == "report") return doorforge::RunReportVerb(argc - 1, argv + 1);
  const bool has_verb = verb == "eval";
  return doorforge::RunEvalVerb(has_verb ? argc - 1 : argc, has_verb ? argv + 1 : argv);
}
