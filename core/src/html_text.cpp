// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/html_text.h"

#include <algorithm>
#include <charconv>

#include "doorforge/core/error.h"

namespace doorforge::page {
namespace {

constexpr std::string_view kBase64Digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

bool IsName(std::string_view text) {
  return !text.empty() &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string_view::npos;
}

// Bytes of the character that the text begins with; 0: it begins with none (RFC 3629).
std::size_t CharacterSize(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const unsigned char second = byte(1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool surrogate = first == 0xED && second >= 0xA0;
  const bool beyond = first == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : size;
}

}  // namespace

std::string Escape(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const std::size_t size = CharacterSize(text.substr(i));
    if (size != 1) {
      escaped += size == 0 ? std::string_view("\xEF\xBF\xBD") : text.substr(i, size);
      i += std::max<std::size_t>(size, 1);
      continue;
    }
    ++i;
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        // control characters may stand neither in HTML nor in XML
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') escaped += c;
    }
  }
  return escaped;
}

std::string Fill(std::string_view pattern,
                 std::initializer_list<std::pair<std::string_view, std::string>> values) {
  std::string filled;
  while (!pattern.empty()) {
    const std::size_t open = std::min(pattern.find('{'), pattern.size());
    filled += pattern.substr(0, open);
    pattern.remove_prefix(open);
    if (pattern.empty()) break;
    const std::size_t close = std::min(pattern.find('}'), pattern.size());
    const std::string_view name = pattern.substr(1, close - 1);
    if (close == pattern.size() || !IsName(name)) {  // a brace of its own
      filled += pattern.front();
      pattern.remove_prefix(1);
      continue;
    }
    const std::string* value = nullptr;
    for (const auto& [known, text] : values) value = known == name ? &text : value;
    Require(value != nullptr, ErrorCode::kInvalidArgument,
            "no value for {" + std::string(name) + "}");
    filled += *value;
    pattern.remove_prefix(close + 1);
  }
  return filled;
}

std::string PngUri(std::string_view png) {
  std::string uri = "data:image/png;base64,";
  uri.reserve(uri.size() + png.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < png.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < png.size() ? static_cast<unsigned char>(png[i + k]) : 0U;
    };
    const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
    uri += kBase64Digits[three >> 18 & 63];
    uri += kBase64Digits[three >> 12 & 63];
    uri += i + 1 < png.size() ? kBase64Digits[three >> 6 & 63] : '=';
    uri += i + 2 < png.size() ? kBase64Digits[three & 63] : '=';
  }
  return uri;
}

std::string AddressOn(const std::filesystem::path& page, const std::filesystem::path& file) {
  if (file.empty()) return {};
  const std::filesystem::path folder = std::filesystem::absolute(page).parent_path();
  return std::filesystem::absolute(file).lexically_relative(folder).generic_string();
}

std::string Fixed(double value, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  return end.ec == std::errc() ? std::string(text, end.ptr) : "?";
}

std::string Plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace doorforge::page
