// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

// Text as HTML, for the pages that programs write. All numbers are written with a decimal point,
// whatever the locale.

namespace doorforge::page {

/// Replaces the characters that mean something in HTML text and attributes, and bytes that are no
/// UTF-8, such as names of files may have, by U+FFFD.
std::string Escape(std::string_view text);

/// `pattern` with each "{name}" replaced by its value as it is. Throws Error(kInvalidArgument) if
/// a lower-case name in braces has no value.
std::string Fill(std::string_view pattern,
                 std::initializer_list<std::pair<std::string_view, std::string>> values);

/// "data:image/png;base64,..." (RFC 2397, RFC 4648).
std::string PngUri(std::string_view png);

/// The address of a file on a page: relative to the page's folder, so that both may be moved
/// together. Empty for an empty `file`.
std::string AddressOn(const std::filesystem::path& page, const std::filesystem::path& file);

std::string Fixed(double value, int digits);
std::string Plural(std::size_t count, const std::string& noun);  ///< "1 door", "3 doors"

}  // namespace doorforge::page
