// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>

namespace doorforge::internal {

/// A joint's two stops. Bullet's act from the step after the one that went through them: a latch
/// that pulls a leaf shut by 150 N m drives it into its frame, and the correction throws it open.
/// These let a joint come near in a step by no more than the way that is left.
class JointStop : public btMultiBodyJointLimitConstraint {
 public:
  using btMultiBodyJointLimitConstraint::btMultiBodyJointLimitConstraint;
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  void AddRow(int side, double distance, btMultiBodyConstraintArray& rows,
              btMultiBodyJacobianData& data, const btContactSolverInfo& info);
};

}  // namespace doorforge::internal
