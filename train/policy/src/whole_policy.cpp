// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/whole_policy.h"

#include <cstdio>
#include <utility>

#include "doorforge/policy/frozen_sight.h"
#include "doorforge/policy/hand_sight.h"

#include "whole_file.h"

namespace doorforge {
namespace {

// Begins so near to the handle, whoever acts.
std::string StartPrivilege(const HandTaskConfig& task) {
  char text[96];
  std::snprintf(text, sizeof text, "begins %.2g m before the handle's true grasp",
                task.start_distance_m);
  return text;
}

template <class Hand, class Record>
WholePolicy WholeHand(const Record& record, const char* privilege) {
  return {std::make_unique<Hand>(record),
          std::nullopt,
          record.weights_sha256,
          record.provenance,
          {privilege, StartPrivilege(record.task)}};
}

}  // namespace

WholePolicy ReadWholePolicy(const std::filesystem::path& folder) {
  const std::string network = internal::ReadWholeFile(folder).network;
  if (network == internal::kTrajectoryNetwork) {
    const TrajectoryPolicyRecord record = ReadTrajectoryPolicy(folder);
    return {nullptr,
            MakeTrajectoryPolicies(record),
            record.weights_sha256,
            record.provenance,
            {"is told of which part each point is: handle, leaf or frame"}};
  }
  const char* parts = "is told of which part each point is: handle, leaf, frame or robot";
  if (network == internal::kFrozenNetwork)
    return WholeHand<FrozenSightPolicy>(ReadFrozenPolicy(folder), parts);
  if (network == internal::kSightNetwork)
    return WholeHand<HandSightPolicy>(ReadSightPolicy(folder), parts);
  return WholeHand<HandNetworkPolicy>(
      ReadHandPolicy(folder),
      "is told the true states of hinge, handle and latch, and where the grasp is");
}

}  // namespace doorforge
