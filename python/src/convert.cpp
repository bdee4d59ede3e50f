// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convert.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/core/stop_signals.h"

namespace doorforge::python {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kActionNumbers = std::tuple_size_v<ActionNumbers>;

std::string ShapeOf(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    text += (axis == 0 ? "" : ", ") + std::to_string(array.shape(axis));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> ArrayFrom(const py::object& value,
                                                                    const std::string& what) {
  auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw Error(ErrorCode::kInvalidArgument, what + ": expected an array of numbers, found " +
                                                 std::string(py::str(py::type::of(value))));
  }
  return array;
}

const py::object& NumpyJson() {
  static const auto* dumps = [] {
    // numpy's numbers and arrays know how to become Python's
    const py::dict scope;
    py::exec(R"(
import json
def dumps(value):
    return json.dumps(value, default=lambda v: v.tolist())
)",
             scope);
    return new py::object(scope["dumps"]);
  }();
  return *dumps;
}

}  // namespace

py::object ToPython(const Json& json) {
  switch (json.type()) {
    case Json::value_t::object: {
      py::dict dict;
      for (const auto& [key, value] : json.items()) dict[py::str(key)] = ToPython(value);
      return dict;
    }
    case Json::value_t::array: {
      py::list list;
      for (const Json& value : json) list.append(ToPython(value));
      return list;
    }
    case Json::value_t::string:
      return py::str(json.get_ref<const std::string&>());
    case Json::value_t::boolean:
      return py::bool_(json.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(json.get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(json.get<double>());
    default:
      return py::none();
  }
}

Json FromPython(const py::object& value, const std::string& what) {
  std::string text;
  try {
    text = NumpyJson()(value).cast<std::string>();
  } catch (py::error_already_set& error) {
    throw Error(ErrorCode::kInvalidConfig,
                what + ": expected numbers, texts, lists and dicts of these: " +
                    std::string(py::str(error.value())));
  }
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded())
    throw Error(ErrorCode::kInvalidConfig, what + ": holds a number that is not finite");
  return json;
}

py::array_t<double> ToPython(const Eigen::Vector3d& vector) { return ArrayOf(vector.data(), {3}); }

py::array_t<double> ToPython(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = matrix;
  return ArrayOf(rows.data(), {3, 3});
}

py::array_t<double> ToPython(const RigidTransform& transform) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = transform.matrix();
  return ArrayOf(rows.data(), {4, 4});
}

py::tuple ToPython(const TriangleMesh& mesh) {
  py::array_t<double> vertices({static_cast<py::ssize_t>(mesh.vertices.size()), py::ssize_t{3}});
  py::array_t<std::int32_t> triangles(
      {static_cast<py::ssize_t>(mesh.triangles.size()), py::ssize_t{3}});
  double* position = vertices.mutable_data();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    position = std::copy_n(vertex.data(), 3, position);
  std::int32_t* corner = triangles.mutable_data();
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    corner = std::copy_n(triangle.data(), 3, corner);
  return py::make_tuple(vertices, triangles);
}

Action ActionFrom(const py::object& value, const std::string& what) {
  if (py::isinstance<Action>(value)) return value.cast<Action>();
  const auto array = ArrayFrom<double>(value, what);
  const bool row = array.ndim() == 2 && array.shape(0) == 1;
  if ((array.ndim() != 1 && !row) || static_cast<std::size_t>(array.size()) != kActionNumbers)
    throw Error(ErrorCode::kInvalidArgument,
                what + ": shape " + ShapeOf(array) +
                    ", expected (9,): how far the hand goes [m] and two rows of its rotation");
  ActionNumbers numbers{};
  std::copy_n(array.data(), kActionNumbers, numbers.begin());
  for (std::size_t i = 0; i < kActionNumbers; ++i) {
    if (!std::isfinite(numbers[i]))
      throw Error(ErrorCode::kInvalidArgument, what + "[" + std::to_string(i) + "] is " +
                                                   std::to_string(numbers[i]) +
                                                   ", expected a finite number");
  }
  return FromNumbers(numbers);
}

Stage StageOf(const std::string& name) {
  if (const auto stage = StageNamed(name)) return *stage;
  throw Error(ErrorCode::kInvalidArgument,
              "stage: there is no \"" + name + "\"; there are grasp, handle, open");
}

LabelledCloud CloudFrom(const py::object& value, const std::string& what) {
  const auto array = ArrayFrom<float>(value, what);
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw Error(ErrorCode::kInvalidArgument,
                what + ": shape " + ShapeOf(array) + ", expected (points, 3)");
  LabelledCloud cloud;
  cloud.xyz.assign(array.data(), array.data() + array.size());
  cloud.label.assign(static_cast<std::size_t>(array.shape(0)),
                     static_cast<std::uint8_t>(PointLabel::kOther));
  return cloud;
}

