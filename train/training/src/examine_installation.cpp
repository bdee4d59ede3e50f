// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/examine_installation.h"

#include <cstdio>
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

std::string InstallationText(const Json& found) {
  const auto word = [&](const char* key) { return found[key].get<std::string>(); };
  std::string sets;
  for (const Json& set : found["instruction_sets"]) sets += " " + set.get<std::string>();
  char product[96];
  std::snprintf(product, sizeof product, "%.1f GFLOP/s on one thread (at least %.0f wanted)",
                found["gflops"].get<double>(), kLeastGflops);
  const int landlock = found["landlock"].get<int>();
  std::string text = "doorforge           " + word("code_version") + "\nprocessors          " +
                     std::to_string(found["processors"].get<int>()) + "\ninstruction sets   " +
                     sets + " (the encoder uses " + word("instruction_set") +
                     ")\nlibtorch            " + word("torch_version") + "\nBLAS                " +
                     word("blas_library") + "\nmatrix product      " + product +
                     "\nconfinement         " +
                     (landlock > 0 ? "Landlock " + std::to_string(landlock) : "no Landlock") +
                     (found["seccomp"].get<bool>() ? ", seccomp" : ", no seccomp") +
                     ": how far foreign files are kept from the rest\n";
  if (found["healthy"].get<bool>()) return text + "all well\n";
  return text + "\nlibtorch runs on a slow BLAS. As root:\n" + word("remedy") + "\n";
}

}  // namespace doorforge
