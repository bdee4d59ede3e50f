// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/core/html_text.h"
#include "doorforge/report/success_statistics.h"

// A report's numbers as HTML.

namespace doorforge::internal {

using namespace page;  // NOLINT: what all pages share

std::string Degrees(double angle_rad);  ///< "45.0°"
std::string Percent(double share);      ///< "68 %", "99.6 %", with a space that does not break
/// "56–79 %", which does not break
std::string IntervalText(const SuccessRate& rate);

}  // namespace doorforge::internal
