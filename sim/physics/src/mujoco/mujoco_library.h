// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace doorforge::internal {

/// The functions of libmujoco that are used here. The library is opened by the first who asks, not
/// linked: programs that simulate nothing in it do not load it.
struct MujocoLibrary {
  decltype(&::mj_version) version;
  decltype(&::mj_defaultVFS) default_vfs;
  decltype(&::mj_makeEmptyFileVFS) make_empty_file_vfs;
  decltype(&::mj_findFileVFS) find_file_vfs;
  decltype(&::mj_deleteVFS) delete_vfs;
  decltype(&::mj_loadXML) load_xml;
  decltype(&::mj_deleteModel) delete_model;
  decltype(&::mj_makeData) make_data;
  decltype(&::mj_copyData) copy_data;
  decltype(&::mj_deleteData) delete_data;
  decltype(&::mj_name2id) name_to_id;
  decltype(&::mj_kinematics) kinematics;
  decltype(&::mj_comPos) com_pos;
  decltype(&::mj_tendon) tendon;
  decltype(&::mj_crb) crb;
  decltype(&::mj_factorM) factor_m;
  decltype(&::mj_collision) collision;
  decltype(&::mj_makeConstraint) make_constraint;
  decltype(&::mj_transmission) transmission;
  decltype(&::mj_projectConstraint) project_constraint;
  decltype(&::mj_fwdVelocity) forward_velocity;
  decltype(&::mj_fwdActuation) forward_actuation;
  decltype(&::mj_fwdAcceleration) forward_acceleration;
  decltype(&::mj_fwdConstraint) forward_constraint;
  decltype(&::mj_Euler) euler;
  decltype(&::mj_mulM) multiply_mass;
  decltype(&::mj_contactForce) contact_force;
};

/// Throws Error(kInvalidConfig) where the library cannot be opened or is another version than its
/// headers were. What MuJoCo itself calls an error is thrown, too; its warnings, which it would
/// write into a file, are left to the watch over each step.
const MujocoLibrary& Mujoco();

}  // namespace doorforge::internal
