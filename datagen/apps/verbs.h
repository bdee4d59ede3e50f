// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge datagen open ...`; argv[0] is "datagen". Returns the exit code.
int RunDatagenVerb(int argc, char** argv);
/// `doorforge dataset verify ...`; argv[0] is "dataset". Returns the exit code.
int RunDatasetVerb(int argc, char** argv);

}  // namespace doorforge
