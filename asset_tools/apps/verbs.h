// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// The verbs that author assets. argv[0] is the verb, the result the exit code.
int RunCatalogVerb(int argc, char** argv);      ///< `doorforge catalog list|show|build`
int RunComposeVerb(int argc, char** argv);      ///< `doorforge compose`
int RunConformanceVerb(int argc, char** argv);  ///< `doorforge conformance DOOR...`
int RunExportVerb(int argc, char** argv);       ///< `doorforge export DOOR...`
int RunImportVerb(int argc, char** argv);       ///< `doorforge import SRC...`
int RunPreviewVerb(int argc, char** argv);      ///< `doorforge preview PATH...`
int RunRepairVerb(int argc, char** argv);       ///< `doorforge repair IN OUT`
int RunServeVerb(int argc, char** argv);        ///< `doorforge serve`
int RunValidateVerb(int argc, char** argv);     ///< `doorforge validate PATH...`
int RunViewVerb(int argc, char** argv);         ///< `doorforge view PATH...`

}  // namespace doorforge
