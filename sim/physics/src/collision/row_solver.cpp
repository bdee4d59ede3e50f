// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/row_solver.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

namespace doorforge::internal {
namespace {

using Four = double __attribute__((vector_size(32), aligned(8), may_alias));

// to -= from * factor, `count` a multiple of four. Wider registers give the same bits, since there
// is nothing to sum up and nothing to fuse.
__attribute__((target_clones("avx2", "default"))) void SubtractScaled(double* to,
                                                                      const double* from,
                                                                      double factor,
                                                                      Eigen::Index count) {
  auto* target = reinterpret_cast<Four*>(to);
  const auto* source = reinterpret_cast<const Four*>(from);
  for (Eigen::Index i = 0; i < count / 4; ++i) target[i] -= source[i] * factor;
}

// Contacts of a hand at work overlap by less than 3 mm [m].
constexpr double kFullFriction = 0.003;
constexpr double kNoFriction = 0.006;

// What presses bodies apart that are inside each other is a correction, not a load. Friction in
// proportion to it holds them in: a pad that was wedged against a handle sank in by a centimetre,
// until the way out led across the handle and threw it off.
double FadingFriction(const btMultiBodySolverConstraint& normal,
                      const btMultiBodySolverConstraint& row) {
  const auto& point = *static_cast<const btManifoldPoint*>(normal.m_originalContactPoint);
  const double left = (kNoFriction + point.getDistance()) / (kNoFriction - kFullFriction);
  return row.m_friction * std::clamp(left, 0.0, 1.0);
}

Eigen::Index RoundedUpToFour(std::size_t count) {
  return static_cast<Eigen::Index>((count + 3) / 4 * 4);
}

}  // namespace

bool RowSolver::Supports(int constraint_count) const {
  bool known = constraint_count == 0 &&
               m_multiBodyTorsionalFrictionContactConstraints.size() == 0 &&
               m_multiBodySpinningFrictionContactConstraints.size() == 0 &&
               m_multiBodyFrictionContactConstraints.size() ==
                   2 * m_multiBodyNormalContactConstraints.size();
  for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i)
    known = known && m_tmpSolverBodyPool[i].internalGetInvMass().isZero();
  for (int i = 0; known && i < m_multiBodyFrictionContactConstraints.size(); ++i)
    known = m_multiBodyFrictionContactConstraints[i].m_frictionIndex == i / 2;
  return known;
}

void RowSolver::CollectRows() {
  rows_.clear();
  joint_rows_ = m_multiBodyNonContactConstraints.size();
  normal_rows_ = m_multiBodyNormalContactConstraints.size();
  for (const btMultiBodyConstraintArray* rows :
       {&m_multiBodyNonContactConstraints, &m_multiBodyNormalContactConstraints,
        &m_multiBodyFrictionContactConstraints})
    for (int i = 0; i < rows->size(); ++i) rows_.push_back(&(*rows)[i]);
  friction_.clear();
  for (int i = 0; i < normal_rows_; ++i) {
    const btMultiBodySolverConstraint& row = m_multiBodyFrictionContactConstraints[2 * i];
    friction_.push_back(deep_friction_ == DeepFriction::kFull
                            ? row.m_friction
                            : FadingFriction(m_multiBodyNormalContactConstraints[i], row));
  }
}

void RowSolver::AddBody(btMultiBody* body, int bullet_velocity) {
  if (body == nullptr) return;
  for (const Body& known : bodies_)
    if (known.body == body) return;
  const int first = body->hasFixedBase() ? 6 : 0;
  bodies_.push_back({body, bullet_velocity, first, body->getNumDofs() + 6 - first, dofs_});
  dofs_ += bodies_.back().dofs;
}

void RowSolver::CollectBodies() {
  bodies_.clear();
  dofs_ = 0;
  for (const btMultiBodySolverConstraint* row : rows_) {
    AddBody(row->m_multiBodyA, row->m_deltaVelAindex);
    AddBody(row->m_multiBodyB, row->m_deltaVelBindex);
  }
}

// Adds, since a gear between two joints has the same body on both sides.
void RowSolver::FillSide(int row, const btMultiBody* body, int bullet_values) {
  if (body == nullptr) return;
  const auto at = std::find_if(bodies_.begin(), bodies_.end(),
                               [body](const Body& known) { return known.body == body; });
  const int from = bullet_values + at->first_dof;
  for (int i = 0; i < at->dofs; ++i) {
    jacobian_(row, at->column + i) += m_data.m_jacobians[from + i];
    response_(at->column + i, row) += m_data.m_deltaVelocitiesUnitImpulse[from + i];
  }
}

