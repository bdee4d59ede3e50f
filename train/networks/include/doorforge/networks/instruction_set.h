// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace doorforge {

/// Which compiled copy of the encoder's loops runs. kAvx2 and kAvx512 round alike (same order of
/// sums, fused multiply-add) and so give the same bits; kBaseline does not fuse.
enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// "baseline", "avx2", "avx512".
std::string_view NameOf(InstructionSet set);

/// True if this processor can run it.
bool IsSupported(InstructionSet set);

/// The widest supported one; $DOORFORGE_INSTRUCTION_SET (one of the names above) caps it. Throws
/// Error(kInvalidArgument) if that names an unknown or unsupported set.
InstructionSet BestInstructionSet();

}  // namespace doorforge
