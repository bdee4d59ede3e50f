// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge train STAGE`; argv[0] is "train". Returns the exit code.
int RunTrainVerb(int argc, char** argv);

}  // namespace doorforge
