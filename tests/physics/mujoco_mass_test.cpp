// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A second opinion on the inertia in the space of the joints: MuJoCo's of the same URDF.

#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "doorforge/core/rng.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/mass_matrix.h"

#include "box_arm.h"

namespace doorforge {
namespace {

TEST(MassMatrix, IsThatOfMuJoCo) {
  const UrdfModel urdf = BoxArm();
  const RobotModel robot = BuildRobot(urdf, {}, RobotBase::kFixed);
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "box_arm_in_mujoco.urdf";
  std::ofstream(path) << ToUrdf(urdf);
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(path.c_str(), nullptr, error.data(), static_cast<int>(error.size()));
  ASSERT_NE(model, nullptr) << error.data();
  mjData* data = mj_makeData(model);
  ASSERT_EQ(model->nv, robot.joint_count());
  std::filesystem::remove(path);

  for (int pose = 0; pose < 10; ++pose) {
    Rng rng(3, "mass/" + std::to_string(pose));
    JointVector position(robot.joint_count());
    std::vector<int> place;
    for (int i = 0; i < robot.joint_count(); ++i) {
      const RobotJoint& joint = robot.joint(i);
      position[i] = rng.Uniform(joint.lower, joint.upper);
      const int id = mj_name2id(model, mjOBJ_JOINT, joint.name.c_str());
      ASSERT_GE(id, 0) << joint.name;
      // fingers of this robot count from their closed end, the other way round
      const double upper = model->jnt_range[2 * id + 1];
      data->qpos[model->jnt_qposadr[id]] =
          i < robot.arm_count() ? position[i] : upper - position[i];
      place.push_back(model->jnt_dofadr[id]);
    }
    mj_forward(model, data);
    const auto count = static_cast<std::size_t>(model->nv);
    std::vector<mjtNum> full(count * count);
    mj_fullM(model, full.data(), data->qM);
    const JointMatrix matrix =
        MassMatrix(robot, robot.PoseAt(position, RigidTransform::Identity()));
    for (int i = 0; i < robot.joint_count(); ++i) {
      for (int j = 0; j < robot.joint_count(); ++j) {
        const bool turned = (i < robot.arm_count()) != (j < robot.arm_count());
        const double theirs = full[static_cast<std::size_t>(
            place[static_cast<std::size_t>(i)] * model->nv + place[static_cast<std::size_t>(j)])];
        EXPECT_NEAR(matrix(i, j), turned ? -theirs : theirs, 1e-9) << i << ' ' << j;
      }
    }
  }
  mj_deleteData(data);
  mj_deleteModel(model);
}

}  // namespace
}  // namespace doorforge
