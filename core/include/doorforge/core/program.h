// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace doorforge {

/// Runs the body of a `main` and turns its end into an exit code: the body's own result, or the
/// code of an Error (its message goes to standard error as "doorforge: ..."). Any other exception
/// is reported the same way with exit code 3. Installs handlers for SIGINT and SIGTERM, see
/// StopRequested(); a second signal, half a second later or more, ends the process at once.
int RunProgram(const std::function<int()>& body);

/// The signal (SIGINT or SIGTERM) that asked the program to save its state and end, or 0. Long
/// loops poll it; a program that stopped because of it returns 128 + the signal.
int StopRequested();

/// Folder of the running executable, where the other doorforge programs lie.
std::filesystem::path ProgramFolder();

/// Folders in which the programs and, relative to them, the data are looked for: that of the
/// running executable, then those of each `doorforge` on $PATH, links followed. So a program of
/// somebody else that links these libraries finds the installation that its user calls.
std::vector<std::filesystem::path> ProgramFolders();

/// Folder with `catalog/`, `robots/` and `splits/`: $DOORFORGE_DATA, else the first of
/// `share/doorforge` beside ProgramFolders(), in a build tree as in an installation. No path of the
/// machine that built it is known, so both may be moved. Throws Error(kMissing).
std::filesystem::path DataFolder();

/// Where the standard output of a child goes: with that of its parent, or among the messages, where
/// the parent's standard output is one document.
enum class ChildOutput { kStandardOutput, kStandardError };

/// Runs a program (argv[0] is its path, or a name on $PATH) and waits. Returns its exit code, or
/// 128 + signal. A stop request is passed on to it, and it is killed as soon as the calling thread
/// ends without having waited, as when the whole process is killed. Throws Error(kMissing) if it
/// cannot be started.
int RunChild(const std::vector<std::string>& argv,
             ChildOutput output = ChildOutput::kStandardOutput);

/// Version and source commit of this build, such as "0.1.0+1a2b3c4".
std::string CodeVersion();

}  // namespace doorforge
