// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// An option that a verb does not read itself, but hands on to another program.
struct ForwardedOption {
  const char* name;  ///< "--points"
  const char* about;
  int most_values = 1;  ///< 0: a flag.
};

}  // namespace doorforge
