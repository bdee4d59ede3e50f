// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge pipeline`: the conditioned chain of a preset, step by step. argv[0] is the verb.
int RunPipelineVerb(int argc, char** argv);

}  // namespace doorforge
