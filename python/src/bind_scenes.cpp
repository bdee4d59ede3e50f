// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Robots, scenes, observations and actions.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/environment_preset.h"
#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/robot_meshes/robot_meshes.h"
#include "doorforge/rollout/base_placement.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {
namespace {

void BindRobot(py::module_& module) {
  py::class_<Robot>(module, "Robot")
      .def(py::init([](const std::string& urdf, const std::string& base) {
             const std::optional<RobotBase> kind = ValueNamed<RobotBase>(base);
             Require(kind.has_value(), ErrorCode::kInvalidConfig,
                     "base: found \"" + base + "\", allowed sliders, fixed, yaw, floating");
             return Long([&] {
               return Robot{
                   std::make_shared<const RobotModel>(LoadRobot(urdf, *kind, RobotMeshes()))};
             });
           }),
           py::arg("urdf") = "", py::arg("base") = "sliders")
      .def_property_readonly("name", [](const Robot& robot) { return robot.model->name(); })
      .def_property_readonly(
          "base", [](const Robot& robot) { return std::string(NameOf(robot.model->base())); })
      .def_property_readonly("joints", [](const Robot& robot) {
        py::list names;
        for (const RobotJoint& joint : robot.model->joints()) names.append(joint.name);
        return names;
      });
}

void BindActions(py::module_& module) {
  py::class_<Action>(module, "Action")
      .def(py::init([](const py::object& vector) { return ActionFrom(vector, "action"); }))
      .def_property_readonly("position_delta_m",
                             [](const Action& action) { return ToPython(action.position_delta_m); })
      .def_property_readonly(
          "world_from_hand_rotation",
          [](const Action& action) { return ToPython(action.world_from_hand_rotation); })
      .def_property_readonly("vector", [](const Action& action) {
        const ActionVector vector = ToVector(action);
        return ArrayOf(vector.data(), {static_cast<py::ssize_t>(vector.size())});
      });
  py::class_<ShownObservation>(module, "Observation")
      .def(py::init(&ObservationFrom))
      .def("arrays",
           [](const ShownObservation& seen, const std::vector<std::string>& names) {
             RequireObservationNames(names);
             return ToPython(seen, names);
           })
      .def_property_readonly("hinge_rad",
                             [](const ShownObservation& seen) { return seen.privileged.hinge_rad; })
      .def_property_readonly(
          "handle_rad", [](const ShownObservation& seen) { return seen.privileged.handle_rad; })
      .def_property_readonly(
          "world_from_hand",
          [](const ShownObservation& seen) { return ToPython(seen.privileged.world_from_hand); })
      .def_property_readonly("world_from_handle", [](const ShownObservation& seen) {
        return ToPython(seen.privileged.world_from_handle);
      });
}

}  // namespace

void BindScenes(py::module_& module) {
  BindRobot(module);
  BindActions(module);
  py::class_<Scene>(module, "Scene")
      .def_readonly("door_id", &Scene::door_id)
      .def_readonly("seed", &Scene::seed)
      .def_readonly("episode", &Scene::episode)
      .def_property_readonly("world_from_door",
                             [](const Scene& scene) { return ToPython(scene.world_from_door); })
      .def_property_readonly(
          "world_from_robot_base",
          [](const Scene& scene) { return ToPython(scene.world_from_robot_base); })
      .def_property_readonly(
          "world_from_camera",
          [](const Scene& scene) { return ToPython(WorldFromCamera(scene.camera)); })
      .def_property_readonly(
          "camera_matrix",
          [](const Scene& scene) { return ToPython(IntrinsicMatrix(scene.camera)); })
      .def_property_readonly("latch", [](const Scene& scene) { return scene.latch; })
      .def("to_dict", [](const Scene& scene) { return ToPython(SceneToJson(scene)); })
      .def_static("from_dict", [](const py::dict& record) {
        return SceneFromJson(FromPython(record, "scene"), "scene");
      });
  module.def("environments", &EnvironmentPresets);
  module.def("environment", [](const std::string& word) {
    const std::filesystem::path file = EnvironmentPresetFile(word);
    return ToPython(ParseYaml(ReadFile(file, 1ULL << 20), file.string()));
  });
  module.def("sample_scene", [](const Door& door, std::uint64_t seed, std::uint64_t episode,
                                const py::object& settings, const Robot& robot) {
    const auto config = ConfigFrom<SceneConfig>(settings, "scene");
    return Long([&] {
      return PlaceRobotBase(*robot.model, SampleScene(*door.asset, seed, episode, config),
                            *door.asset);
    });
  });
}

}  // namespace doorforge::python
