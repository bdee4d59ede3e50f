// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "doorforge/schemas/grasp_policy.h"
#include "doorforge/schemas/policy.h"

namespace doorforge::python {

/// What of somebody's policy in Python is called, and with what.
struct CallableSettings {
  pybind11::object policy;         ///< Called with a dict of arrays, gives nine numbers.
  std::vector<std::string> names;  ///< The arrays have them, see RequireObservationNames().
  std::string name;                ///< For messages, such as "opener".
};

/// Copies of it leave Python's counts of references alone, so that threads without Python's lock
/// may hold and let go of it.
using SharedCallable = std::shared_ptr<const CallableSettings>;
SharedCallable Share(CallableSettings settings);

/// A policy whose actions a function or object of Python gives; it is Fallible. `reset()` of the
/// object is called at the beginning of each episode if it has one. Takes Python's lock for its
/// calls, and may be made and destroyed with or without it.
std::unique_ptr<Policy> MakeCallablePolicy(SharedCallable settings);

/// This one takes hold: called once an episode, with what ToPython() of a GraspObservation
/// gives, for the contact [m, world] and two rows of world_from_hand, or None. `names` are not
/// read.
std::unique_ptr<GraspPolicy> MakeCallableGrasp(SharedCallable settings);

}  // namespace doorforge::python
