// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/confinement.h"

#include <algorithm>
#include <cstdint>

#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace doorforge {

ConfinementSupport ConfinementOfThisKernel() {
  const long version =
      ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  const std::uint32_t action = SECCOMP_RET_ERRNO;
  const bool filters = ::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
  return {static_cast<int>(std::max(version, 0L)), filters};
}

}  // namespace doorforge
