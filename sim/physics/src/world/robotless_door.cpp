// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/robotless_door.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include "collision/row_solver.h"
#include "world/door_body.h"

namespace doorforge {
namespace {

constexpr double kFastestRadS = 90;  // Bullet cuts at 100

}  // namespace

class RobotlessDoor::Runtime {
 public:
  Runtime(const DoorAsset& door, double time_step_s) : time_step_s_(time_step_s) {
    RequireSimulatable(door, "door alone");
    internal::SwitchProfilingOff();
    world_.setGravity(btVector3(0, 0, 0));
    world_.getSolverInfo().m_numIterations = 50;
    world_.getSolverInfo().m_globalCfm = 0;
    body_ = std::make_unique<internal::DoorBody>(world_, RigidTransform::Identity(), door,
                                                 door.latch, 1);
  }

  void Step(double hinge_nm, double handle_nm) {
    body_->ApplyTorques(hinge_nm, handle_nm, time_step_s_);
    world_.stepSimulation(time_step_s_, 0);
    body_->UpdateLatch();
  }

  const internal::DoorBody& body() const { return *body_; }

 private:
  double time_step_s_;
  btDefaultCollisionConfiguration collision_configuration_;
  btCollisionDispatcher dispatcher_{&collision_configuration_};
  btDbvtBroadphase broadphase_;
  internal::RowSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &collision_configuration_};
  std::unique_ptr<internal::DoorBody> body_;
};

RobotlessDoor::RobotlessDoor(const DoorAsset& door, double time_step_s)
    : runtime_(std::make_unique<Runtime>(door, time_step_s)) {}
RobotlessDoor::~RobotlessDoor() = default;
RobotlessDoor::RobotlessDoor(RobotlessDoor&&) noexcept = default;
RobotlessDoor& RobotlessDoor::operator=(RobotlessDoor&&) noexcept = default;

void RobotlessDoor::Step(double hinge_nm, double handle_nm) { runtime_->Step(hinge_nm, handle_nm); }

double RobotlessDoor::hinge_rad() const { return runtime_->body().hinge_rad(); }
double RobotlessDoor::hinge_rad_s() const { return runtime_->body().hinge_rad_s(); }
double RobotlessDoor::handle_rad() const { return runtime_->body().handle_rad(); }
double RobotlessDoor::handle_rad_s() const { return runtime_->body().handle_rad_s(); }
double RobotlessDoor::bolt_m() const { return runtime_->body().bolt_m(); }
const LatchState& RobotlessDoor::latch() const { return runtime_->body().latch(); }

bool RobotlessDoor::Finite() const {
  const double fastest = std::max(std::abs(hinge_rad_s()), std::abs(handle_rad_s()));
  return std::isfinite(hinge_rad()) && std::isfinite(handle_rad()) && std::isfinite(bolt_m()) &&
         fastest < kFastestRadS;
}

}  // namespace doorforge
