// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/networks/heads.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// What a policy's critic expects of an action, whoever chose it: of one that opens how far the
/// door turns by it, of one that turns the handle how far that does. Serves several threads.
class GainCritic {
 public:
  /// @throws Error(kInvalidArgument) unless the networks are those of the family kMotion.
  explicit GainCritic(StageNetworks networks);

  /// [rad] @throws Error(kInvalidArgument) as Policy::Act() of these networks.
  double GainOf(const Observation& observation, const Action& action) const;

 private:
  StageNetworks networks_;
  PointEncoder encoder_;
  internal::CriticHead head_;
};

}  // namespace doorforge
