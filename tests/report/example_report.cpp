// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "example_report.h"

#include <cmath>
#include <limits>

#include "doorforge/core/hash.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

constexpr int kDoors = 6;
constexpr int kSeeds = 3;

Category CategoryOfDoor(int door) {
  return door < 4 ? Category::kInterior : Category::kStorageFurniture;
}

DoorIdentity Door(int number, const std::string& set) {
  const std::string body = set + "_body_" + std::to_string(number);
  const std::string handle = set + "_handle_" + std::to_string(number);
  return {.id = body + "__" + handle,
          .category = CategoryOfDoor(number),
          .mechanism = number < 2 ? Mechanism::kLever : Mechanism::kRound,
          .body = {body, Sha256Hex(body), {}},
          .handle = {handle, Sha256Hex(handle), {}},
          .sha256 = Sha256Hex(body + handle),
          .license = "CC0-1.0"};
}

EvaluatedEpisode Row(const DoorIdentity& door, std::uint64_t seed, double skill) {
  Rng rng(seed, "example/" + door.id);
  EvaluatedEpisode row;
  row.door_id = door.id;
  row.category = door.category;
  row.mechanism = door.mechanism;
  row.body = door.body.id;
  row.handle = door.handle.id;
  row.seed = seed;
  row.peak_hinge_rad = std::min(1.2, skill * rng.Uniform(0.2, 1.6));
  row.peak_handle_rad = 0.6 + 0.1 * rng.Uniform();
  row.outcome = row.peak_hinge_rad > kSuccessAngles[3]
                    ? EpisodeOutcome::kOpened
                    : static_cast<EpisodeOutcome>(1 + rng.Index(kEpisodeOutcomeCount - 1));
  row.detail = "hinge " + std::to_string(row.peak_hinge_rad) + " rad < limit & \"grasp\" <held>";
  row.opening_actions = 12;
  row.simulated_s = 6.5;
  row.handle_turned = row.outcome == EpisodeOutcome::kOpened;
  row.peak_force_n = 160 + 40 * rng.Uniform();
  row.state_sha256 = Sha256Hex(row.detail);
  return row;
}

LossCurve Loss(const std::string& name, double first) {
  LossCurve loss;
  loss.name = name;
  loss.unit = "m";
  for (int epoch = 1; epoch <= 12; ++epoch) {
    loss.epoch.push_back(epoch);
    loss.train.push_back(first * std::exp(-0.25 * epoch) + 0.02);
    loss.validation.push_back(epoch == 1 ? std::numeric_limits<double>::quiet_NaN()
                                         : first * std::exp(-0.2 * epoch) + 0.04);
  }
  return loss;
}

}  // namespace

EvaluationReport ExampleReport() {
  EvaluationReport report;
  report.provenance = {
      .policy = "opener",
      .policy_sha256 = Sha256Hex("policy"),
      .dataset_sha256 = Sha256Hex("dataset"),
      .code_version = "0.1.0+example",
      .command = "doorforge eval --policy opener --doors \"held out\" --out report",
      .config = {{"seeds", 3}, {"episodes_per_door", 1}}};
  for (int number = 0; number < kDoors; ++number) {
    report.doors.push_back(Door(number, "held_out"));
    report.training_doors.push_back(Door(number, "training"));
    report.trained_on.bodies.push_back(report.training_doors.back().body);
    report.trained_on.handles.push_back(report.training_doors.back().handle);
  }
  for (const DoorIdentity& door : report.doors) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      report.episodes.push_back(Row(door, seed, 1));
      report.reference.push_back(Row(door, seed, 1.6));
    }
  }
  report.losses = {Loss("position", 1), Loss("rotation", 0.5), Loss("kl", 4)};
  return report;
}

}  // namespace doorforge
