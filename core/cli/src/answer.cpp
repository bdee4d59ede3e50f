// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/answer.h"

#include <iostream>

#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"

namespace doorforge {

std::string Counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + ' ' + thing + (count == 1 ? "" : "s");
}

std::string CountedFindings(int errors, int warnings) {
  return Counted(static_cast<std::size_t>(errors), "error") + ", " +
         Counted(static_cast<std::size_t>(warnings), "warning");
}

void PrintText(const std::string& text) { std::cout << text << std::flush; }

void PrintProgress(const std::string& text) { std::cerr << text << std::flush; }

void PrintJson(const nlohmann::ordered_json& json) { std::cout << JsonText(json, 2) << '\n'; }

void PrintAnswer(bool as_json, const nlohmann::ordered_json& json, const std::string& text) {
  as_json ? PrintJson(json) : PrintText(text);
}

void PrintNote(const std::string& line) { PrintProgress("doorforge: " + line + "\n"); }

int ExitCodeOfBatch(std::size_t failed) {
  if (const int signal = StopRequested()) return 128 + signal;
  return failed == 0 ? 0 : 1;
}

int AnswerOfBatch(const std::vector<std::string>& problems, bool as_json,
                  const nlohmann::ordered_json& json, const std::string& text) {
  for (const std::string& problem : problems) PrintNote(problem);
  PrintAnswer(as_json, json, text);
  return ExitCodeOfBatch(problems.size());
}

int ExitCodeOfStopped(int signal, const std::string& what_is_kept) {
  PrintNote("stopped; " + what_is_kept);
  return 128 + signal;
}

}  // namespace doorforge