ShownObservation ObservationFrom(const py::dict& values) {
  ShownObservation observation;
  if (!values.contains("proprioception"))
    throw Error(ErrorCode::kInvalidArgument,
                "observation: no \"proprioception\", which every policy reads");
  const auto felt = ArrayFrom<float>(values["proprioception"], "observation[\"proprioception\"]");
  if (static_cast<std::size_t>(felt.size()) != observation.proprioception.size())
    throw Error(ErrorCode::kInvalidArgument,
                "observation[\"proprioception\"]: shape " + ShapeOf(felt) + ", expected (32,)");
  std::copy_n(felt.data(), felt.size(), observation.proprioception.begin());
  if (!values.contains("cloud")) return observation;
  observation.cloud = CloudFrom(values["cloud"], "observation[\"cloud\"]");
  if (values.contains("remembered")) observation.is_joined = values["remembered"].cast<bool>();
  if (!values.contains("cloud_label")) return observation;
  const auto label = ArrayFrom<std::uint8_t>(values["cloud_label"], "observation[\"cloud_label\"]");
  const std::size_t points = observation.cloud.label.size();
  if (static_cast<std::size_t>(label.size()) != points)
    throw Error(ErrorCode::kInvalidArgument, "observation[\"cloud_label\"]: shape " +
                                                 ShapeOf(label) + ", but the cloud has " +
                                                 std::to_string(points) + " points");
  std::copy_n(label.data(), label.size(), observation.cloud.label.begin());
  return observation;
}

namespace {

/// One thing that a policy may be shown.
struct ObservationRow {
  const char* name;
  py::object (*of)(const Observation&);
};

py::array_t<double> DoorState(const Observation& observation) {
  const PrivilegedState& known = observation.privileged;
  std::array<double, 2 + 7 * 3> numbers{known.hinge_rad, known.handle_rad};
  double* next = numbers.data() + 2;
  for (const RigidTransform* pose :
       {&known.world_from_handle, &known.world_from_hand, &known.handle_from_hand_at_grasp}) {
    const Eigen::Quaterniond turn(pose->linear());
    next = std::copy_n(pose->translation().data(), 3, next);
    next = std::copy_n(turn.coeffs().data(), 4, next);
  }
  return ArrayOf(numbers.data(), {static_cast<py::ssize_t>(numbers.size())});
}

void RequireColors(const Observation& seen, const char* name) {
  Require(seen.cloud.picture != nullptr, ErrorCode::kInvalidArgument,
          std::string("observation: no \"") + name +
              "\" here; `evaluate` shows pictures, with clouds that a camera sees");
}

constexpr ObservationRow kObservationRows[] = {
    {"cloud",
     [](const Observation& seen) -> py::object {
       return ArrayOf(seen.cloud.xyz.data(),
                      {static_cast<py::ssize_t>(seen.cloud.xyz.size() / 3), 3});
     }},
    {"cloud_label",
     [](const Observation& seen) -> py::object {
       return ArrayOf(seen.cloud.label.data(), {static_cast<py::ssize_t>(seen.cloud.label.size())});
     }},
    {"cloud_rgb",
     [](const Observation& seen) -> py::object {
       RequireColors(seen, "cloud_rgb");
       return ArrayOf(seen.cloud.rgb.data(),
                      {static_cast<py::ssize_t>(seen.cloud.rgb.size() / 3), 3});
     }},
    {"image",
     [](const Observation& seen) -> py::object {
       RequireColors(seen, "image");
       const CameraPicture& picture = *seen.cloud.picture;
       return ArrayOf(picture.rgb.data(), {picture.height, picture.width, 3});
     }},
    {"depth",
     [](const Observation& seen) -> py::object {
       RequireColors(seen, "depth");
       const CameraPicture& picture = *seen.cloud.picture;
       return ArrayOf(picture.depth_m.data(), {picture.height, picture.width});
     }},
    {"proprioception",
     [](const Observation& seen) -> py::object {
       return ArrayOf(seen.proprioception.data(),
                      {static_cast<py::ssize_t>(seen.proprioception.size())});
     }},
    {"door_state", [](const Observation& seen) -> py::object { return DoorState(seen); }},
};

}  // namespace

py::dict ToPython(const Observation& observation, const std::vector<std::string>& names) {
  py::dict dict;
  for (const std::string& name : names) {
    for (const ObservationRow& row : kObservationRows) {
      if (name == row.name) dict[row.name] = row.of(observation);
    }
  }
  return dict;
}

py::dict ToPython(const GraspObservation& observation) {
  const LabelledCloud& visible = observation.visible;
  const auto points = static_cast<py::ssize_t>(visible.label.size());
  py::dict dict;
  dict["cloud"] = ArrayOf(visible.xyz.data(), {points, 3});
  dict["cloud_label"] = ArrayOf(visible.label.data(), {points});
  dict["approach"] = ToPython(observation.approach);
  dict["hand_from_tcp"] = ToPython(observation.hand_from_tcp);
  dict["episode"] = py::str(observation.episode);
  return dict;
}

void RequireObservationNames(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const bool known = std::any_of(std::begin(kObservationRows), std::end(kObservationRows),
                                   [&](const ObservationRow& row) { return name == row.name; });
    if (known) continue;
    std::string all;
    for (const ObservationRow& row : kObservationRows)
      all += (all.empty() ? "" : ", ") + std::string(row.name);
    throw Error(ErrorCode::kInvalidArgument,
                "observation: there is no \"" + name + "\"; there are " + all);
  }
}

void RunLong(const std::function<void()>& body) {
  const py::module_ threading = py::module_::import("threading");
  const bool on_main = threading.attr("current_thread")().is(threading.attr("main_thread")());
  bool stopped = false;
  {
    const py::gil_scoped_release others;
    std::optional<StopSignals> signals;
    if (on_main) signals.emplace();
    try {
      body();
    } catch (const Error&) {
      if (!on_main || StopRequested() == 0) throw;
    }
    stopped = on_main && StopRequested() != 0;
  }
  if (!stopped) return;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

}  // namespace doorforge::python
