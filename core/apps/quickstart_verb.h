// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge quickstart`: parts -> doors -> validation -> shards -> policy -> report, each step
/// run as the command a user would type. argv[0] is the verb.
int RunQuickstartVerb(int argc, char** argv);

}  // namespace doorforge
