// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge validate PATH...`. argv[0] is the verb. Returns 0 without errors, 1 with errors, 3 if
/// a path could not be read (the others are validated all the same).
int RunValidateVerb(int argc, char** argv);

}  // namespace doorforge
