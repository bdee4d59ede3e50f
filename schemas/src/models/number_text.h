// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <string>
#include <string_view>

// Numbers in the text of mesh files.

namespace doorforge::internal {

/// Appends the shortest decimal that reads back to the same float.
inline void AppendNumber(std::string& text, float number) {
  char digits[32];
  // + 0.0F turns -0 into 0
  const auto end = std::to_chars(digits, digits + sizeof digits, number + 0.0F).ptr;
  text.append(digits, end);
}

/// Walks over one line; every Next... returns false on a mismatch.
class LineCursor {
 public:
  explicit LineCursor(std::string_view line) : rest_(line) {}

  template <class Number>
  bool NextNumber(Number& number) {
    while (rest_.starts_with(' ')) rest_.remove_prefix(1);
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    if (error != std::errc{}) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }

  bool Skip(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool AtEnd() const { return rest_.find_first_not_of(" \r") == std::string_view::npos; }

 private:
  std::string_view rest_;
};

}  // namespace doorforge::internal
