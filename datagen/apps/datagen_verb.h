// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge datagen open ...`; argv[0] is "datagen". Returns the exit code.
int RunDatagenVerb(int argc, char** argv);

/// Goes on as the program that can run trained policies, with the same arguments: they need the
/// networks' library, which only the other program of the same sources has. Throws Error(kMissing)
/// if there is none.
void BecomeTrainedProgram(int argc, char** argv);

}  // namespace doorforge
