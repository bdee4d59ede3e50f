// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge::python {

/// A door as Python holds it: a value that nothing changes.
struct Door {
  std::shared_ptr<const DoorAsset> asset;
};

/// A robot as Python holds it.
struct Robot {
  std::shared_ptr<const RobotModel> model;
};

// Each adds the classes and functions of its subject to the module.
void BindErrors(pybind11::module_& module);
void BindDoors(pybind11::module_& module);
void BindScenes(pybind11::module_& module);
void BindStepper(pybind11::module_& module);
void BindLatch(pybind11::module_& module);
void BindPolicies(pybind11::module_& module);
void BindEvaluation(pybind11::module_& module);

}  // namespace doorforge::python
