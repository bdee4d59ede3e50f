// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace doorforge::internal {

/// A caption cut into lines that fit, without losing a letter: behind a blank, '_' or '-' where
/// that is in reach, otherwise within a word. Blanks at a break are left out.
///
/// @param fits Whether a line is narrow enough; every single letter must be.
std::vector<std::string> CaptionLines(const std::string& caption,
                                      const std::function<bool(const std::string&)>& fits);

}  // namespace doorforge::internal
