// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/named_enum.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace doorforge {

struct ConfigSources;  // environment_preset.h

/// Whether an option may be given an empty text.
enum class EmptyValues {
  kAccept,
  kRefuse,  ///< `--task "$UNSET"` must not pass for no `--task`.
};

/// Given alone, this argument makes a verb print its name, options and subcommands as a JSON
/// document, and the front program those of all verbs. The build makes man pages and completion of
/// it; it is no part of the help.
inline constexpr const char* kDescribeCommand = "--describe-command";

/// Parses the arguments of a verb (argv[0] is its name). Prints the help, or the description that
/// kDescribeCommand wants, and ends the process where it was asked for.
///
/// @throws Error(kInvalidArgument) on wrong use. An option or a subcommand that there is not is
///     told before all else, with the nearest one that there is: what is missing often was
///     misspelled.
void ParseVerb(CLI::App& app, int argc, char** argv, EmptyValues empty = EmptyValues::kAccept);

/// @name Options that several verbs have
/// Each has one name and one kind of value in all verbs. `about` is the text of the help: what the
/// option means to this verb. A variable must live until the arguments are parsed; what it holds
/// before that is the default.
/// @{

/// Adds `--config FILE`.
CLI::Option* AddConfig(CLI::App& app, std::string& config, const std::string& about);

/// Adds `--preset NAME`, the environment that the settings of scene and cloud begin with
/// (environment_preset.h); the help names those that there are.
CLI::Option* AddPreset(CLI::App& app, std::string& preset);

/// Adds `--preset NAME` and `--simulator NAME`, for verbs that let policies play.
void AddEnvironment(CLI::App& app, ConfigSources& sources);

/// Adds `--set KEY=VALUE`, which every verb with settings has. Each takes one setting and leaves
/// what follows it to the others; several are given as several `--set`.
///
/// @param settings Those given, in order.
/// @param about What it does, for the help: "a.b=c overrides one setting".
CLI::Option* AddSettings(CLI::App& app, std::vector<std::string>& settings,
                         const std::string& about);

/// Adds `--seed N`. The help shows the default.
CLI::Option* AddSeed(CLI::App& app, std::uint64_t& seed, const std::string& about);

/// Adds `-j`, `--threads N`, where 0 stands for all processors. The help shows the default.
CLI::Option* AddThreads(CLI::App& app, int& threads,
                        const std::string& about = "0: all processors");

/// Adds `--overwrite`.
CLI::Option* AddOverwrite(CLI::App& app, bool& overwrite, const std::string& about);
CLI::Option* AddOverwrite(CLI::App& app, Existing& existing, const std::string& about);

/// Adds `--json`.
CLI::Option* AddJson(CLI::App& app, bool& json,
                     const std::string& about = "print one JSON document");

/// Adds `--max-seconds S`, more than 0, for verbs that work on many objects or on a mesh from
/// elsewhere.
CLI::Option* AddMaxSeconds(CLI::App& app, double& max_seconds,
                           const std::string& about =
                               "processor time that one object may take before it is given up "
                               "(300)");
/// @}

/// What AddChoice() adds: the words that are allowed, the one that holds if none is given (empty:
/// the help shows none), and what takes the word.
struct Choice {
  std::vector<std::string> words;
  std::string given;
  std::function<void(const std::string&)> take;
};

/// Adds an option that is one of several words.
CLI::Option* AddChoice(CLI::App& app, const std::string& name, const std::string& about,
                       const Choice& choice);

/// It does so for an enum with a table of words; the help shows the default.
template <NamedEnum Enum>
CLI::Option* AddChoice(CLI::App& app, const std::string& name, Enum& value,
                       const std::string& about) {
  return AddChoice(app, name, about,
                   {NamesOf<Enum>(), std::string(NameOf(value)),
                    [&value](const std::string& word) { value = *ValueNamed<Enum>(word); }});
}

/// It does so where nothing given leaves the value to somebody else, such as a file of settings.
template <NamedEnum Enum>
CLI::Option* AddChoice(CLI::App& app, const std::string& name, std::optional<Enum>& value,
                       const std::string& about) {
  return AddChoice(app, name, about, {NamesOf<Enum>(), "", [&value](const std::string& word) {
                                        value = ValueNamed<Enum>(word);
                                      }});
}

/// Adds an option of one word, for rooms whose options several verbs have, and which see no more of
/// CLI11 than this. The help shows a default that is not empty.
CLI::Option* AddWord(CLI::App& app, const std::string& name, std::string& word,
                     const std::string& about);

/// Goes on accepting an option's earlier name, with a note on standard error that tells the new
/// one. It is not in the help. Who gives both is refused with Error(kInvalidArgument).
///
/// @param now The new name, which must have been added before; `value` is that option's.
void AddEarlierName(CLI::App& app, const std::string& earlier, const std::string& now,
                    std::string& value);

/// The command as a user would type it, for records, with quotes where a shell needs them.
///
/// @param program What goes before the arguments: "doorforge eval".
/// @param argv argv[0] is not read.
std::string CommandLineText(const std::string& program, int argc, char** argv);

}  // namespace doorforge
