// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "doorforge/core/error.h"

namespace doorforge {

/// Walks over the words of one line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  /// The next word; empty at the end of the line.
  std::string_view Next() {
    SkipBlanks();
    std::size_t end = 0;
    while (end < rest_.size() && !IsBlank(rest_[end])) ++end;
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  /// What is left, without blanks around it.
  std::string_view Rest() {
    SkipBlanks();
    std::string_view rest = rest_;
    while (!rest.empty() && IsBlank(rest.back())) rest.remove_suffix(1);
    return rest;
  }

 private:
  static bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  void SkipBlanks() {
    while (!rest_.empty() && IsBlank(rest_.front())) rest_.remove_prefix(1);
  }

  std::string_view rest_;
};

/// Walks over the lines of a text and counts them from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::optional<std::string_view> Next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return line;
  }

  int number() const { return number_; }
  std::string_view rest() const { return rest_; }

  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorCode::kFormat, "line " + std::to_string(number_) + ": " + problem);
  }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// The whole word as a number, or nothing. A leading plus sign is allowed.
template <class Number>
std::optional<Number> NumberOf(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error == std::errc::result_out_of_range && end == word.data() + word.size()) {
    // a denormal or an overflow: zero is as good as the first, and the second is no coordinate
    if constexpr (std::is_floating_point_v<Number>)
      return word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos
                 ? std::optional<Number>(0)
                 : std::nullopt;
  }
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

}  // namespace doorforge
