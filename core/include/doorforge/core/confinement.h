// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// What the kernel offers to a process that gives up its rights.
struct ConfinementSupport {
  /// Version of Landlock's interface (landlock(7)): 1 and higher confine which files are opened, 4
  /// and higher connections as well; 0: there is none.
  int landlock = 0;
  bool seccomp = false;  ///< System calls can be filtered (seccomp(2)).

  bool IsWhole() const { return landlock > 0 && seccomp; }
};

/// Asks the kernel, and changes nothing.
ConfinementSupport ConfinementOfThisKernel();

}  // namespace doorforge
