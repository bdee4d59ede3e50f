// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/core/forwarded_option.h"

namespace CLI {
class App;
}

namespace doorforge {

/// Adds them to a verb, which finds what was given by GivenWords().
void AddForwarded(CLI::App& app, std::span<const ForwardedOption> options);

/// Throws Error(kInvalidArgument) if any of them was given; `belongs_to`, such as "--to lerobot",
/// is what they are for.
void RefuseForwarded(const CLI::App& app, std::span<const ForwardedOption> options,
                     const std::string& belongs_to);

/// What was given on the command line, as words for another program: each option's name and its
/// values. Positional ones are left out, and those in `without`, such as "--to".
std::vector<std::string> GivenWords(const CLI::App& app, std::span<const std::string_view> without);

}  // namespace doorforge
