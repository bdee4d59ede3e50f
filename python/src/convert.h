// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <pybind11/eval.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "doorforge/core/config_io.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/grasp_policy.h"
#include "doorforge/schemas/policy.h"

// What Python's values are in C++ and the other way round. Arrays are copied: nothing that Python
// holds refers to memory of a simulated world.

namespace doorforge::python {

namespace py = pybind11;

/// Dicts, lists and numbers of a JSON document.
py::object ToPython(const nlohmann::ordered_json& json);
/// The JSON document of dicts, lists, numbers, texts, None and numpy's scalars. Throws
/// Error(kInvalidConfig) that names `what` on anything else.
nlohmann::ordered_json FromPython(const py::object& value, const std::string& what);

/// A config from a dict of the settings that differ from the defaults; None: none does. Throws
/// Error(kInvalidConfig) as Assign(), with `what` in front.
template <class T>
T ConfigFrom(const py::object& settings, const std::string& what, T config = {}) {
  if (!settings.is_none()) Assign(FromPython(settings, what), config, what);
  return config;
}

/// float64 (3,).
py::array_t<double> ToPython(const Eigen::Vector3d& vector);
/// float64 (rows, 3), in row order.
py::array_t<double> ToPython(const Eigen::Matrix3d& matrix);
/// float64 (4, 4).
py::array_t<double> ToPython(const RigidTransform& transform);
/// Vertices float64 (V, 3) [m] and triangles int32 (T, 3).
py::tuple ToPython(const TriangleMesh& mesh);

/// A copy with the given shape.
template <class T>
py::array_t<T> ArrayOf(const T* values, std::vector<py::ssize_t> shape) {
  py::array_t<T> array(std::move(shape));
  std::copy_n(values, static_cast<std::size_t>(array.size()), array.mutable_data());
  return array;
}

/// An action from nine finite numbers, see Action. Throws Error(kInvalidArgument) that begins with
/// `what` on another shape or on a number that is not finite.
Action ActionFrom(const py::object& value, const std::string& what);

/// The stage of a name. Throws Error(kInvalidArgument) on another.
Stage StageOf(const std::string& name);

/// Points in the world [m] from an array (points, 3). Throws Error(kInvalidArgument) that begins
/// with `what` on another.
LabelledCloud CloudFrom(const py::object& value, const std::string& what);

/// What a policy is shown.
struct ShownObservation : Observation {
  bool is_joined = false;  ///< The cloud holds what was seen before the robot came.
};

/// An observation from a dict with "proprioception" and, for those who look, "cloud",
/// "cloud_label" and "remembered", whether it is joined. Throws Error(kInvalidArgument) on arrays
/// of another shape.
ShownObservation ObservationFrom(const py::dict& values);

/// The dict that policies in Python are called with: those of the names that `names` has.
py::dict ToPython(const Observation& observation, const std::vector<std::string>& names);
/// The dict that graspers in Python are called with: "cloud" float32 (points, 3) [m, world],
/// "cloud_label" uint8 (points,), "approach" float64 (3,), "hand_from_tcp" float64 (4, 4),
/// "episode" text.
py::dict ToPython(const GraspObservation& observation);
/// The names that ToPython() knows. Throws Error(kInvalidArgument), with the names that there are,
/// if one of `names` is none of them.
void RequireObservationNames(const std::vector<std::string>& names);

/// Runs `body`, which may not touch Python, while other threads of Python go on. On the main thread
/// Ctrl-C then stops what asks StopRequested(), and comes out as KeyboardInterrupt.
void RunLong(const std::function<void()>& body);

template <class Body>
auto Long(Body&& body) {
  std::optional<decltype(body())> result;
  RunLong([&] { result.emplace(body()); });
  return std::move(*result);
}

}  // namespace doorforge::python
