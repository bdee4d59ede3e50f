// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace doorforge::internal {

/// A printable ASCII letter as strokes: pairs of digits, column and row of a grid, a line from each
/// to the next; a blank ends a stroke. Row 2 is the baseline, 6 the height of "x", 8 that of "A".
/// Empty for a blank and for every other byte.
std::string_view StrokesOf(char letter);

}  // namespace doorforge::internal
