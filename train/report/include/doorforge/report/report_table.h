// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/report/report.h"

namespace doorforge {

/// Success with intervals per category and the causes of failure as plain text for a terminal.
std::string ReportTable(const EvaluationReport& report);

}  // namespace doorforge
