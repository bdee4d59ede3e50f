// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/remote/remote_options.h"

#include <charconv>
#include <utility>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

double NumberOf(const std::string& option, const std::string& text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  Require(read.ec == std::errc() && read.ptr == end && number > 0 && number <= 1e5,
          ErrorCode::kInvalidArgument,
          option + ": \"" + text + "\", expected a number greater than 0, at most 100000");
  return number;
}

using Maker = std::unique_ptr<Policy> (*)(const std::string&, const RemotePolicySettings&);

std::string AddRow(PolicyRegistry& registry, const std::string& word, Maker make,
                   RemotePolicySettings settings) {
  const std::string name = make == MakeCommandPolicy ? "command" : "server";
  const ServerGreeting said =
      make == MakeServedPolicy ? GreetingOf(word, settings) : ServerGreeting{};
  settings.remembers = said.remembered.IsOn();
  registry.Add(MotionPolicyRow{.stage = *StageNamed(settings.stage),
                               .name = name,
                               .make = [=](const PolicySettings&) { return make(word, settings); },
                               .remembered = said.remembered});
  return name;
}

}  // namespace

void AddRemoteOptions(CLI::App& app, RemoteOptions& options) {
  AddWord(
      app, "--policy", options.policy,
      "the same as --opener. A server's address, such as ws://127.0.0.1:8000, will do there and "
      "for --handler");
  AddWord(app, "--policy-command", options.command,
          "a program that opens, such as \"python3 p.py\", by messages on its standard input and "
          "output");
  AddWord(app, "--policy-timeout", options.timeout,
          "seconds that a server or program has for an answer");
  AddWord(app, "--policy-chunk", options.chunk, "so many actions of each answer are carried out");
}

void UseRemotePolicies(const RemoteOptions& options, const std::string& default_opener,
                       PolicyRegistry& registry, PolicyWords& words) {
  const int openers = (words.opener != default_opener ? 1 : 0) + (options.policy.empty() ? 0 : 1) +
                      (options.command.empty() ? 0 : 1);
  Require(openers <= 1, ErrorCode::kInvalidArgument,
          "--opener, --policy and --policy-command each say who opens; give one of them");
  RemotePolicySettings settings{
      .timeout_s = NumberOf("--policy-timeout", options.timeout),
      .chunk = static_cast<int>(NumberOf("--policy-chunk", options.chunk))};
  if (!options.policy.empty()) words.opener = options.policy;
  if (!options.command.empty())
    words.opener = AddRow(registry, options.command, MakeCommandPolicy, settings);
  if (IsServerAddress(words.opener))
    words.opener = AddRow(registry, words.opener, MakeServedPolicy, settings);
  settings.stage = "handle";
  if (IsServerAddress(words.handler))
    words.handler = AddRow(registry, words.handler, MakeServedPolicy, settings);
}

}  // namespace doorforge
