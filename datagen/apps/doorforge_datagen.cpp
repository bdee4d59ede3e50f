// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that makes and checks datasets.

#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

#include "datagen_verb.h"
#include "dataset_verb.h"

namespace doorforge {
namespace {

int Run(int argc, char** argv) {
  const std::string verb = argc > 1 ? argv[1] : "";
  if (verb == "datagen") return RunDatagenVerb(argc - 1, argv + 1);
  if (verb == "dataset") return RunDatasetVerb(argc - 1, argv + 1);
  throw Error(ErrorCode::kInvalidArgument, "unknown verb \"" + verb + "\"; did you mean \"" +
                                               NearestName(verb, {"datagen", "dataset"}) +
                                               "\"? `doorforge --help` lists all");
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
