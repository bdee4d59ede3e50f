// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "mujoco/mujoco_library.h"

namespace doorforge::internal {

struct DeleteMujoco {
  void operator()(mjModel* model) const { Mujoco().delete_model(model); }
  void operator()(mjData* data) const { Mujoco().delete_data(data); }
};
using MujocoData = std::unique_ptr<mjData, DeleteMujoco>;

/// A model and its state, made from the text of an MJCF.
struct MujocoModel {
  /// Throws Error(kInvalidArgument) with MuJoCo's words if it does not take the text.
  explicit MujocoModel(const std::string& xml);

  MujocoData CopyOfData() const;

  /// Address of a joint's velocity, which is that of its position too, since all joints have one
  /// number; -1 without such a joint.
  int JointNamed(const std::string& name) const;
  int GeomNamed(const std::string& name) const;

  std::unique_ptr<mjModel, DeleteMujoco> model;
  MujocoData data;
};

}  // namespace doorforge::internal
