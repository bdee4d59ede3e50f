// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that trains policies, and the doctor, which asks the training libraries themselves.

#include "doorforge/cli/verb_table.h"

#include "verbs.h"

int main(int argc, char** argv) {
  constexpr doorforge::Verb kVerbs[] = {{"train", doorforge::RunTrainVerb},
                                        {"doctor", doorforge::RunDoctorVerb}};
  return doorforge::RunVerbs(kVerbs, argc, argv);
}
