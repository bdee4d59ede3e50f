// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/report/evaluated_episode.h"
#include "doorforge/report/success_statistics.h"
#include "doorforge/schemas/door_identity.h"
#include "doorforge/schemas/seen_parts.h"

namespace doorforge {

inline constexpr int kReportSchemaVersion = 5;

/// One loss over a training run: epochs with the mean on the training and on the validation
/// samples. All three have the same length; a validation value that was not measured is NaN (null
/// in files).
struct LossCurve {
  std::string name;  ///< Such as "hand position".
  std::string unit;  ///< Such as "m"; empty if it has none.
  std::vector<double> epoch;
  std::vector<double> train;
  std::vector<double> validation;
};

/// Stands for a hash where a policy is no folder but a class of somebody's program.
inline constexpr const char* kOwnPolicy = "own";

/// Whether `actor`, as a provenance says who acted at a stage, is the SHA-256 of a trained policy's
/// weights, and not the name of a rule, kOwnPolicy or nothing.
bool IsTrained(std::string_view actor);

/// Where the numbers come from: hashes name the inputs, so that a report can be checked or made
/// again. No times of day: equal inputs give equal reports.
struct ReportProvenance {
  std::string policy;         ///< Name of the policy's folder or of one's own, or "expert".
  std::string policy_sha256;  ///< It hashes the weights; empty for the expert and one's own.
  std::string
      dataset_sha256;  ///< The policy was trained from data with this hash; empty if unknown.
  /// The SHA-256 of the weights that turned the handle, the name of another policy of the toolkit,
  /// or kOwnPolicy; empty: the expert's rule did.
  std::string handler_sha256 = {};
  /// Names who chose the grasp in the same way.
  std::string grasper_sha256 = {};
  /// It hashes the weights that found the handle for who chose the grasp; empty: it was told.
  std::string finder_sha256 = {};
  /// What the policy is told that a robot would not know, a phrase each; empty where its record
  /// does not say.
  std::vector<std::string> privileges = {};
  std::string code_version;  ///< CodeVersion() of the evaluating program.
  std::string command;       ///< The command line.
  nlohmann::ordered_json config = nlohmann::ordered_json::object();  ///< The effective config.
};

/// Whether one trained policy did all of it: took hold, turned the handle and opened.
bool DidAll(const ReportProvenance& provenance);

/// Whether opening began when the policy that turned the handle said so, and not the simulator.
bool IsSwitchPredicted(const ReportProvenance& provenance);

/// Everything an evaluation found out. Success rates, intervals and counts are not stored but
/// computed from `episodes`, so that they cannot disagree.
struct EvaluationReport {
  ReportProvenance provenance;
  std::vector<DoorIdentity> doors;  ///< Evaluated, sorted by id.
  SeenParts trained_on;             ///< Any of the policies was; empty for the expert.
  std::vector<DoorIdentity>
      training_doors;  ///< They are those of the opener's data set, if it was given.
  std::vector<EvaluatedEpisode> episodes;   ///< Sorted by door, seed, episode.
  std::vector<EvaluatedEpisode> reference;  ///< The expert on the same scenes; may be empty.
  std::vector<LossCurve> losses;            ///< They show the training; empty for the expert.
};

/// Doors whose body or whose handle was trained on, by id, content or shape: they are not held out.
std::vector<std::string> SeenDoors(std::span<const DoorIdentity> doors,
                                   const SeenParts& trained_on);

/// The record `report.json`, docs/format-report.md: the fields above and, computed, "success",
/// "over_seeds", "over_angle" and "causes". Same report, same text.
nlohmann::ordered_json ReportToJson(const EvaluationReport& report);
/// Throws Error(kFormat); `path` names the record. What is computed is not read.
EvaluationReport ReportFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge
