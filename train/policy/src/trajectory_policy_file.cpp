// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "doorforge/networks/network_tensors.h"
#include "doorforge/policy/trajectory_policy.h"

#include "whole_file.h"

namespace doorforge {
namespace {

constexpr const char* kProposer = "proposer";
constexpr const char* kCritic = "critic";
constexpr const char* kAffordance = "affordance";

}  // namespace

void WriteTrajectoryPolicy(const std::filesystem::path& folder,
                           const TrajectoryPolicyRecord& record) {
  const TrajectoryNetworks& networks = record.networks;
  nlohmann::ordered_json json = internal::WriteWholeWeights(
      folder,
      {{kProposer, PointNetLayout(ProposerShape(networks.shape)), networks.proposer},
       {kCritic, PointNetLayout(CriticShape(networks.shape)), networks.critic},
       {kAffordance, PointNetLayout(AffordanceShape(networks.shape)), networks.affordance}});
  json["network"] = internal::kTrajectoryNetwork;
  json["sizes"] = ToJson(networks.shape);
  json["look"] = ToJson(record.look);
  json["choice"] = ToJson(record.choice);
  json["provenance"] = internal::HandProvenanceToJson(record.provenance);
  internal::WriteWholeRecord(folder, json);
}

TrajectoryPolicyRecord ReadTrajectoryPolicy(const std::filesystem::path& folder) {
  const internal::WholeFile file = internal::ReadWholeFile(folder);
  internal::RequireNetwork(file, internal::kTrajectoryNetwork);
  TrajectoryPolicyRecord record;
  record.networks.shape =
      internal::SettingsOfRecord<TrajectoryShape>(file, "sizes", CheckTrajectoryShape);
  record.look = internal::SettingsOfRecord<TrajectoryLook>(file, "look", CheckTrajectoryLook);
  record.choice =
      internal::SettingsOfRecord<TrajectoryChoice>(file, "choice", CheckTrajectoryChoice);
  record.weights_sha256 = ValueOf<std::string>(file.json, "weights_sha256", file.path);
  record.provenance =
      internal::HandProvenanceFromJson(file.Member("provenance"), file.Path("provenance"));
  const TensorFile weights = internal::ReadWholeWeights(folder, file);
  const auto read = [&](const char* name, const PointNetShape& shape) {
    return internal::ReadParameters(PointNetLayout(shape), internal::NetworkPrefix(name), weights,
                                    (folder / internal::kWholeWeights).string());
  };
  record.networks.proposer = read(kProposer, ProposerShape(record.networks.shape));
  record.networks.critic = read(kCritic, CriticShape(record.networks.shape));
  record.networks.affordance = read(kAffordance, AffordanceShape(record.networks.shape));
  return record;
}

}  // namespace doorforge
