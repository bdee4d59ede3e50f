// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "run/second_opinion.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/confined_child.h"
#include "doorforge/core/error.h"

namespace doorforge::foreign {
namespace {

// Its own words on one line, since a report has a line for them.
std::string OneLine(std::string text) {
  while (!text.empty() && std::strchr(" \n\r\t", text.back()) != nullptr) text.pop_back();
  std::string line;
  for (const char c : text) {
    if (c == '\n')
      line += "; ";
    else
      line += c;
  }
  constexpr std::size_t kLongest = 240;
  return line.size() > kLongest ? line.substr(0, kLongest) + "..." : line;
}

}  // namespace

SecondOpinion AskProgram(const std::string& program, const std::filesystem::path& file) {
  SecondOpinion opinion{Opinion::kNotAsked, program, {}};
  try {
    std::vector<std::string> arguments = {
        SiblingProgram("doorforge-second-opinion", "DOORFORGE_SECOND_OPINION"), program,
        file.string(), std::to_string(::getpid())};
    if (const char* library = std::getenv("DOORFORGE_MUJOCO")) arguments.emplace_back(library);
    const ChildAnswer answer = AskChild(std::move(arguments), {60, 1ULL << 20U});
    return OpinionIn(program, answer.message, answer.status);
  } catch (const Error& error) {
    opinion.words = error.what();
  }
  return opinion;
}

SecondOpinion OpinionIn(const std::string& program, const std::string& answer, int status) {
  SecondOpinion opinion{Opinion::kNotAsked, program, {}};
  const std::size_t first = answer.find('\n');
  const std::size_t second = answer.find('\n', first + 1);
  if (first == std::string::npos || second == std::string::npos) {
    opinion.opinion = Opinion::kRefuses;
    opinion.words = WIFSIGNALED(status) ? std::string("it crashed on the file (") +
                                              ::strsignal(WTERMSIG(status)) + ")"
                                        : "it ended without an answer";
    return opinion;
  }
  const std::string verdict = answer.substr(0, first);
  opinion.program = answer.substr(first + 1, second - first - 1);
  opinion.words = OneLine(answer.substr(second + 1));
  if (verdict == "ok") opinion.opinion = Opinion::kTakes;
  if (verdict == "no") opinion.opinion = Opinion::kRefuses;
  return opinion;
}

}  // namespace doorforge::foreign
