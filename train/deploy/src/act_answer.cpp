// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/act_answer.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

template <class... Values>
std::string Formatted(const char* pattern, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

bool Grasps(const ActAnswer& answer) { return answer.stage == Stage::kGrasp; }

void JudgeForeignness(const HoldConfig& config, ActAnswer& answer) {
  if (!config.foreign || !answer.foreign) return;
  const Foreignness& foreign = *answer.foreign;
  if (foreign.distance <= foreign.limit) return;
  answer.hold_reasons.push_back(
      Formatted("the picture is foreign to the policy: distance %.2f, and %g %% of the training's "
                "validation samples are within %.2f",
                foreign.distance, config.foreign_percentile, foreign.limit) +
      (answer.median_depth_m ? Formatted("; its median depth is %.2f m", *answer.median_depth_m)
                             : "") +
      "; look at what the camera shows, at the camera file and " +
      (Grasps(answer) ? "the mask" : "the state") +
      " (--picture draws them), or pass --foreign-limit off");
}

void JudgeGain(const HoldConfig& config, ActAnswer& answer) {
  const double least = Grasps(answer) ? config.least_door_angle_rad : config.least_gain_rad;
  if (!config.gain || answer.expected_gain_rad >= least) return;
  answer.hold_reasons.push_back(
      Formatted("the policy expects %.4f rad of %s, and the least is %g (--least-gain)",
                answer.expected_gain_rad, Grasps(answer) ? "this grasp" : "this action", least));
}

void SetHold(const std::string& word, const char* option, bool& on, double& threshold) {
  if (word.empty()) return;
  on = word != "off";
  if (!on) return;
  char* end = nullptr;
  threshold = std::strtod(word.c_str(), &end);
  Require(*end == '\0' && std::isfinite(threshold), ErrorCode::kInvalidArgument,
          std::string(option) + ": found \"" + word + "\", expected a number or off");
}

Json ForeignToJson(const std::optional<Foreignness>& foreign) {
  if (!foreign) return nullptr;
  return {{"distance", foreign->distance},
          {"limit", foreign->limit},
          {"percentile", foreign->percentile}};
}

std::string ExpectationText(const ActAnswer& answer) {
  const char* what = "the door turns";
  if (answer.stage == Stage::kHandle) what = "the handle turns";
  if (Grasps(answer)) what = "the door opens in the end";
  return Formatted("expected: %s %.4f rad (%.1f degrees)\n", what, answer.expected_gain_rad,
                   answer.expected_gain_rad / kDegree);
}

std::string ForeignText(const std::optional<Foreignness>& foreign) {
  if (!foreign) return "foreign:  cannot be told, the policy has no familiar.safetensors\n";
  return Formatted(
      "foreign:  distance %.2f, farther than %.1f %% of the validation samples; limit "
      "%.2f\n",
      foreign->distance, foreign->percentile, foreign->limit);
}

std::string HoldText(const std::vector<std::string>& reasons) {
  if (reasons.empty()) return "hold:     no\n";
  std::string text;
  for (const std::string& reason : reasons) text += "hold:     " + reason + "\n";
  return text;
}

std::string PositionText(const Eigen::Vector3d& position) {
  return Formatted("(%.3f, %.3f, %.3f) m", position.x(), position.y(), position.z());
}

}  // namespace

void SetHolds(const std::string& foreign_limit, const std::string& least_gain, HoldConfig& config) {
  SetHold(foreign_limit, "--foreign-limit", config.foreign, config.foreign_percentile);
  SetHold(least_gain, "--least-gain", config.gain, config.least_gain_rad);
  SetHold(least_gain, "--least-gain", config.gain, config.least_door_angle_rad);
}

void Judge(const HoldConfig& config, ActAnswer& answer) {
  answer.hold_reasons.clear();
  JudgeForeignness(config, answer);
  JudgeGain(config, answer);
}

Json AnswerToJson(const ActAnswer& answer) {
  Json json = {{"schema", "doorforge.decision"},
               {"schema_version", kDecisionSchemaVersion},
               {"stage", NameOf(answer.stage)},
               {"hold", !answer.hold_reasons.empty()},
               {"hold_reasons", answer.hold_reasons},
               {"world_from_hand", TransformToJson(answer.world_from_hand)}};
  if (answer.world_from_hand_now)
    json["position_delta_m"] = Vector3ToJson(answer.world_from_hand.translation() -
                                             answer.world_from_hand_now->translation());
  if (answer.contact_m) json["contact_m"] = Vector3ToJson(*answer.contact_m);
  json["expected_gain_rad"] = answer.expected_gain_rad;
  if (Grasps(answer)) json["expected_door_angle_rad"] = answer.expected_gain_rad;
  json["foreign"] = ForeignToJson(answer.foreign);
  if (answer.turned) json["turned"] = *answer.turned;
  json["candidates"] = answer.candidates;
  json["visible_points"] = answer.visible_points;
  if (answer.median_depth_m) json["median_depth_m"] = *answer.median_depth_m;
  if (answer.handle_points) json["handle_points"] = *answer.handle_points;
  json["weights_sha256"] = answer.weights_sha256;
  return json;
}

std::string AnswerText(const ActAnswer& answer) {
  const Eigen::Quaterniond turn(answer.world_from_hand.linear());
  std::string text = "stage:    " + std::string(NameOf(answer.stage)) + "\n";
  text += "hand:     " + PositionText(answer.world_from_hand.translation());
  if (answer.world_from_hand_now)
    text += Formatted(
        ", %.0f mm from where it is",
        1000 * (answer.world_from_hand.translation() - answer.world_from_hand_now->translation())
                   .norm());
  text += Formatted("; quaternion xyzw (%.3f, %.3f, %.3f, %.3f)\n", turn.x(), turn.y(), turn.z(),
                    turn.w());
  if (answer.contact_m) text += "contact:  " + PositionText(*answer.contact_m) + "\n";
  return text + ExpectationText(answer) + ForeignText(answer.foreign) +
         HoldText(answer.hold_reasons);
}

}  // namespace doorforge
