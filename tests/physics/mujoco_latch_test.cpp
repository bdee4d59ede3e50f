// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A second opinion on how a latched door moves. MuJoCo loads the exported URDF and is given the
// paper's law anew, at a step thirty times finer; and it simulates the exported MJCF, whose latch
// is hardware: bolt, strike, cable and spring.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <unistd.h>

#include "doorforge/exporters/export_door.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/physics/opening_trial.h"
#include "doorforge/physics/robotless_door.h"

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
std::vector<Sample> SamplesOf(const DoorAsset& door, const fs::path& urdf,
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
      const std::vector<Sample> samples = SamplesOf(door, folder / "model.urdf", config);
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

// ---- the exported hardware ----------------------------------------------------------------------

/// The MJCF of a door, without gravity, moved by torques alone.
class HardwareInMuJoCo {
 public:
  explicit HardwareInMuJoCo(const fs::path& mjcf) {
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(mjcf.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    if (!model_) throw std::runtime_error(error.data());
    model_->opt.timestep = 1.0 / 1920;
    std::fill_n(model_->opt.gravity, 3, 0);
    data_.reset(mj_makeData(model_.get()));
    hinge_ = mj_name2id(model_.get(), mjOBJ_JOINT, "hinge");
    handle_ = mj_name2id(model_.get(), mjOBJ_JOINT, "handle_joint");
  }

  void Step(double hinge_nm, double handle_nm) {
    data_->qfrc_applied[model_->jnt_dofadr[hinge_]] = hinge_nm;
    data_->qfrc_applied[model_->jnt_dofadr[handle_]] = handle_nm;
    mj_step(model_.get(), data_.get());
  }

  double hinge_rad() const { return data_->qpos[model_->jnt_qposadr[hinge_]]; }
  double handle_rad() const { return data_->qpos[model_->jnt_qposadr[handle_]]; }
  double handle_rad_s() const { return data_->qvel[model_->jnt_dofadr[handle_]]; }
  double time_step_s() const { return model_->opt.timestep; }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  int hinge_ = -1;
  int handle_ = -1;
};

/// This project's world behind the same face.
class HardwareHere : public RobotlessDoor {
 public:
  explicit HardwareHere(const DoorAsset& door) : RobotlessDoor(door) {}
  static double time_step_s() { return 1.0 / 240; }
};

/// One hand's experiments on either world.
template <class World>
class Trial {
 public:
  Trial(const DoorAsset& door, World& world) : door_(door), world_(world) {}

  // A hand that wants the handle there and knows its spring.
  double Turning(double angle) const {
    return door_.latch.handle_spring_nm_per_rad * angle + 15 * (angle - world_.handle_rad()) -
           0.06 * world_.handle_rad_s();
  }

  void Run(double hinge_nm, double handle_angle, double seconds) {
    for (long i = std::lround(seconds / world_.time_step_s()); i > 0; --i)
      world_.Step(hinge_nm, handle_angle > 0 ? Turning(handle_angle) : 0);
  }

  // Handle angle at which the loaded door gives way.
  double UnlockAngle() {
    constexpr double kPull = 10;    // [N m]
    constexpr double kTurn = 0.15;  // [rad/s]
    Run(kPull, 0, 0.3);
    double angle = 0;
    while (world_.hinge_rad() < 0.008 && angle < door_.handle_joint.upper_rad) {
      angle += kTurn * world_.time_step_s();
      world_.Step(kPull, Turning(angle));
    }
    return world_.handle_rad();
  }

  // Hinge angles every 1/48 s under a torque, the handle kept turned.
  std::vector<double> Opening(double torque_nm) {
    const double turned = 1.25 * door_.latch.unlock_angle_rad;
    Run(0, turned, 4);  // at rest on the stop, where the springs take it
    std::vector<double> angles;
    while (angles.size() < 300 && world_.hinge_rad() < 1) {
      Run(torque_nm, turned, 1.0 / 48);
      angles.push_back(world_.hinge_rad());
    }
    return angles;
  }

  // Opened, let go and pushed shut, what a pull then does.
  double AfterClosing() {
    const double turned = 1.25 * door_.latch.unlock_angle_rad;
    Run(0, turned, 0.5);
    for (int i = 0; i < 200 && world_.hinge_rad() < 0.25; ++i) Run(10, turned, 0.02);
    EXPECT_GT(world_.hinge_rad(), 0.2);
    for (int i = 0; i < 400 && world_.hinge_rad() > 0.003; ++i) Run(-10, 0, 0.02);
    Run(-10, 0, 0.5);
    Run(20, 0, 1);
    return world_.hinge_rad();
  }

 private:
  const DoorAsset& door_;
  World& world_;
};

/// A door and its exported files.
struct ExportedDoor {
  explicit ExportedDoor(DoorAsset asset)
      : door(std::move(asset)),
        // tests of this program run side by side
        folder(fs::path(testing::TempDir()) / ("latch_hardware_" + std::to_string(::getpid()))) {
    const std::array formats = {*DoorFormatNamed("mjcf")};
    WriteExportedDoor(door, formats, folder, Existing::kReplace);
  }
  ~ExportedDoor() { fs::remove_all(folder); }
  ExportedDoor(const ExportedDoor&) = delete;
  ExportedDoor& operator=(const ExportedDoor&) = delete;

  fs::path mjcf() const { return folder / "model.xml"; }

  DoorAsset door;
  fs::path folder;
};

// Lever, round and a small cupboard's knob; hinged left and right, pulled and pushed.
std::vector<PrimitiveDoor> Shapes() {
  std::vector<PrimitiveDoor> shapes;
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      PrimitiveDoor lever{.hinge_side = side, .opening = opening};
      PrimitiveDoor round{.mechanism = Mechanism::kRound, .hinge_side = side, .opening = opening};
      PrimitiveDoor cupboard = round;
      cupboard.width_m = 0.4;
      cupboard.height_m = 0.7;
      cupboard.leaf_mass_kg = 4;
      cupboard.handle_height_m = 0.35;
      shapes.insert(shapes.end(), {lever, round, cupboard});
    }
  }
  return shapes;
}

