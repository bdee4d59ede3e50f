// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "describe_command.h"

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> OptionNames(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// CLI11 tells a set of values by their list in braces alone: "{auto,open,handle}".
std::vector<std::string> ValuesOf(std::string_view check) {
  std::vector<std::string> values;
  if (!check.starts_with('{') || !check.ends_with('}')) return values;
  std::istringstream listed{std::string(check.substr(1, check.size() - 2))};
  for (std::string value; std::getline(listed, value, ',');) values.push_back(value);
  return values;
}

Json DescribeOption(const CLI::Option& option, const std::vector<std::string>& names) {
  // type and check are one text, "TEXT:DIR"
  const bool flag = option.get_items_expected_max() == 0;
  const std::string shown = flag ? "" : option.get_type_name();
  const std::size_t colon = shown.find(':');
  const std::string check = colon == std::string::npos ? "" : shown.substr(colon + 1);
  Json needs = Json::array();
  for (const CLI::Option* needed : option.get_needs()) needs.push_back(needed->get_name());
  return {{"names", names},
          {"about", option.get_description()},
          {"type", shown.substr(0, colon)},
          {"check", check},
          {"values", ValuesOf(check)},
          {"default", option.get_default_str()},
          {"needs", needs},
          {"required", option.get_required()},
          {"takes", option.get_items_expected_min()},
          {"several", option.get_expected_max() > 1 && option.get_allow_extra_args()}};
}

}  // namespace

Json DescribeCommand(const CLI::App& app) {
  Json positionals = Json::array();
  Json options = Json::array();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden from the help, too
    // some may be given by their place or by their name
    if (option->get_positional())
      positionals.push_back(DescribeOption(*option, {option->get_name(true)}));
    if (option->nonpositional()) options.push_back(DescribeOption(*option, OptionNames(*option)));
  }
  Json commands = Json::array();
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(DescribeCommand(*command));
  return {{"name", app.get_name()},     {"about", app.get_description()},
          {"footer", app.get_footer()}, {"positionals", positionals},
          {"options", options},         {"commands", commands}};
}

}  // namespace doorforge
