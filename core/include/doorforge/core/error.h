// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace doorforge {

/// Why an operation could not be carried out at all. The value decides the exit code of a program.
enum class ErrorCode {
  kInvalidArgument,  ///< The caller broke a documented precondition, or a flag is wrong. Exit 2.
  kInvalidConfig,    ///< A config value is out of range, or a config key is unknown. Exit 2.
  kMissing,          ///< An input file or a named part does not exist. Exit 3.
  kFormat,           ///< A file's content does not follow its format. Exit 3.
  kIo,               ///< The operating system refused a read or a write. Exit 3.
  kIncomplete,       ///< Part of the work is done and recorded, the rest is listed. Exit 4.
};

/// The only exception type this library throws.
///
/// It means "this call is wrong; stop". An outcome that a batch of inputs is expected to contain,
/// such as a mesh that cannot be closed, is never an Error: the function returns it as a value.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}

  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// Exit code of a program that ends because of an error with this code (2, 3 or 4).
int ExitCodeOf(ErrorCode code);

/// Throws Error unless `condition` holds. For preconditions, not for input from outside.
void Require(bool condition, ErrorCode code, std::string_view message);

}  // namespace doorforge
