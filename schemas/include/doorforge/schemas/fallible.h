// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace doorforge {

/// How the detail of an episode begins that ended because a policy had no action to give.
inline constexpr const char* kPolicyFailed = "the policy failed: ";

/// A policy that may have no action to give: another process, a server, a function of somebody
/// else's. It gives one that is not finite then, with which the episode ends, and says here why.
class Fallible {
 public:
  virtual ~Fallible() = default;
  /// Forgets why there was no action. RunPolicySet() calls it before each episode, also before one
  /// that ends before it is this policy's turn.
  virtual void ForgetFailure() = 0;
  /// Why there was no action since ForgetFailure(); empty: there was one each time.
  virtual std::string Failure() const = 0;
};

}  // namespace doorforge
