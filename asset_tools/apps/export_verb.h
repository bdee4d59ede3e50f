// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

int RunExportVerb(int argc, char** argv);

}  // namespace doorforge
