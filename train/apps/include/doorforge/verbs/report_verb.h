// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge report REPORT...`: one table of the reports of several trainings. Returns the exit
/// code of the process.
int RunReportVerb(int argc, char** argv);

}  // namespace doorforge
