// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace doorforge {

/// "1 door", "2 doors".
std::string Counted(std::size_t count, const std::string& thing);

/// "1 error, 0 warnings".
std::string CountedFindings(int errors, int warnings);

/// Prints one document to standard output, indented by two blanks, with a line end. This is what
/// `--json` asks for.
void PrintJson(const nlohmann::ordered_json& json);

/// Prints text, line ends included, to standard output: what a verb was asked for.
void PrintText(const std::string& text);
/// Prints the one with `as_json`, else the other.
void PrintAnswer(bool as_json, const nlohmann::ordered_json& json, const std::string& text);
/// Prints it to standard error: what people should know meanwhile.
void PrintProgress(const std::string& text);
/// Prints "doorforge: <line>" and a line end to standard error.
void PrintNote(const std::string& line);

/// The exit code of a verb that works on many objects: 128 + the signal that stopped it, else 1 if
/// any object failed, else 0.
int ExitCodeOfBatch(std::size_t failed);

/// Ends such a verb: tells each problem as PrintNote() does, prints the answer as PrintAnswer()
/// does, and returns ExitCodeOfBatch() of their number.
int AnswerOfBatch(const std::vector<std::string>& problems, bool as_json,
                  const nlohmann::ordered_json& json, const std::string& text);

/// The exit code of a verb that a signal stopped, after it said what is kept and how to go on.
int ExitCodeOfStopped(int signal, const std::string& what_is_kept);

}  // namespace doorforge
