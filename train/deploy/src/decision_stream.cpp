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
  if (request.contains("before"))
    RememberFromFile(controller, ValueOf<std::string>(request, "before", "line"), camera);
  if (request.contains("handle"))
    return DecideGraspFromFiles(controller, ValueOf<std::string>(request, "depth", "line"),
                                ValueOf<std::string>(request, "handle", "line"), camera);
  return DecideFromFiles(controller, ValueOf<std::string>(request, "depth", "line"),
                         ValueOf<std::string>(request, "state", "line"), camera);
}

Json Refusal(const Error& error) {
  return {{"schema", "doorforge.decision"},
          {"schema_version", kDecisionSchemaVersion},
          {"hold", true},
          {"error", error.what()}};
}

}  // namespace

bool AnswerStream(OnlineController& controller, const DecisionStream& stream) {
  bool held = false;
  for (std::string line; StopRequested() == 0 && std::getline(stream.requests, line);) {
    if (line.empty()) continue;
    try {
      const ActAnswer answer = AnswerLine(controller, stream.camera, line);
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
