// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Policies by name or folder, as they act.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "doorforge/registry/lone_policy.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {
namespace {

Action Act(LonePolicy& policy, const py::object& seen) {
  const ShownObservation shown = py::isinstance<ShownObservation>(seen)
                                     ? seen.cast<ShownObservation>()
                                     : ObservationFrom(seen.cast<py::dict>());
  const py::gil_scoped_release others;
  return shown.is_joined ? policy.ActOnJoined(shown) : policy.Act(shown);
}

}  // namespace

void BindPolicies(py::module_& module) {
  py::class_<LonePolicy>(module, "Policy")
      .def(py::init([](const std::string& word, const std::string& stage,
                       const py::object& settings) {
        const auto options = ConfigFrom<PolicyOptions>(settings, "policy");
        return Long([&] { return std::make_unique<LonePolicy>(word, StageOf(stage), options); });
      }))
      .def(
          "reset",
          [](LonePolicy& policy, const py::object& before) {
            std::optional<LabelledCloud> seen;
            if (!before.is_none()) seen = CloudFrom(before, "before");
            policy.Begin(std::move(seen));
          },
          py::arg("before") = py::none())
      .def("act", &Act)
      .def_property_readonly("looks", &LonePolicy::UsesPointCloud)
      .def_property_readonly("turned",
                             [](const LonePolicy& policy) -> py::object {
                               if (!policy.Says()) return py::none();
                               return py::bool_(policy.Turned());
                             })
      .def_property_readonly("remembered", [](const LonePolicy& policy) {
        return ToPython(ToJson(policy.remembered()));
      });
  module.def("policy_names",
             [](const std::string& stage) { return BuiltInPolicies().Names(StageOf(stage)); });
}

}  // namespace doorforge::python
