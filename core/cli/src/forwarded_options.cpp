// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/forwarded_options.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "doorforge/core/error.h"

namespace doorforge {

void AddForwarded(CLI::App& app, std::span<const ForwardedOption> options) {
  using Values = std::vector<std::string>;
  for (const ForwardedOption& option : options) {
    if (option.most_values == 0)
      app.add_flag(option.name, option.about);
    else
      app.add_option_function<Values>(
             option.name, [](const Values&) {}, option.about)
          ->expected(1, option.most_values);
  }
}

void RefuseForwarded(const CLI::App& app, std::span<const ForwardedOption> options,
                     const std::string& belongs_to) {
  for (const ForwardedOption& option : options) {
    if (app.get_option(option.name)->count() > 0)
      throw Error(ErrorCode::kInvalidArgument,
                  std::string(option.name) + ": is for " + belongs_to + " alone; leave it out");
  }
}

std::vector<std::string> GivenWords(const CLI::App& app,
                                    std::span<const std::string_view> without) {
  std::vector<std::string> words;
  for (const CLI::Option* option : app.get_options()) {
    const std::string& name = option->get_name();
    const bool is_left_out = option->get_positional() || option->count() == 0 ||
                             std::ranges::find(without, name) != without.end();
    if (is_left_out) continue;
    words.push_back(name);
    if (option->get_items_expected_max() > 0) {
      const std::vector<std::string>& values = option->results();
      words.insert(words.end(), values.begin(), values.end());
    }
  }
  return words;
}

}  // namespace doorforge
