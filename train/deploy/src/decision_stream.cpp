// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/decision_stream.h"

#include <istream>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

ActAnswer AnswerLine(OnlineController& controller, const std::string& camera,
                     const std::string& line) {
  const Json request = ParseJson(line, "line");
  if (!request.is_object())
    throw Error(ErrorCode::kFormat, "expected a line {\"depth\": FILE, \"state\": FILE}");
  const auto file = [&](const char* key, bool is_needed) {
    return is_needed || request.contains(key) ? ValueOf<std::string>(request, key, "line") : "";
  };
  DecisionFiles files;
  files.camera = camera;
  files.depth = file("depth", true);
  files.handle = file("handle", false);
  files.before = file("before", false);
  files.color = file("color", false);
  files.before_color = file("before_color", false);
  files.state = file("state", files.handle.empty() && !controller.FindsHandle());
  return DecideFromFiles(controller, files);
}

Json Refusal(const Error& error) {
  return {{"schema", "doorforge.decision"},
          {"schema_version", kDecisionSchemaVersion},
          {"hold", true},
          {"error", error.what()}};
}

}  // namespace

void CheckRequest(const OnlineControllerSetup& setup, const DecisionFiles& files,
                  const std::string& picture) {
  const auto require = [](bool condition, const std::string& problem) {
    Require(condition, ErrorCode::kInvalidArgument, problem + "; see `doorforge act --help`");
  };
  // who takes hold may find the handle by itself
  const bool says_what =
      files.handle.empty() ? !files.state.empty() || !setup.grasper.empty() : files.state.empty();
  const bool one = !files.depth.empty() && says_what;
  const bool none = files.depth.empty() && files.state.empty() && files.handle.empty();
  require(
      setup.sees_every_decision ? none : one,
      "--depth and either --state or --handle-mask (with a finder of handles neither), or --stream "
      "in place of them, are required");
  require(!setup.opener.empty() || !setup.handler.empty() || !setup.grasper.empty(),
          "--opener, --handler or --grasper is required");
  require(!setup.sees_every_decision || picture.empty(),
          "--picture is of one answer, and --stream gives many; leave one of them out");
}

bool AnswerStream(OnlineController& controller, const DecisionStream& stream) {
  RememberFromFile(controller, stream.files);
  bool held = false;
  for (std::string line; StopRequested() == 0 && std::getline(stream.requests, line);) {
    if (line.empty()) continue;
    try {
      const ActAnswer answer = AnswerLine(controller, stream.files.camera, line);
      held = held || !answer.hold_reasons.empty();
      stream.tell((stream.as_text ? AnswerText(answer) : JsonText(AnswerToJson(answer))) + "\n");
    } catch (const Error& error) {
      held = true;
      stream.tell((stream.as_text ? "hold:     " + std::string(error.what()) + "\n"
                                  : JsonText(Refusal(error))) +
                  "\n");
    }
  }
  return held;
}

}  // namespace doorforge
