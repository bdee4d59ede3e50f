// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace doorforge {

/// "1 door", "2 doors".
inline std::string Counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + ' ' + thing + (count == 1 ? "" : "s");
}

/// "1 error, 0 warnings".
inline std::string CountedFindings(int errors, int warnings) {
  return Counted(static_cast<std::size_t>(errors), "error") + ", " +
         Counted(static_cast<std::size_t>(warnings), "warning");
}

}  // namespace doorforge
