// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace doorforge::internal {

/// A way to somebody who answers messages. Every call throws Error(kMissing) if the other side is
/// not there or has gone, and Error(kIo) on all else that goes wrong; the next call begins anew.
class Link {
 public:
  virtual ~Link() = default;
  /// Connects or starts unless that is done, and gives what the other side says of itself: a
  /// message, or nothing.
  virtual std::string Open() = 0;
  /// Sends a message and gives the answer.
  virtual std::string Exchange(const std::string& message) = 0;
  /// Lets go: nothing that still comes belongs to later messages.
  virtual void Close() = 0;
};

std::unique_ptr<Link> MakeWebSocketLink(const std::string& address, double timeout_s);
std::unique_ptr<Link> MakeCommandLink(const std::string& command, double timeout_s);

}  // namespace doorforge::internal
