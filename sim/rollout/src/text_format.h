// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string>

namespace doorforge::internal {

inline constexpr double kDegree = std::numbers::pi / 180;

/// Formats as printf does, at most 399 characters.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
Format(const char* format, ...);

}  // namespace doorforge::internal
