// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge catalog list|show|build`. argv[0] is the verb. Returns the exit code.
int RunCatalogVerb(int argc, char** argv);

}  // namespace doorforge
