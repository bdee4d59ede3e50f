// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that trains policies, and the doctor, which asks the training libraries themselves.

#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

#include "doctor_verb.h"
#include "train_verb.h"

namespace doorforge {
namespace {

int Run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  if (name == "train") return RunTrainVerb(argc - 1, argv + 1);
  if (name == "doctor") return RunDoctorVerb(argc - 1, argv + 1);
  throw Error(ErrorCode::kInvalidArgument, "unknown verb \"" + name + "\"; did you mean \"" +
                                               NearestName(name, {"train", "doctor"}) +
                                               "\"? `doorforge --help` lists all");
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
