// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge compose --body A --handle B --out DIR`. argv[0] is the verb. Returns the exit code.
int RunComposeVerb(int argc, char** argv);

}  // namespace doorforge
