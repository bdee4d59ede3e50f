// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// Style sheet and script of a report page. Neither holds the characters that XML would need
// escaped, so that the page is both HTML and well-formed XML.

namespace doorforge::internal {

/// What a report has beside kPageStyle, which comes before it.
extern const std::string_view kReportStyle;

/// Filters the table of episodes; the page reads without it.
extern const std::string_view kReportScript;

}  // namespace doorforge::internal
