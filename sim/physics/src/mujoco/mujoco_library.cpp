// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mujoco/mujoco_library.h"

#include <string>

#include <dlfcn.h>

#include "doorforge/core/error.h"

#include "world/world_engine.h"

namespace doorforge::internal {
namespace {

constexpr const char* kHelp =
    "; install libmujoco-dev and configure again, or leave scene.physics.simulator at bullet";

void ThrowMujocoError(const char* message) {
  throw Error(ErrorCode::kInvalidArgument, std::string("MuJoCo: ") + message);
}

void IgnoreMujocoWarning(const char* /*message*/) {}

void* OpenLibrary() {
  void* library = ::dlopen(DOORFORGE_MUJOCO_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  Require(library != nullptr, ErrorCode::kInvalidConfig,
          std::string("simulator mujoco: ") + DOORFORGE_MUJOCO_LIBRARY +
              " is not installed on this machine" + kHelp);
  return library;
}

template <class Function>
void Find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  Require(function != nullptr, ErrorCode::kInvalidConfig,
          std::string("simulator mujoco: ") + DOORFORGE_MUJOCO_LIBRARY + " has no " + name + kHelp);
}

void FindLoading(void* library, MujocoLibrary& functions) {
  Find(library, "mj_version", functions.version);
  Find(library, "mj_defaultVFS", functions.default_vfs);
  Find(library, "mj_makeEmptyFileVFS", functions.make_empty_file_vfs);
  Find(library, "mj_findFileVFS", functions.find_file_vfs);
  Find(library, "mj_deleteVFS", functions.delete_vfs);
  Find(library, "mj_loadXML", functions.load_xml);
  Find(library, "mj_deleteModel", functions.delete_model);
  Find(library, "mj_makeData", functions.make_data);
  Find(library, "mj_copyData", functions.copy_data);
  Find(library, "mj_deleteData", functions.delete_data);
  Find(library, "mj_name2id", functions.name_to_id);
}

void FindStepping(void* library, MujocoLibrary& functions) {
  Find(library, "mj_kinematics", functions.kinematics);
  Find(library, "mj_comPos", functions.com_pos);
  Find(library, "mj_tendon", functions.tendon);
  Find(library, "mj_crb", functions.crb);
  Find(library, "mj_factorM", functions.factor_m);
  Find(library, "mj_collision", functions.collision);
  Find(library, "mj_makeConstraint", functions.make_constraint);
  Find(library, "mj_transmission", functions.transmission);
  Find(library, "mj_projectConstraint", functions.project_constraint);
  Find(library, "mj_fwdVelocity", functions.forward_velocity);
  Find(library, "mj_fwdActuation", functions.forward_actuation);
  Find(library, "mj_fwdAcceleration", functions.forward_acceleration);
  Find(library, "mj_fwdConstraint", functions.forward_constraint);
  Find(library, "mj_Euler", functions.euler);
  Find(library, "mj_mulM", functions.multiply_mass);
  Find(library, "mj_contactForce", functions.contact_force);
}

MujocoLibrary Load() {
  void* library = OpenLibrary();
  MujocoLibrary functions{};
  FindLoading(library, functions);
  // the layout of its structures is that of the headers
  Require(functions.version() == mjVERSION_HEADER, ErrorCode::kInvalidConfig,
          std::string("simulator mujoco: ") + DOORFORGE_MUJOCO_LIBRARY + " is version " +
              std::to_string(functions.version()) + ", this build was made for " +
              std::to_string(mjVERSION_HEADER) + kHelp);
  FindStepping(library, functions);
  using Handler = void (*)(const char*);
  Handler* on_error = nullptr;
  Handler* on_warning = nullptr;
  Find(library, "mju_user_error", on_error);
  Find(library, "mju_user_warning", on_warning);
  *on_error = ThrowMujocoError;
  *on_warning = IgnoreMujocoWarning;
  return functions;
}

}  // namespace

const MujocoLibrary& Mujoco() {
  static const MujocoLibrary kLibrary = Load();
  return kLibrary;
}

bool BuiltWithMujoco() { return true; }

void RequireMujoco() { Mujoco(); }

}  // namespace doorforge::internal
