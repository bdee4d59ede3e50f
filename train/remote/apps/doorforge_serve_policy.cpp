// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that serves a policy to robot stacks and other simulators.

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/program.h"
#include "doorforge/registry/lone_policy.h"
#include "doorforge/remote/policy_server.h"

namespace doorforge {
namespace {

int RunServePolicyVerb(int argc, char** argv) {
  PolicyServerConfig config;
  CLI::App app(
      "Serves a trained policy by WebSocket and MessagePack, as openpi does: docs/serve-policy.md.",
      "doorforge serve-policy");
  app.add_option("POLICY", config.policy, "folder that `doorforge train` wrote")->required();
  app.add_option("--stage", config.stage, "what the policy does")
      ->capture_default_str()
      ->check(CLI::IsMember({"open", "handle"}));
  app.add_option("--host", config.host, "address to listen at; 0.0.0.0: all of this machine")
      ->capture_default_str();
  app.add_option("--port", config.port, "0: one that is free, and is said")->capture_default_str();
  app.footer("example:\n  doorforge serve-policy run/opener --port 8000");
  ParseVerb(app, argc, argv);
  const auto make = [&] {
    return std::make_unique<LonePolicy>(config.policy, *StageNamed(config.stage));
  };
  make();  // what cannot be read is refused here, not when somebody connects
  ServePolicy(config, make, [&](int port) {
    std::printf("serving %s at ws://%s:%d; Ctrl-C ends it\n", config.policy.c_str(),
                config.host.c_str(), port);
    std::fflush(stdout);
  });
  return 128 + StopRequested();
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunOneVerb({"serve-policy", doorforge::RunServePolicyVerb}, argc, argv);
}
