// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "doorforge/registry/lone_policy.h"

namespace doorforge {

/// Where a policy is served, and what is said of it.
struct PolicyServerConfig {
  std::string host = "127.0.0.1";  ///< An address of this machine; "0.0.0.0": all of them.
  std::uint16_t port = 8000;       ///< 0: one that is free.
  std::string policy;              ///< Its name, for those who connect.
  std::string stage = "open";
};

/// Answers whoever connects, in the protocol of MakeServedPolicy(), until the program is asked to
/// stop (StopRequested()). Each connection has a policy of its own. What is wrong with a request is
/// said in an answer of text; the connection goes on. Where the policy says so, each answer has
/// whether the handle is turned.
///
/// @param make A new policy; called from one thread at a time.
/// @param ready Called with the port once connections are taken.
/// @throws Error(kIo) if the port cannot be had.
void ServePolicy(const PolicyServerConfig& config,
                 const std::function<std::unique_ptr<LonePolicy>()>& make,
                 const std::function<void(int)>& ready);

}  // namespace doorforge
