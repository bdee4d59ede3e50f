// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "doorforge/evaluate/success_statistics.h"

// Text as HTML. All numbers are written with a decimal point, whatever the locale.

namespace doorforge::internal {

/// Replaces the characters that mean something in HTML text and attributes.
std::string Escape(std::string_view text);

/// `pattern` with each "{name}" replaced by its value as it is. Throws Error(kInvalidArgument) if
/// a lower-case name in braces has no value.
std::string Fill(std::string_view pattern,
                 std::initializer_list<std::pair<std::string_view, std::string>> values);

/// "data:image/png;base64,..." (RFC 2397, RFC 4648).
std::string PngUri(std::string_view png);

std::string Fixed(double value, int digits);
std::string Degrees(double angle_rad);  ///< "45.0°"
std::string Percent(double share);      ///< "68 %", "99.6 %", with a space that does not break
/// "56–79 %", which does not break
std::string IntervalText(const SuccessRate& rate);
std::string Plural(std::size_t count, const std::string& noun);  ///< "1 door", "3 doors"

}  // namespace doorforge::internal
