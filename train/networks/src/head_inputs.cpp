// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/head_inputs.h"

namespace doorforge::internal {
namespace {

template <std::size_t N>
void Append(const std::array<float, N>& values, std::vector<float>& out) {
  out.insert(out.end(), values.begin(), values.end());
}

std::array<float, 3> ToArray(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void AppendRobotState(const StageNormalisation& normalisation, const RobotCondition& robot,
                      HeadInputs& inputs) {
  const Proprioception& proprioception = robot.proprioception;
  Append(normalisation.state.Apply(StateOf(normalisation.view.state, proprioception, robot.way)),
         inputs.states);
  Append(normalisation.hand_m.Apply(ToArray(HandPositionOf(proprioception))), inputs.hands);
  Append(normalisation.base_m.Apply(ToArray(BasePositionOf(proprioception))), inputs.bases);
}

}  // namespace doorforge::internal
