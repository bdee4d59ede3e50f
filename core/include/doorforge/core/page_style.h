// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace doorforge::page {

/// Style sheet that the pages of programs begin with: colours for light and dark, text, tables,
/// figures, the charts of svg_plot.h and epoch_chart.h. Holds no character that XML would need
/// escaped, so that a page is both HTML and well-formed XML.
extern const std::string_view kPageStyle;

}  // namespace doorforge::page
