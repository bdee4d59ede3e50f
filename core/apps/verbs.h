// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// The verbs that the front program runs itself. argv[0] is the verb, the result the exit code.
int RunPipelineVerb(int argc, char** argv);    ///< `doorforge pipeline PRESET`
int RunQuickstartVerb(int argc, char** argv);  ///< `doorforge quickstart`
int RunSchemaVerb(int argc, char** argv);      ///< `doorforge schema NAME`

}  // namespace doorforge
