// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include <mujoco/mujoco.h>

#include "doorforge/core/rigid_transform.h"

namespace doorforge {

/// A composed door's URDF loaded by MuJoCo, a second opinion on geometry and masses.
class MuJoCoDoor {
 public:
  explicit MuJoCoDoor(const std::filesystem::path& urdf) {
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(urdf.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    error_ = error.data();
    if (model_) data_.reset(mj_makeData(model_.get()));
  }

  bool ok() const { return model_ != nullptr; }
  const std::string& error() const { return error_; }
  int joint_count() const { return model_->njnt; }

  double MassOf(const std::string& link) const {
    return model_->body_mass[mj_name2id(model_.get(), mjOBJ_BODY, link.c_str())];
  }

  /// Of leaf and handle in the world.
  std::array<RigidTransform, 2> LinkPoses(double hinge, double handle) const {
    SetAngle("hinge", hinge);
    SetAngle("handle_joint", handle);
    mj_kinematics(model_.get(), data_.get());
    return {PoseOf("leaf"), PoseOf("handle")};
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  void SetAngle(const char* joint, double angle) const {
    const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint);
    if (id >= 0) data_->qpos[model_->jnt_qposadr[id]] = angle;
  }

  RigidTransform PoseOf(const char* link) const {
    const int id = mj_name2id(model_.get(), mjOBJ_BODY, link);
    RigidTransform pose = RigidTransform::Identity();
    pose.translation() = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * id);
    pose.linear() =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * id);
    return pose;
  }

  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::string error_;
};

}  // namespace doorforge
