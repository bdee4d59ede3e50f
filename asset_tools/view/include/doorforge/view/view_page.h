// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace doorforge {

/// A page in HTML, and what it could not show.
struct ViewPage {
  std::string html;                 ///< It needs no other file and makes no request.
  std::size_t shown = 0;            ///< Doors, parts or episodes that it has.
  std::vector<std::string> faults;  ///< Messages of what is damaged or missing, in their order.
};

}  // namespace doorforge
