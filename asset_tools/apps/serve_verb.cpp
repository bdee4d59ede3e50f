// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/composer/serve.h"
#include "doorforge/core/program.h"

#include "verbs.h"

namespace doorforge {

int RunServeVerb(int argc, char** argv) {
  int port = 8765;
  std::string parts;
  bool open = false;
  CLI::App app("Composes doors in the browser, for this machine alone (127.0.0.1).",
               "doorforge serve");
  app.add_option("--port", port, "0: any that is free")->check(CLI::Range(0, 65535));
  app.add_option("--parts", parts, "folder of parts; the catalogue if left out");
  app.add_flag("--open", open, "show it in the desktop's browser (xdg-open)");
  app.footer("example:\n  doorforge serve --open");
  ParseVerb(app, argc, argv);
  Composer composer(parts);
  ServeComposer(composer, port, [&](const std::string& address) {
    std::printf("%s: ends with Ctrl-C\n", address.c_str());
    std::fflush(stdout);
    if (open) RunChild({"xdg-open", address});
  });
  return 0;
}

}  // namespace doorforge
