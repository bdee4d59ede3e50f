// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "callable_policy.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

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

/// What is called, and why it gave nothing. What somebody's code raises ends the episode, not the
/// evaluation.
class Called {
 public:
  explicit Called(SharedCallable settings) : settings_(std::move(settings)) {}

  const CallableSettings& settings() const { return *settings_; }
  const std::string& failure() const { return failure_; }
  void ForgetFailure() { failure_.clear(); }

  /// Runs `call` with Python's lock.
  template <class Call>
  void Guarded(Call&& call) {
    const py::gil_scoped_acquire lock;
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

 private:
  SharedCallable settings_;
  std::string failure_;
};

void ResetIfItCan(const py::object& policy) {
  if (py::hasattr(policy, "reset")) policy.attr("reset")();
}

class CallablePolicy : public Policy, public Fallible {
 public:
  explicit CallablePolicy(SharedCallable settings) : called_(std::move(settings)) {}

  void Reset() override {
    called_.ForgetFailure();
    called_.Guarded([&] { ResetIfItCan(called_.settings().policy); });
  }

  Action Act(const Observation& observation) override {
    Action action = NoAction();
    if (!called_.failure().empty()) return action;
    called_.Guarded([&] {
      const CallableSettings& settings = called_.settings();
      action = ActionFrom(settings.policy(ToPython(observation, settings.names)),
                          settings.name + ": action");
    });
    return action;
  }

  bool UsesPointCloud() const override {
    return UsesColors() || Reads([](const std::string& name) { return name.starts_with("cloud"); });
  }
  bool UsesColors() const override {
    return Reads([](const std::string& name) {
      return name == "cloud_rgb" || name == "image" || name == "depth";
    });
  }

  void ForgetFailure() override { called_.ForgetFailure(); }
  std::string Failure() const override { return called_.failure(); }

 private:
  template <class Test>
  bool Reads(const Test& test) const {
    const auto& names = called_.settings().names;
    return std::any_of(names.begin(), names.end(), test);
  }

  Called called_;
};

class CallableGrasp : public GraspPolicy, public Fallible {
 public:
  explicit CallableGrasp(SharedCallable settings) : called_(std::move(settings)) {}

  std::optional<GraspAction> Choose(const GraspObservation& observation) override {
    std::optional<GraspAction> chosen;
    called_.Guarded([&] {
      const CallableSettings& settings = called_.settings();
      ResetIfItCan(settings.policy);
      const py::object answer = settings.policy(ToPython(observation));
      if (answer.is_none()) return;
      const Action action = ActionFrom(answer, settings.name + ": grasp");
      chosen.emplace();
      chosen->contact_m = action.position_delta_m;
      chosen->world_from_hand_rotation = action.world_from_hand_rotation;
    });
    return chosen;
  }

  void ForgetFailure() override { called_.ForgetFailure(); }
  std::string Failure() const override { return called_.failure(); }

 private:
  Called called_;
};

}  // namespace

SharedCallable Share(CallableSettings settings) {
  return {new CallableSettings(std::move(settings)), [](const CallableSettings* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

std::unique_ptr<Policy> MakeCallablePolicy(SharedCallable settings) {
  return std::make_unique<CallablePolicy>(std::move(settings));
}

std::unique_ptr<GraspPolicy> MakeCallableGrasp(SharedCallable settings) {
  return std::make_unique<CallableGrasp>(std::move(settings));
}

}  // namespace doorforge::python
