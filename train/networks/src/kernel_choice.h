// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/networks/instruction_set.h"

#include "kernels.h"

namespace doorforge::internal {

/// Throws Error(kInvalidArgument) if this processor cannot run them.
const Kernels& KernelsFor(InstructionSet set);

}  // namespace doorforge::internal
