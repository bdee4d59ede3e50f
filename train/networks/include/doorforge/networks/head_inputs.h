// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/networks/stage_networks.h"

namespace doorforge::internal {

/// What the layers behind the encoders read for n samples, row by row. All numbers are normalised
/// (StageNormalisation). A head reads the members that its documentation names; the others may be
/// empty.
struct HeadInputs {
  int size = 0;                 ///< n.
  std::vector<float> features;  ///< n x 128, of the encoder of the network at hand.
  std::vector<float> states;    ///< n x 18.
  std::vector<float> actions;   ///< n x 9.
  std::vector<float> hands;     ///< n x 3.
  std::vector<float> bases;     ///< n x 3.
  /// n x k x 3, as AppendInHandFrame() writes them. Where they are given, the discriminator reads
  /// neither features nor actions.
  std::vector<float> near;
  std::vector<float> points;  ///< n x 3, normalised as an action's position.
};

/// What a robot knows of itself, and the way that its motion is to take.
struct RobotCondition {
  const Proprioception& proprioception;
  MotionWay way = MotionWay::kUsual;
};

/// Appends a robot's normalised state and the positions of its hand and base.
void AppendRobotState(const StageNormalisation& normalisation, const RobotCondition& robot,
                      HeadInputs& inputs);

}  // namespace doorforge::internal
