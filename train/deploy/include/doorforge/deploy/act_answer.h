// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

inline constexpr int kDecisionSchemaVersion = 1;

/// When an answer says hold, as --set hold.KEY has it.
struct HoldConfig {
  bool foreign = true;  ///< False: however foreign the picture is.
  /// A picture is too foreign that is farther from the training than so many of a hundred of the
  /// training's validation samples are.
  double foreign_percentile = 99;
  bool gain = true;           ///< False: whatever is expected.
  double least_gain_rad = 0;  ///< One action must turn the door or the handle by as much.
  /// A grasp must open the door by as much in the end.
  double least_door_angle_rad = 0.1;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("foreign", self.foreign);
    visit("foreign_percentile", self.foreign_percentile);
    visit("gain", self.gain);
    visit("least_gain_rad", self.least_gain_rad);
    visit("least_door_angle_rad", self.least_door_angle_rad);
  }
};

/// Takes thresholds as a user writes them: "off" switches a hold off, a number switches it on and
/// is its threshold, an empty word leaves it as it is.
///
/// @param foreign_limit Sets `foreign_percentile`.
/// @param least_gain Sets `least_gain_rad` and `least_door_angle_rad`.
/// @throws Error(kInvalidArgument), which names --foreign-limit or --least-gain, on anything else.
void SetHolds(const std::string& foreign_limit, const std::string& least_gain, HoldConfig& config);

/// How far the picture is from those that the policy was trained on, see
/// doorforge/policy/familiarity.h.
struct Foreignness {
  double distance = 0;
  double percentile = 0;
  double limit = 0;  ///< The distance at HoldConfig::foreign_percentile.
};

/// What an OnlineController says to one picture.
struct ActAnswer {
  Stage stage = Stage::kOpen;
  RigidTransform world_from_hand = RigidTransform::Identity();  ///< Where it is to go.
  std::optional<RigidTransform> world_from_hand_now;
  std::optional<Eigen::Vector3d> contact_m;  ///< A grasp has it.
  /// What the door, at the stage handle the handle, is expected to turn by the action; at the stage
  /// grasp how far the door is expected to open in the end.
  double expected_gain_rad = 0;
  std::optional<Foreignness> foreign;  ///< None: the policy does not say.
  std::optional<bool> turned;
  int candidates = 0;
  int visible_points = 0;
  std::optional<int> handle_points;
  std::optional<double> median_depth_m;  ///< Of the picture, which tells a wrong unit.
  std::string weights_sha256;
  std::vector<std::string> hold_reasons;  ///< Empty: go.
};

/// Fills `hold_reasons`.
void Judge(const HoldConfig& config, ActAnswer& answer);

/// docs/act.md.
nlohmann::ordered_json AnswerToJson(const ActAnswer& answer);
/// Says it for people, in a few lines.
std::string AnswerText(const ActAnswer& answer);

}  // namespace doorforge