// want = right side - inverse diagonal * (J v) - softness * impulse, and how impulses change it
void RowSolver::BuildDelassus() {
  const auto count = static_cast<int>(rows_.size());
  const Eigen::Index padded = RoundedUpToFour(rows_.size());
  jacobian_.setZero(padded, dofs_);
  response_.setZero(dofs_, count);
  coupling_.setZero(padded, count);
  residual_.setZero(padded);
  impulse_.resize(count);
  for (int i = 0; i < count; ++i) {
    const btMultiBodySolverConstraint& row = *rows_[static_cast<std::size_t>(i)];
    FillSide(i, row.m_multiBodyA, row.m_jacAindex);
    FillSide(i, row.m_multiBodyB, row.m_jacBindex);
    jacobian_.row(i) *= row.m_jacDiagABInv;
    impulse_[i] = row.m_appliedImpulse;
    residual_[i] = row.m_rhs - row.m_cfm * impulse_[i];
  }
  for (const Body& at : bodies_)
    for (int i = 0; i < at.dofs; ++i)
      SubtractScaled(residual_.data(), jacobian_.col(at.column + i).data(),
                     m_data.m_deltaVelocities[at.bullet_velocity + at.first_dof + i], padded);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < dofs_; ++k)
      if (response_(k, i) != 0)
        SubtractScaled(coupling_.col(i).data(), jacobian_.col(k).data(), -response_(k, i), padded);
    coupling_(i, i) += rows_[static_cast<std::size_t>(i)]->m_cfm;
  }
  start_impulse_ = impulse_;
}

void RowSolver::ApplyImpulse(int row, double change) {
  if (change == 0) return;
  impulse_[row] += change;
  SubtractScaled(residual_.data(), coupling_.col(row).data(), change, residual_.size());
}

void RowSolver::SolveRow(int row) {
  const btMultiBodySolverConstraint& limits = *rows_[static_cast<std::size_t>(row)];
  const double wanted = impulse_[row] + residual_[row];
  ApplyImpulse(row, std::clamp(wanted, limits.m_lowerLimit, limits.m_upperLimit) - impulse_[row]);
}

// Coulomb's cone: both directions are solved before either is applied, and shortened together.
void RowSolver::SolveFrictionPair(int first) {
  const btMultiBodySolverConstraint& row = *rows_[static_cast<std::size_t>(first)];
  const double most = friction_[static_cast<std::size_t>(row.m_frictionIndex)] *
                      impulse_[joint_rows_ + row.m_frictionIndex];
  double along = impulse_[first] + residual_[first];
  double across = impulse_[first + 1] + residual_[first + 1];
  const double squared = along * along + across * across;
  if (squared > most * most) {
    const double factor = most / std::sqrt(squared);
    along *= factor;
    across *= factor;
  }
  ApplyImpulse(first, along - impulse_[first]);
  ApplyImpulse(first + 1, across - impulse_[first + 1]);
}

void RowSolver::Iterate(int iteration) {
  // joints forwards and backwards in turn, as Bullet does
  for (int i = 0; i < joint_rows_; ++i) SolveRow(iteration % 2 == 1 ? i : joint_rows_ - 1 - i);
  const int friction = joint_rows_ + normal_rows_;
  for (int i = joint_rows_; i < friction; ++i) SolveRow(i);
  for (int i = friction; i < static_cast<int>(rows_.size()); i += 2) SolveFrictionPair(i);
}

void RowSolver::WriteBack() {
  velocity_delta_.setZero(dofs_);
  for (int i = 0; i < static_cast<int>(rows_.size()); ++i) {
    rows_[static_cast<std::size_t>(i)]->m_appliedImpulse = impulse_[i];
    velocity_delta_ += response_.col(i) * (impulse_[i] - start_impulse_[i]);
  }
  for (const Body& at : bodies_) {
    const auto first = static_cast<std::size_t>(at.first_dof);
    change_.assign(first + static_cast<std::size_t>(at.dofs), 0.0);
    for (int i = 0; i < at.dofs; ++i) {
      change_[first + static_cast<std::size_t>(i)] = velocity_delta_[at.column + i];
      m_data.m_deltaVelocities[at.bullet_velocity + at.first_dof + i] +=
          velocity_delta_[at.column + i];
    }
    at.body->applyDeltaVeeMultiDof2(change_.data(), 1);
    at.body->setPosUpdated(false);
  }
}

btScalar RowSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer) {
  if (!Supports(constraint_count))
    return btMultiBodyConstraintSolver::solveGroupCacheFriendlyIterations(
        bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
  CollectRows();
  CollectBodies();
  BuildDelassus();
  for (int i = 0; i < info.m_numIterations; ++i) Iterate(i);
  WriteBack();
  return 0;
}

}  // namespace doorforge::internal
