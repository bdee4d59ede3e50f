// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace CLI {
class App;
}  // namespace CLI

namespace doorforge {

/// What the help says of a command, for programs: man pages and completion are made of it.
///
///     {"name", "about", "footer", "positionals": [...], "options": [...], "commands": [...]}
///
/// `commands` are the subcommands, each described alike. A positional has one name, an option each
/// as it is typed ("-j", "--threads"):
///
///     {"names", "about", "type", "check", "values", "default", "needs", "required",
///      "takes", "several"}
///
/// `type` is "" for a flag, otherwise what the help shows ("TEXT", "INT", "KEY=VALUE"); `check` is
/// the help's word for what the value must be ("FILE", "DIR", "INT in [0 - 1024]"), and `values`
/// has those that may be given where they are few. An option is followed by at least `takes`
/// values, and by any further ones where `several` is true.
nlohmann::ordered_json DescribeCommand(const CLI::App& app);

}  // namespace doorforge
