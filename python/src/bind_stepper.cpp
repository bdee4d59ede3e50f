// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Episodes action by action, one or many at once.

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/physics/latch_law.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/episode_stepper.h"
#include "doorforge/sensor/scene_picture.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {
namespace {

/// What a stepper in Python is made with.
struct StepperSettings {
  StepperOptions options;
  CloudConfig cloud;
  RememberedViewConfig remembered{.resolution_scale = 0};
};

/// A stepper with the door, robot and camera that it needs, one call at a time.
class HeldStepper {
 public:
  HeldStepper(Door door, Robot robot, StepperSettings settings)
      : door_(std::move(door)),
        robot_(std::move(robot)),
        settings_(std::move(settings)),
        stepper_(*door_.asset, *robot_.model, settings_.options) {}

  void Reset(const Scene& scene) {
    const Busy busy(*this);
    camera_.reset();
    if (!settings_.options.clouds.empty()) camera_ = CameraFor(scene);
    stepper_.Reset(scene, camera_.get());
    scene_ = scene;
  }

  void Step(const Action& action) {
    const Busy busy(*this);
    stepper_.Step(action);
  }

  EpisodeImage Save() {
    const Busy busy(*this);
    return stepper_.Save();
  }

  void Restore(const EpisodeImage& image) {
    const Busy busy(*this);
    stepper_.Restore(image);
  }

  Picture Render(std::optional<CameraModel> camera, const ViewConfig& view) {
    const Busy busy(*this);
    const SceneSnapshot snapshot = stepper_.Snapshot();
    if (!picture_)
      picture_ = std::make_unique<SceneGeometry>(VisibleMeshesOf(*door_.asset, *robot_.model));
    picture_->MoveLinks(LinkPosesOf(snapshot));
    if (!camera) camera = FramingCamera(*picture_, view);
    return RenderPicture(*picture_, *camera);
  }

  const EpisodeStepper& stepper() const { return stepper_; }
  const Scene& scene() const { return scene_; }
  const Door& door() const { return door_; }
  bool remembers() const { return settings_.remembered.IsOn(); }

 private:
  // The physics of one world may not be entered twice; a second thread is told so.
  class Busy {
   public:
    explicit Busy(HeldStepper& held) : busy_(held.busy_) {
      Require(!busy_.exchange(true), ErrorCode::kInvalidArgument,
              "stepper: another thread is in a call of it; give each thread its own");
    }
    ~Busy() { busy_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    std::atomic<bool>& busy_;
  };

  std::unique_ptr<CameraObserver> CameraFor(const Scene& scene) const {
    auto camera =
        std::make_unique<CameraObserver>(scene, *door_.asset, *robot_.model, settings_.cloud);
    if (settings_.remembered.IsOn())
      camera->Remember({scene, *door_.asset, *robot_.model, settings_.cloud, settings_.remembered});
    return camera;
  }

