// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "doorforge/registry/policy_registry.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// How somebody else's policy is asked.
struct RemotePolicySettings {
  double timeout_s = 10;       ///< For connecting, and for each answer; greater than 0.
  int chunk = 1;               ///< So many actions of an answer are carried out; at least 1.
  std::string stage = "open";  ///< Told to the policy.
  bool remembers = false;      ///< Its clouds are joined with what was seen before; it is told so.
};

/// Whether a word is the address of a server: "ws://HOST:PORT", with a path behind it or without.
bool IsServerAddress(const std::string& word);

/// A policy behind a WebSocket, in the protocol of openpi and others (docs/serve-policy.md):
/// MessagePack with numpy's arrays. It is Fallible: a server that is gone, hangs or answers
/// nonsense ends the episode, and the next one connects anew. Connects when it is first asked. It
/// is a StageSwitch, which says what the answers do.
///
/// @throws Error(kInvalidArgument) on an address or settings that are none.
std::unique_ptr<Policy> MakeServedPolicy(const std::string& address,
                                         const RemotePolicySettings& settings = {});

/// Asks a program instead: a shell runs `command`, and messages go over its standard input and
/// output, each behind its length (4 bytes, big-endian). It starts when first asked, once more
/// in the episode after one in which it failed, and ends with the policy.
std::unique_ptr<Policy> MakeCommandPolicy(const std::string& command,
                                          const RemotePolicySettings& settings = {});

/// What a server says of itself that an evaluation goes by.
struct ServerGreeting {
  RememberedViewConfig remembered{.resolution_scale = 0};  ///< Of the clouds that it is given.
};

/// Connects to a server and lets go again.
///
/// @throws Error(kMissing) if none answers there within the time.
ServerGreeting GreetingOf(const std::string& address, const RemotePolicySettings& settings = {});

}  // namespace doorforge
