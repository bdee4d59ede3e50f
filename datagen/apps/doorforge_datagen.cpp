// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that makes and checks datasets.

#include "doorforge/cli/verb_table.h"

#include "verbs.h"

int main(int argc, char** argv) {
  constexpr doorforge::Verb kVerbs[] = {{"datagen", doorforge::RunDatagenVerb},
                                        {"dataset", doorforge::RunDatasetVerb}};
  return doorforge::RunVerbs(kVerbs, argc, argv);
}
