// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge dataset verify|info|merge|export|card DIR`; argv[0] is "dataset". Returns the exit
/// code.
int RunDatasetVerb(int argc, char** argv);

}  // namespace doorforge
