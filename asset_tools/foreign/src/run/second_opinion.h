// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace doorforge::foreign {

enum class Opinion { kTakes, kRefuses, kNotAsked };

/// What another program says of a file.
struct SecondOpinion {
  Opinion opinion = Opinion::kNotAsked;
  std::string program;  ///< With its version where it is known.
  std::string words;    ///< Why it refuses, or why it was not asked.
};

/// Asks "sdformat" or "mujoco" in a confined process. Throws nothing: what goes wrong is kNotAsked,
/// and a crash of the program kRefuses.
SecondOpinion AskProgram(const std::string& program, const std::filesystem::path& file);

/// What a process answered, which ended with that status: "ok", "no" or "absent", the program's
/// name with its version, and its words, a line each.
SecondOpinion OpinionIn(const std::string& program, const std::string& answer, int status);

}  // namespace doorforge::foreign
