// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge preview PATH... --out FILE.png`. argv[0] is the verb. Returns the exit code.
int RunPreviewVerb(int argc, char** argv);

}  // namespace doorforge
