// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/command_line.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"

#include "describe_command.h"

namespace doorforge {
namespace {

constexpr const char* kSet = "--set";  // as AddSettings() calls it

bool IsOption(const std::string& word) { return word.size() > 1 && word.starts_with('-'); }

// Names are as people type them, "--body" and "-n" alike.
std::vector<std::string> OptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> SubcommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string UnknownName(const std::string& kind, const std::string& name,
                        const std::vector<std::string>& known) {
  return "unknown " + kind + " \"" + name + "\"; did you mean \"" + NearestName(name, known) +
         "\"?";
}

bool LacksSubcommand(const CLI::App& app) {
  return app.get_require_subcommand_min() > 0 && app.get_subcommands().empty();
}

std::string FaultOfWord(const CLI::App& app, const std::string& word) {
  if (IsOption(word))
    return UnknownName("option", word.substr(0, word.find('=')), OptionNames(app));
  if (LacksSubcommand(app)) return UnknownName("subcommand", word, SubcommandNames(app));
  if (word.find('=') != std::string::npos && app.get_option_no_throw(kSet) != nullptr)
    return "\"" + word + "\" was not expected; each " + kSet + " takes one setting: " + kSet + " " +
           word;
  return "\"" + word + "\" was not expected";
}

// What is wrong with the words that nobody took; empty if all were taken. The options behind a
// misspelled subcommand are not the verb's, otherwise options come first: their values are among
// the words.
std::string FaultOfLeftOver(const CLI::App& app) {
  for (const CLI::App* verb : app.get_subcommands()) {
    const std::string fault = FaultOfLeftOver(*verb);
    if (!fault.empty()) return fault;
  }
  std::vector<std::string> words = app.remaining();
  words.erase(std::remove(words.begin(), words.end(), "--"), words.end());
  if (words.empty()) return "";
  if (LacksSubcommand(app) && !IsOption(words.front())) return FaultOfWord(app, words.front());
  const auto option = std::find_if(words.begin(), words.end(), IsOption);
  return FaultOfWord(app, option != words.end() ? *option : words.front());
}

std::string FaultOf(const CLI::App& app, const CLI::ParseError& error) {
  const std::string left_over = FaultOfLeftOver(app);
  if (!left_over.empty()) return left_over;
  if (LacksSubcommand(app)) return "a subcommand is required: " + Joined(SubcommandNames(app));
  return error.what();
}

// "doorforge dataset info", as far as the words were understood.
std::string CommandOf(const CLI::App& app) {
  std::string command = app.get_name();
  for (const CLI::App* verb : app.get_subcommands()) command += " " + CommandOf(*verb);
  return command;
}

void RefuseEmptyValues(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results())
      if (value.empty())
        throw Error(ErrorCode::kInvalidArgument,
                    option->get_name() +
                        ": its value is empty; is a variable unset? Leave the option out to do "
                        "without it");
  }
  for (const CLI::App* verb : app.get_subcommands()) RefuseEmptyValues(*verb);
}

}  // namespace

void ParseVerb(CLI::App& app, int argc, char** argv, EmptyValues empty) {
  if (argc == 2 && std::string_view(argv[1]) == kDescribeCommand) {
    std::cout << DescribeCommand(app).dump(2) << '\n';
    std::exit(0);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // for the help
    std::exit(app.exit(asked));
  } catch (const CLI::ParseError& error) {
    const std::string fault = FaultOf(app, error);
    throw Error(ErrorCode::kInvalidArgument, fault + (fault.ends_with('?') ? " see `" : "; see `") +
                                                 CommandOf(app) + " --help`");
  }
  if (empty == EmptyValues::kRefuse) RefuseEmptyValues(app);
}

std::string CommandLineText(const std::string& program, int argc, char** argv) {
  std::string line = program;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain =
        !argument.empty() && argument.find_first_of(" \t\"'$&|;<>()*?\\") == std::string::npos;
    line += plain ? " " + argument : " '" + argument + "'";
  }
  return line;
}

}  // namespace doorforge
