// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/export_lerobot.h"

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr ForwardedOption kOptions[] = {
    {"--codebase-version", "lerobot: v3.0, or v2.1 for GR00T"},
    {"--points", "lerobot: of each cloud, 0: no clouds; 1024 by default"},
    {"--images", "lerobot: png (default), within the tables, or video"},
    {"--cameras", "lerobot: names of those to take; all by default", 16},
    {"--depth", "lerobot: also depth, 16 bits [mm]", 0}};

fs::path ScriptPath() {
  for (const fs::path& programs : ProgramFolders()) {
    fs::path script =
        (programs / DOORFORGE_PYTHON_FROM_PROGRAMS / "doorforge_lerobot.py").lexically_normal();
    if (fs::exists(script)) return script;
  }
  throw Error(
      ErrorCode::kMissing,
      "doorforge_lerobot.py is not beside these programs; install doorforge with its Python "
      "package, or call python3 -m doorforge.lerobot where that is installed");
}

}  // namespace

std::span<const ForwardedOption> LerobotOptions() { return kOptions; }

int RunLerobotExport(const std::string& python, const fs::path& folder,
                     const std::vector<std::string>& words) {
  // -P: the file's folder may hold packages of another Python
  std::vector<std::string> argv = {"/usr/bin/env",        python,         "-B", "-P",
                                   ScriptPath().string(), folder.string()};
  argv.insert(argv.end(), words.begin(), words.end());
  constexpr int kNotFound = 127;
  const int code = RunChild(argv);
  if (code == kNotFound)
    throw Error(ErrorCode::kMissing,
                python + ": no such program; give --python a Python 3.11 or later with pyarrow");
  return code;
}

}  // namespace doorforge
