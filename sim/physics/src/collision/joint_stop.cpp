// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/joint_stop.h"

#include <algorithm>
#include <cmath>

namespace doorforge::internal {
namespace {

// Beyond what the next step's forces can reach; rows farther out would only cost time.
constexpr double kReach = 0.05;  // rad or m

}  // namespace

void JointStop::createConstraintRows(btMultiBodyConstraintArray& rows,
                                     btMultiBodyJacobianData& data,
                                     const btContactSolverInfo& info) {
  if (m_numDofsFinalized != m_jacSizeBoth) finalizeMultiDof();
  const double position = m_bodyA->getJointPos(m_linkA);
  const double reach = kReach + std::abs(m_bodyA->getJointVel(m_linkA)) * info.m_timeStep;
  for (const int side : {0, 1}) {
    const double distance = side == 0 ? position - m_lowerBound : m_upperBound - position;
    if (distance < reach) AddRow(side, distance, rows, data, info);
  }
}

void JointStop::AddRow(int side, double distance, btMultiBodyConstraintArray& rows,
                       btMultiBodyJacobianData& data, const btContactSolverInfo& info) {
  btMultiBodySolverConstraint& row = rows.expandNonInitializing();
  row.m_orgConstraint = this;
  row.m_orgDofIndex = side;
  row.m_multiBodyA = m_bodyA;
  row.m_multiBodyB = m_bodyB;
  const btVector3 none(0, 0, 0);
  const double speed = fillMultiBodyConstraint(row, data, jacobianA(side), jacobianB(side), none,
                                               none, none, none, 0, info, 0, m_maxAppliedImpulse);
  const double share = distance > 0 ? 1 : info.m_erp2;
  row.m_rhs = (-share * distance / info.m_timeStep - speed) * row.m_jacDiagABInv;
}

}  // namespace doorforge::internal
