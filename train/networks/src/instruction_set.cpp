// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/instruction_set.h"

#include <array>
#include <cstdlib>

#include "doorforge/core/error.h"

#include "kernel_choice.h"

namespace doorforge {
namespace {

constexpr std::array kWidestFirst = {InstructionSet::kAvx512, InstructionSet::kAvx2,
                                     InstructionSet::kBaseline};

InstructionSet Named(const std::string& name) {
  for (const InstructionSet set : kWidestFirst) {
    if (NameOf(set) != name) continue;
    Require(IsSupported(set), ErrorCode::kInvalidArgument,
            "DOORFORGE_INSTRUCTION_SET=" + name + ": this processor cannot run it");
    return set;
  }
  throw Error(ErrorCode::kInvalidArgument,
              "DOORFORGE_INSTRUCTION_SET=" + name + ": unknown; use baseline, avx2 or avx512");
}

}  // namespace

std::string_view NameOf(InstructionSet set) {
  constexpr std::array<std::string_view, 3> kNames = {"baseline", "avx2", "avx512"};
  return kNames.at(static_cast<std::size_t>(set));
}

bool IsSupported(InstructionSet set) {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (set == InstructionSet::kAvx2) return avx2;
  if (set == InstructionSet::kAvx512) return avx2 && __builtin_cpu_supports("avx512f") != 0;
#endif
  return set == InstructionSet::kBaseline;
}

InstructionSet BestInstructionSet() {
  if (const char* name = std::getenv("DOORFORGE_INSTRUCTION_SET")) return Named(name);
  for (const InstructionSet set : kWidestFirst) {
    if (IsSupported(set)) return set;
  }
  return InstructionSet::kBaseline;
}

namespace internal {

const Kernels& KernelsFor(InstructionSet set) {
  Require(IsSupported(set), ErrorCode::kInvalidArgument,
          std::string(NameOf(set)) + ": this processor cannot run it");
#if defined(__x86_64__)
  if (set == InstructionSet::kAvx512) return kAvx512Kernels;
  if (set == InstructionSet::kAvx2) return kAvx2Kernels;
#endif
  return kBaselineKernels;
}

}  // namespace internal
}  // namespace doorforge
