// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "callable_policy.h"

#include <algorithm>
#include <limits>

#include "doorforge/core/error.h"
#include "doorforge/schemas/fallible.h"

#include "convert.h"

namespace doorforge::python {
namespace {

Action NoAction() {
  Action action;
  action.position_delta_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  return action;
}

class CallablePolicy : public Policy, public Fallible {
 public:
  explicit CallablePolicy(const CallableSettings& settings)
      : settings_(new CallableSettings(settings)) {}
  ~CallablePolicy() override {
    const py::gil_scoped_acquire lock;
    delete settings_;
  }
  CallablePolicy(const CallablePolicy&) = delete;
  CallablePolicy& operator=(const CallablePolicy&) = delete;

  void Reset() override {
    failure_.clear();
    const py::gil_scoped_acquire lock;
    Guarded([&] {
      if (py::hasattr(settings_->policy, "reset")) settings_->policy.attr("reset")();
    });
  }

  Action Act(const Observation& observation) override {
    Action action = NoAction();
    if (!failure_.empty()) return action;
    const py::gil_scoped_acquire lock;
    Guarded([&] {
      action = ActionFrom(settings_->policy(ToPython(observation, settings_->names)),
                          settings_->name + ": action");
    });
    return action;
  }

  bool UsesPointCloud() const override {
    const auto& names = settings_->names;
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.starts_with("cloud"); });
  }

  std::string Failure() const override { return failure_; }

 private:
  // what somebody's code raises ends the episode, not the evaluation
  template <class Call>
  void Guarded(Call&& call) {
    try {
      call();
    } catch (py::error_already_set& error) {
      failure_ = settings_->name + " raised " +
                 py::str(error.type().attr("__name__")).cast<std::string>() + ": " +
                 py::str(error.value()).cast<std::string>();
    } catch (const Error& error) {
      failure_ = error.what();
    }
  }

  CallableSettings* settings_;  // destroyed under the lock alone
  std::string failure_;
};

}  // namespace

std::unique_ptr<Policy> MakeCallablePolicy(const CallableSettings& settings) {
  const py::gil_scoped_acquire lock;
  return std::make_unique<CallablePolicy>(settings);
}

}  // namespace doorforge::python
