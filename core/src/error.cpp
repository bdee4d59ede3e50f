// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/error.h"

namespace doorforge {

int ExitCodeOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
    case ErrorCode::kInvalidConfig:
      return 2;
    case ErrorCode::kMissing:
    case ErrorCode::kFormat:
    case ErrorCode::kIo:
      return 3;
    case ErrorCode::kIncomplete:
      return 4;
  }
  return 2;
}

void Require(bool condition, ErrorCode code, std::string_view message) {
  if (!condition) throw Error(code, std::string(message));
}

}  // namespace doorforge
