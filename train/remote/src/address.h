// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace doorforge::internal {

struct ServerAddress {
  std::string text;  ///< It is as it was given.
  std::string host;
  std::string port;
  std::string path;
};

/// Throws Error(kInvalidArgument) unless it is ws://HOST:PORT[/PATH].
ServerAddress AddressOf(const std::string& word);

}  // namespace doorforge::internal
