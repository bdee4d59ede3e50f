// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge repair IN OUT`. argv[0] is the verb. Returns 0, or 1 where the mesh cannot be closed;
/// throws Error for what cannot be read (exit 3) and for wrong use (exit 2).
int RunRepairVerb(int argc, char** argv);

}  // namespace doorforge