DoorAsset WithLatch(const PrimitiveDoor& shape, LatchType type) {
  DoorAsset door = MakePrimitiveDoor(shape);
  door.id = std::string(NameOf(shape.mechanism)) + "-" + std::string(NameOf(shape.hinge_side)) +
            "-" + std::string(NameOf(shape.opening)) + "-" + std::string(NameOf(type));
  door.latch.type = type;
  door.links[kBaseLink].mass = {1, Eigen::Vector3d::Zero(), 0.01 * Eigen::Matrix3d::Identity()};
  if (type == LatchType::kBolt) door.latch.bolt_throw_m = 0.012;
  return door;
}

class LatchHardware : public testing::TestWithParam<LatchType> {
 protected:
  // Calls check(door, hardware in MuJoCo, this project's world) on every shape.
  template <class Check>
  void OnEveryDoor(const Check& check) {
    for (const PrimitiveDoor& shape : Shapes()) {
      const ExportedDoor exported(WithLatch(shape, GetParam()));
      SCOPED_TRACE(exported.door.id + " of " + std::to_string(shape.width_m) + " m");
      HardwareInMuJoCo there(exported.mjcf());
      HardwareHere here(exported.door);
      check(exported.door, there, here);
    }
  }
};

TEST_P(LatchHardware, HoldsOneAndAHalfTimesThePullInBothWorlds) {
  OnEveryDoor([](const DoorAsset& door, HardwareInMuJoCo& there, HardwareHere& here) {
    const OpeningTrialConfig config;
    const double torque = config.overload * config.pull_n * ArmOf(door);
    Trial(door, there).Run(torque, 0, 1);
    Trial(door, here).Run(torque, 0, 1);
    EXPECT_LT(there.hinge_rad(), 0.01);
    EXPECT_LT(here.hinge_rad(), 0.01);
  });
}

TEST_P(LatchHardware, UnlocksWithinTwoDegreesOfTheSameAngle) {
  constexpr double kTwoDegrees = 0.0349;
  OnEveryDoor([](const DoorAsset& door, HardwareInMuJoCo& there, HardwareHere& here) {
    const double in_mujoco = Trial(door, there).UnlockAngle();
    const double in_this = Trial(door, here).UnlockAngle();
    EXPECT_NEAR(in_mujoco, in_this, kTwoDegrees);
    EXPECT_NEAR(in_mujoco, door.latch.unlock_angle_rad, kTwoDegrees);
    EXPECT_NEAR(in_this, door.latch.unlock_angle_rad, kTwoDegrees);
    RecordProperty("unlock_" + door.id, std::to_string(in_mujoco) + " " + std::to_string(in_this));
  });
}

TEST_P(LatchHardware, OpensOverTimeWithinFivePercent) {
  OnEveryDoor([](const DoorAsset& door, HardwareInMuJoCo& there, HardwareHere& here) {
    const double torque = 2.5 * ArmOf(door) / 0.3;
    const std::vector<double> in_mujoco = Trial(door, there).Opening(torque);
    const std::vector<double> in_this = Trial(door, here).Opening(torque);
    ASSERT_GE(in_mujoco.back(), 1);
    ASSERT_GE(in_this.back(), 0.95);
    double worst = 0;
    for (std::size_t i = 0; i < std::min(in_mujoco.size(), in_this.size()); ++i) {
      if (in_mujoco[i] > 0.15) worst = std::max(worst, std::abs(in_this[i] / in_mujoco[i] - 1));
    }
    EXPECT_LT(worst, 0.05);
    RecordProperty("worst_" + door.id, std::to_string(worst));
  });
}

INSTANTIATE_TEST_SUITE_P(EffortAndBolt, LatchHardware,
                         testing::Values(LatchType::kEffort, LatchType::kBolt),
                         [](const auto& tested) { return std::string(NameOf(tested.param)); });

TEST(Bolt, CatchesAgainInBothWorldsWhenPushedShut) {
  for (const PrimitiveDoor& shape : Shapes()) {
    const ExportedDoor exported(WithLatch(shape, LatchType::kBolt));
    SCOPED_TRACE(exported.door.id);
    HardwareInMuJoCo there(exported.mjcf());
    HardwareHere here(exported.door);
    EXPECT_LT(Trial(exported.door, there).AfterClosing(), 0.01);
    EXPECT_LT(Trial(exported.door, here).AfterClosing(), 0.01);
  }
}

}  // namespace
}  // namespace doorforge
