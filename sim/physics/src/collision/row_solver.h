// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <Eigen/Core>

namespace doorforge::internal {

/// Friction of contacts that overlap by more than 3 mm: fades, to none at 6 mm; or Bullet's.
enum class DeepFriction { kFades, kFull };

/// Bullet's projected Gauss-Seidel iterations with the rows' effect on each other worked out once a
/// step (the Delassus matrix) instead of by way of the joints' velocities in each iteration: the
/// same rows in the same order with the same clamping, so that the result is Bullet's but for
/// rounding, in a small part of the time; and but for the friction of deep contacts, unless that is
/// to be full. Groups with rows of other kinds than it knows (rolling friction, bodies that are no
/// multibodies) are left to Bullet. Deterministic.
class RowSolver : public btMultiBodyConstraintSolver {
 public:
  explicit RowSolver(DeepFriction deep_friction = DeepFriction::kFades)
      : deep_friction_(deep_friction) {}

 protected:
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* drawer) override;

 private:
  struct Body {
    btMultiBody* body;
    int bullet_velocity;  // where Bullet keeps its change of velocity
    int first_dof, dofs;  // of its velocities, those that can move
    int column;           // where they stand in jacobian_ and response_
  };

  bool Supports(int constraint_count) const;
  void CollectRows();
  void CollectBodies();
  void AddBody(btMultiBody* body, int bullet_velocity);
  void FillSide(int row, const btMultiBody* body, int bullet_values);
  void BuildDelassus();
  void ApplyImpulse(int row, double change);
  void SolveRow(int row);
  void SolveFrictionPair(int first);
  void Iterate(int iteration);
  void WriteBack();

  DeepFriction deep_friction_;
  // joints, then contacts' normals, then friction in pairs
  std::vector<const btMultiBodySolverConstraint*> rows_;
  int joint_rows_ = 0;
  int normal_rows_ = 0;
  std::vector<double> friction_;  // of each normal's pair
  std::vector<Body> bodies_;
  int dofs_ = 0;
  Eigen::MatrixXd jacobian_;  // row, padded to a multiple of four, x joint velocity
  Eigen::MatrixXd response_;  // joint velocity x row, of a unit impulse
  Eigen::MatrixXd coupling_;  // column i: what a unit impulse on row i takes from all wants
  Eigen::VectorXd residual_;  // impulse that each row still lacks
  Eigen::VectorXd impulse_;
  Eigen::VectorXd start_impulse_;
  Eigen::VectorXd velocity_delta_;  // joint velocities, by the iterations
  std::vector<double> change_;      // one body's, with its base
};

}  // namespace doorforge::internal
