// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

#include <string_view>

#include "doorforge/evaluate/eval_verb.h"

// `doorforge eval ...` starts this program with the verb as first argument
int main(int argc, char** argv) {
  const bool has_verb = argc > 1 && std::string_view(argv[1]) == "eval";
  return doorforge::RunEvalVerb(has_verb ? argc - 1 : argc, has_verb ? argv + 1 : argv);
}
