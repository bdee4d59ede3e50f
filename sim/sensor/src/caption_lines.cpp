// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "caption_lines.h"

#include <algorithm>

namespace doorforge::internal {
namespace {

std::string Trimmed(std::string text) {
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

// How many letters go onto the first line.
std::size_t LengthOfLine(const std::string& text,
                         const std::function<bool(const std::string&)>& fits) {
  std::size_t longest = text.size();
  while (longest > 1 && !fits(Trimmed(text.substr(0, longest)))) --longest;
  if (longest == text.size()) return longest;
  std::size_t mark = text.find_last_of(" _-", longest - 1);
  // two of them, as between the ids of a body and a handle, stay together
  while (mark != std::string::npos && mark > 0 && text[mark] == text[mark + 1])
    mark = text.find_last_of(" _-", mark - 1);
  return mark == std::string::npos || mark == 0 ? longest : mark + 1;
}

}  // namespace

std::vector<std::string> CaptionLines(const std::string& caption,
                                      const std::function<bool(const std::string&)>& fits) {
  std::vector<std::string> lines;
  for (std::string rest = Trimmed(caption); !rest.empty();) {
    const std::size_t length = LengthOfLine(rest, fits);
    lines.push_back(Trimmed(rest.substr(0, length)));
    rest = Trimmed(rest.substr(length));
  }
  return lines;
}

}  // namespace doorforge::internal
