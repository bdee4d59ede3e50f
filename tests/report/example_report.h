// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/report/report.h"

namespace doorforge {

/// A report with every kind of content: two categories, three seeds, all outcomes, a reference,
/// losses, and text that HTML must escape.
EvaluationReport ExampleReport();

}  // namespace doorforge