  Door door_;
  Robot robot_;
  StepperSettings settings_;
  EpisodeStepper stepper_;
  Scene scene_;
  std::unique_ptr<CameraObserver> camera_;
  std::unique_ptr<SceneGeometry> picture_;
  std::atomic<bool> busy_ = false;
};

std::unique_ptr<HeldStepper> MakeStepper(const Door& door, const Robot& robot,
                                         const std::string& first,
                                         const std::vector<std::string>& clouds,
                                         const py::dict& cameras) {
  StepperSettings settings;
  settings.options.first = StageOf(first);
  for (const std::string& stage : clouds) settings.options.clouds.push_back(StageOf(stage));
  if (cameras.contains("cloud"))
    settings.cloud = ConfigFrom<CloudConfig>(cameras["cloud"], "cloud");
  if (cameras.contains("remembered"))
    settings.remembered = ConfigFrom<RememberedViewConfig>(cameras["remembered"], "remembered");
  return std::make_unique<HeldStepper>(door, robot, std::move(settings));
}

py::object CauseOf(const StepResult& now) {
  if (!now.cause) return py::none();
  return py::str(std::string(NameOf(*now.cause)));
}

py::dict StateOf(const HeldStepper& held) {
  const WorldState& state = held.stepper().state();
  py::dict dict;
  dict["robot_position"] = ArrayOf(state.robot_position.data(), {state.robot_position.size()});
  dict["robot_velocity"] = ArrayOf(state.robot_velocity.data(), {state.robot_velocity.size()});
  dict["hinge_rad"] = state.hinge_rad;
  dict["hinge_rad_s"] = state.hinge_rad_s;
  dict["handle_rad"] = state.handle_rad;
  dict["handle_rad_s"] = state.handle_rad_s;
  dict["locked"] = state.locked;
  dict["handle_done"] = state.handle_done;
  dict["bolt_m"] = state.bolt_m;
  dict["time_s"] = state.time_s;
  return dict;
}

py::dict SummaryOf(const HeldStepper& held) {
  const Episode episode = held.stepper().Summary();
  py::dict dict;
  dict["cause"] = std::string(NameOf(episode.outcome));
  dict["detail"] = episode.detail;
  dict["peak_hinge_rad"] = episode.peak_hinge_rad;
  dict["peak_handle_rad"] = episode.peak_handle_rad;
  dict["simulated_s"] = episode.simulated_s;
  dict["state_sha256"] = episode.state_sha256;
  return dict;
}

py::array_t<std::uint8_t> Render(HeldStepper& held, const py::dict& settings) {
  ViewConfig view;
  std::optional<CameraModel> camera;
  const auto take = [&settings](const char* key, auto& value) {
    if (settings.contains(key))
      value = settings[key].template cast<std::remove_reference_t<decltype(value)>>();
  };
  take("width", view.width);
  take("height", view.height);
  take("azimuth_rad", view.azimuth_rad);
  take("elevation_rad", view.elevation_rad);
  if (settings.contains("camera") && settings["camera"].cast<std::string>() == "policy") {
    camera = held.scene().camera;
    const double aspect = static_cast<double>(view.height) / view.width;
    camera->width = view.width;
    camera->height = static_cast<int>(view.width * aspect);
  }
  const Picture picture = Long([&] { return held.Render(camera, view); });
  return ArrayOf(picture.rgb.data(), {picture.height, picture.width, 3});
}

/// What one of many steppers is to do.
using Job = std::variant<std::monostate, Action, Scene>;

Job JobFrom(const py::object& value, std::size_t index) {
  if (value.is_none()) return {};
  if (py::isinstance<Scene>(value)) return value.cast<Scene>();
  return ActionFrom(value, "actions[" + std::to_string(index) + "]");
}

// Each stepper carries out its job; all actions are looked at before any is carried out.
void Advance(const std::vector<HeldStepper*>& steppers, const py::sequence& values, int threads) {
  Require(steppers.size() == values.size(), ErrorCode::kInvalidArgument,
          "advance: " + std::to_string(values.size()) + " jobs for " +
              std::to_string(steppers.size()) + " steppers");
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < steppers.size(); ++i) jobs.push_back(JobFrom(values[i], i));
  RunLong([&] {
    ParallelFor(steppers.size(), threads, [&](std::size_t i) {
      if (const auto* action = std::get_if<Action>(&jobs[i])) steppers[i]->Step(*action);
      if (const auto* scene = std::get_if<Scene>(&jobs[i])) steppers[i]->Reset(*scene);
    });
  });
}

}  // namespace

void BindStepper(py::module_& module) {
  py::class_<EpisodeImage>(module, "EpisodeImage");
  py::class_<HeldStepper>(module, "Stepper")
      .def(py::init(&MakeStepper))
      .def("reset",
           [](HeldStepper& held, const Scene& scene) { RunLong([&] { held.Reset(scene); }); })
      .def("step",
           [](HeldStepper& held, const py::object& value) {
             const Action action = ActionFrom(value, "action");
             const py::gil_scoped_release others;
             held.Step(action);
           })
      .def("save",
           [](HeldStepper& held) {
             const py::gil_scoped_release others;
             return held.Save();
           })
      .def("restore",
           [](HeldStepper& held, const EpisodeImage& image) {
             const py::gil_scoped_release others;
             held.Restore(image);
           })
      .def("render", &Render)
      .def("state", &StateOf)
      .def("summary", &SummaryOf)
      .def_property_readonly("scene", [](const HeldStepper& held) { return held.scene(); })
      .def_property_readonly("door", [](const HeldStepper& held) { return held.door(); })
      .def_property_readonly(
          "stage",
          [](const HeldStepper& held) { return std::string(NameOf(held.stepper().now().stage)); })
      .def_property_readonly(
          "observation",
          [](const HeldStepper& held) {
            return ShownObservation{held.stepper().now().observation, held.remembers()};
          })
      .def("arrays",
           [](const HeldStepper& held, const std::vector<std::string>& names) {
             return ToPython(held.stepper().now().observation, names);
           })
      .def_property_readonly("reward",
                             [](const HeldStepper& held) { return held.stepper().now().reward; })
      .def_property_readonly(
          "terminated", [](const HeldStepper& held) { return held.stepper().now().terminated; })
      .def_property_readonly("truncated",
                             [](const HeldStepper& held) { return held.stepper().now().truncated; })
      .def_property_readonly("over",
                             [](const HeldStepper& held) { return held.stepper().now().over(); })
      .def_property_readonly("cause",
                             [](const HeldStepper& held) { return CauseOf(held.stepper().now()); });
  module.def("advance", &Advance, py::arg("steppers"), py::arg("jobs"), py::arg("threads") = 0);
  module.def("require_observation_names", &RequireObservationNames);
}

}  // namespace doorforge::python
