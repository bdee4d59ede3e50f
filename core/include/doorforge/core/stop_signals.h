// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace doorforge {

/// While it lives, SIGINT and SIGTERM ask long calls to stop, see StopRequested(), as they do in a
/// program of RunProgram(). For hosts with handlers of their own, such as Python, which have them
/// back afterwards. One at a time, on the thread that the host's signals belong to.
class StopSignals {
 public:
  /// Also forgets an earlier request.
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
};

}  // namespace doorforge
