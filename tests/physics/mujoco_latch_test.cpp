// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A second opinion on how a latched door moves: MuJoCo loads the exported URDF and is given the
// paper's law anew, at a step thirty times finer.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "doorforge/door/export_urdf.h"
#include "doorforge/physics/opening_trial.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Sample {
  double time_s;
  double hinge_rad;
};

class LawInMuJoCo {
 public:
  LawInMuJoCo(const DoorAsset& door, const fs::path& urdf) : door_(door) {
    std::array<char, 1000> error{};
    model_ = mj_loadXML(urdf.c_str(), nullptr, error.data(), static_cast<int>(error.size()));
    if (model_ == nullptr) throw std::runtime_error(error.data());
    model_->opt.timestep = 1.0 / 7200;
    std::fill_n(model_->opt.gravity, 3, 0);
    model_->opt.disableflags |= mjDSBL_CONTACT;
    data_ = mj_makeData(model_);
    hinge_ = JointId("hinge");
    handle_ = JointId("handle_joint");
  }
  ~LawInMuJoCo() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  LawInMuJoCo(const LawInMuJoCo&) = delete;
  LawInMuJoCo& operator=(const LawInMuJoCo&) = delete;

  // F = 150 against opening while theta_h <= threshold and the door is closed, else k1 theta_d;
  // k2 theta_h at the handle
  void Step(double pull_nm, double turn_nm) {
    const Latch& latch = door_.latch;
    if (Angle(handle_) >= latch.handle_done_angle_rad) done_ = true;
    const bool closed = Angle(hinge_) < 0.01 || locked_;
    locked_ = latch.type != LatchType::kNone && Angle(handle_) <= latch.unlock_angle_rad && closed;
    const double law = locked_ ? std::max(-latch.lock_effort_nm, -pull_nm)  // the stop bears it
                               : -latch.hinge_spring_nm_per_rad * Angle(hinge_);
    Torque(hinge_) = pull_nm + law;
    if (handle_ >= 0) Torque(handle_) = turn_nm - latch.handle_spring_nm_per_rad * Angle(handle_);
    mj_step(model_, data_);
  }

  double hinge_rad() const { return Angle(hinge_); }
  double time_step_s() const { return model_->opt.timestep; }
  bool done() const { return done_; }

 private:
  int JointId(const char* name) const { return mj_name2id(model_, mjOBJ_JOINT, name); }
  double Angle(int joint) const { return joint < 0 ? 0 : data_->qpos[model_->jnt_qposadr[joint]]; }
  double& Torque(int joint) { return data_->qfrc_applied[model_->jnt_dofadr[joint]]; }

  const DoorAsset& door_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  int hinge_ = -1;
  int handle_ = -1;
  bool locked_ = false;
  bool done_ = false;
};

double ArmOf(const DoorAsset& door) {
  const Eigen::Vector3d grasp =
      door.handle_joint.parent_from_child_at_zero * door.handle_from_grasp.translation();
  return grasp.head<2>().norm();  // the hinge is vertical
}

// The hinge after the handle was turned until it was done, pulled as OpeningTrial says.
std::vector<Sample> Opening(const DoorAsset& door, const fs::path& urdf,
                            const OpeningTrialConfig& config) {
  LawInMuJoCo world(door, urdf);
  const bool latched = door.latch.type != LatchType::kNone;
  const double dt = world.time_step_s();
  double turning = 0;
  const auto turn = [&] {
    if (!world.done()) turning += dt;
    return latched ? config.handle_torque_nm * std::min(turning, 1.0) : 0;
  };
  for (int i = 0; latched && !world.done() && i < 20000; ++i) world.Step(0, turn());
  std::vector<Sample> samples;
  for (double time = dt; time < 5 && world.hinge_rad() < config.open_rad; time += dt) {
    world.Step(config.pull_n * ArmOf(door) * std::min(time, 1.0), turn());
    samples.push_back({time, world.hinge_rad()});
  }
  return samples;
}

double AngleAt(const std::vector<Sample>& samples, double time_s) {
  const auto after = std::find_if(samples.begin(), samples.end(),
                                  [&](const Sample& sample) { return sample.time_s >= time_s; });
  return after == samples.end() ? samples.back().hinge_rad : after->hinge_rad;
}

TEST(LatchedDoor, OpensOverTimeAsInMuJoCo) {
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone}) {
    for (std::uint64_t i = 0; i < 4; ++i) {
      const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(mechanism, 5, i));
      const fs::path folder = fs::path(testing::TempDir()) / "latched_door_in_mujoco";
      WriteDoorFolder(door, folder, Existing::kReplace);
      OpeningTrialConfig config;
      config.pull_n = 20;
      const std::vector<Sample> samples = Opening(door, folder / "model.urdf", config);
      ASSERT_GE(samples.back().hinge_rad, config.open_rad);
      for (const double angle : {0.2, 0.4, 0.6, 0.78}) {
        config.open_rad = angle;
        const OpeningTrial trial = TryOpening(door, config);
        const double expected = AngleAt(samples, trial.opened_s);
        EXPECT_NEAR(trial.opened_rad, expected, 0.05 * expected)
            << NameOf(mechanism) << ' ' << i << " at " << trial.opened_s << " s";
      }
      fs::remove_all(folder);
    }
  }
}

TEST(LatchedDoor, StaysShutInMuJoCoUnderOneAndAHalfTimesThePull) {
  const DoorAsset door = MakePrimitiveDoor({});
  const fs::path folder = fs::path(testing::TempDir()) / "shut_door_in_mujoco";
  WriteDoorFolder(door, folder, Existing::kReplace);
  LawInMuJoCo world(door, folder / "model.urdf");
  const OpeningTrialConfig config;
  // a torque that comes at once turns the handle twice as far as the spring alone would let it
  for (int i = 0; i < 7200; ++i)
    world.Step(config.overload * config.pull_n * ArmOf(door),
               0.4 * door.latch.handle_spring_nm_per_rad * door.latch.unlock_angle_rad);
  EXPECT_LT(world.hinge_rad(), 0.01);
  EXPECT_TRUE(TryOpening(door, config).held);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace doorforge
