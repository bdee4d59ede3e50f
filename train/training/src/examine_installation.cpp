// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/examine_installation.h"

#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/confinement.h"
#include "doorforge/core/program.h"
#include "doorforge/networks/instruction_set.h"
#include "doorforge/training/linear_algebra.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> SupportedSets() {
  std::vector<std::string> names;
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (IsSupported(set)) names.emplace_back(NameOf(set));
  }
  return names;
}

}  // namespace

Json ExamineInstallation() {
  const LinearAlgebra algebra = MeasureLinearAlgebra();
  const ConfinementSupport confinement = ConfinementOfThisKernel();
  const bool fast = algebra.gflops >= kLeastGflops;
  Json json = {{"schema", "doorforge.doctor"},
               {"schema_version", 1},
               {"code_version", CodeVersion()},
               {"processors", std::thread::hardware_concurrency()},
               {"instruction_sets", SupportedSets()},
               {"instruction_set", NameOf(BestInstructionSet())},
               {"torch_version", algebra.torch_version},
               {"blas_library", algebra.blas_library},
               {"gflops", algebra.gflops},
               {"least_gflops", kLeastGflops},
               {"landlock", confinement.landlock},
               {"seccomp", confinement.seccomp},
               {"healthy", fast},
               {"remedy", fast ? "" : LinearAlgebraRemedy()}};
  return json;
}

}  // namespace doorforge
