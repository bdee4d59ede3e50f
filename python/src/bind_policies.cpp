// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Policies by name or folder, as they act.

#include <memory>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/registry/policy_set_factory.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {
namespace {

/// A policy of one stage, with what else its set holds.
class HeldPolicy {
 public:
  HeldPolicy(const std::string& word, const std::string& stage, const PolicyOptions& options)
      : factory_(FactoryOf(word, stage, options)), set_(factory_.Make()) {
    policy_ = stage == "handle" ? set_.handle.get() : set_.open.get();
    policy_->Reset();
  }

  void Reset() { policy_->Reset(); }
  Action Act(const Observation& observation) { return policy_->Act(observation); }
  bool UsesPointCloud() const { return policy_->UsesPointCloud(); }
  RememberedViewConfig Remembered() const { return factory_.Remembered(); }
  py::object Turned() const {
    if (set_.handle_turned == nullptr) return py::none();
    return py::bool_(set_.handle_turned->Turned());
  }

 private:
  static PolicySetFactory FactoryOf(const std::string& word, const std::string& stage,
                                    const PolicyOptions& options) {
    PolicyWords words;
    if (stage == "open")
      words.opener = word;
    else if (stage == "handle")
      words.handler = word;
    else
      throw Error(ErrorCode::kInvalidArgument,
                  "stage: there is no policy of motions at \"" + stage +
                      "\"; there are handle, open; graspers go to evaluate(grasper=)");
    PolicySettings settings;
    settings.network = options;
    settings.handle_expert = HandleExpertConfig{};
    return {BuiltInPolicies(), words, settings};
  }

  PolicySetFactory factory_;
  PolicySet set_;
  Policy* policy_ = nullptr;
};

}  // namespace

void BindPolicies(py::module_& module) {
  py::class_<HeldPolicy>(module, "Policy")
      .def(py::init(
          [](const std::string& word, const std::string& stage, const py::object& settings) {
            const auto options = ConfigFrom<PolicyOptions>(settings, "policy");
            return Long([&] { return std::make_unique<HeldPolicy>(word, stage, options); });
          }))
      .def("reset", &HeldPolicy::Reset)
      .def("act",
           [](HeldPolicy& policy, const py::object& seen) {
             const Observation observation = py::isinstance<Observation>(seen)
                                                 ? seen.cast<Observation>()
                                                 : ObservationFrom(seen.cast<py::dict>());
             const py::gil_scoped_release others;
             return policy.Act(observation);
           })
      .def_property_readonly("looks", &HeldPolicy::UsesPointCloud)
      .def_property_readonly("turned", &HeldPolicy::Turned)
      .def_property_readonly("remembered", [](const HeldPolicy& policy) {
        return ToPython(ToJson(policy.Remembered()));
      });
  module.def("policy_names", [](const std::string& stage) {
    const auto known = StageNamed(stage);
    Require(known.has_value(), ErrorCode::kInvalidArgument,
            "stage: there is no \"" + stage + "\"; there are grasp, handle, open");
    return BuiltInPolicies().Names(*known);
  });
}

}  // namespace doorforge::python
