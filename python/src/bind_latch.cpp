// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The latch's law in C++ and the bolt's measures, by which doorforge.latch is tested.

#include "doorforge/physics/latch_law.h"
#include "doorforge/schemas/bolt.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {

void BindLatch(py::module_& module) {
  module.def("latch_step", [](const Latch& latch, bool locked, bool handle_done, double hinge_rad,
                              double handle_rad) {
    const LatchState after = UpdatedLatch(latch, {locked, handle_done}, hinge_rad, handle_rad);
    const LatchTorques torques = TorquesOf(latch, after, hinge_rad, handle_rad);
    return py::make_tuple(after.locked, after.handle_done, torques.hinge_nm, torques.handle_nm);
  });
  module.def("bolt_of", [](const Door& door) {
    const Bolt bolt = BoltOf(*door.asset);
    py::dict dict;
    dict["throw_m"] = bolt.throw_m;
    dict["travel_m"] = bolt.travel_m;
    dict["clearance_m"] = bolt.clearance_m;
    dict["play_m"] = bolt.play_m;
    dict["travel_m_per_rad"] = bolt.travel_m_per_rad;
    dict["tip_in_leaf_m"] = ToPython(Eigen::Vector3d(bolt.leaf_from_bolt * bolt.tip_m));
    dict["bolt_axis_in_leaf"] = ToPython(Eigen::Vector3d(bolt.leaf_from_bolt.linear().col(1)));
    dict["base_from_strike"] = ToPython(bolt.base_from_strike);
    return dict;
  });
  module.def("bolt_is_caught", [](const Door& door, double hinge_rad, double position_m) {
    return IsCaught(BoltOf(*door.asset), *door.asset, hinge_rad, position_m);
  });
}

}  // namespace doorforge::python
