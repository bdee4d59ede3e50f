// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Many episodes at once: simulate, evaluate.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/evaluate/evaluate_opener.h"
#include "doorforge/registry/policy_episodes.h"
#include "doorforge/report/report_folder.h"
#include "doorforge/report/report_table.h"
#include "doorforge/robot_meshes/robot_meshes.h"

#include "bindings.h"
#include "callable_policy.h"
#include "convert.h"

namespace doorforge::python {
namespace {

constexpr const char* kCallable = "callable";

/// The words of a request from what Python gave: a word, or a callable with a row of its own.
class Roles {
 public:
  explicit Roles(std::vector<std::string> names) : names_(std::move(names)) {
    RequireObservationNames(names_);
  }

  std::string Word(Stage stage, const py::object& given, const std::string& role) {
    if (py::isinstance<py::str>(given)) return given.cast<std::string>();
    if (!PyCallable_Check(given.ptr()))
      throw Error(ErrorCode::kInvalidArgument,
                  role +
                      ": expected the name of a policy, its folder, or something that can be "
                      "called with a dict of arrays, found " +
                      py::str(py::type::of(given)).cast<std::string>());
    AddRow(stage, Share({given, names_, role}));
    return kCallable;
  }

  PolicyRegistry registry = BuiltInPolicies();

 private:
  void AddRow(Stage stage, const SharedCallable& settings) {
    if (stage == Stage::kGrasp)
      registry.Add(GraspPolicyRow{
          kCallable, [settings](const PolicySettings&) { return MakeCallableGrasp(settings); }});
    else
      registry.Add(MotionPolicyRow{stage, kCallable, [settings](const PolicySettings&) {
                                     return MakeCallablePolicy(settings);
                                   }});
  }

  std::vector<std::string> names_;
};

py::dict Evaluate(const py::dict& given) {
  Roles roles(given["observation"].cast<std::vector<std::string>>());
  EvaluationRequest request;
  request.policies.opener = roles.Word(Stage::kOpen, given["opener"], "opener");
  request.policies.handler = roles.Word(Stage::kHandle, given["handler"], "handler");
  request.policies.grasper = roles.Word(Stage::kGrasp, given["grasper"], "grasper");
  request.registry = std::move(roles.registry);
  request.doors = DoorSelectionOf(given["doors"].cast<std::vector<std::string>>(), "test");
  request.doors.per_category = given["per_category"].cast<int>();
  for (const auto& folder : given["data"].cast<std::vector<std::string>>())
    request.data.emplace_back(folder);
  request.allow_seen = given["allow_seen"].cast<bool>();
  request.threads = given["threads"].cast<int>();
  request.config = ConfigFrom<EvaluationConfig>(given["config"], "config");
  request.command = "doorforge.evaluate";
  const auto out = given["out"].cast<std::string>();
  const bool overwrite = given["overwrite"].cast<bool>();

  std::optional<Evaluation> evaluation;
  RunLong([&] {
    // refused before hours of work, not after
    std::optional<StagedFolder> staged;
    request.pictures = !out.empty();
    if (request.pictures)
      staged.emplace(out, kReportFolder, overwrite ? Existing::kReplace : Existing::kRefuse);
    evaluation = EvaluateOpener(request);
    if (staged) WriteReportFolder(evaluation->report, evaluation->pictures, *staged);
  });
  py::dict result;
  result["report"] = ToPython(ReportToJson(evaluation->report));
  result["table"] = ReportTable(evaluation->report);
  result["notes"] = evaluation->notes;
  return result;
}

py::object Simulate(const std::vector<std::string>& doors, const py::dict& words,
                    const py::dict& given) {
  PolicyWords policies;
  const auto word = [&words](const char* role, std::string& value) {
    if (words.contains(role)) value = words[role].cast<std::string>();
  };
  word("opener", policies.opener);
  word("handler", policies.handler);
  word("grasper", policies.grasper);
  SimulationRun run;
  for (const std::string& door : doors) run.doors.emplace_back(door);
  const auto config = ConfigFrom<PolicySimulateConfig>(given["config"], "config");
  run.seed = given["seed"].cast<std::uint64_t>();
  run.seeds = given["seeds"].cast<int>();
  run.episodes = given["episodes"].cast<int>();
  run.threads = given["threads"].cast<int>();
  run.read_meshes = RobotMeshes();
  return ToPython(Long([&] { return SimulatedToJson(SimulateDoorsWith(policies, config, run)); }));
}

}  // namespace

void BindEvaluation(py::module_& module) {
  module.def("evaluate", &Evaluate);
  module.def("simulate", &Simulate);
}

}  // namespace doorforge::python
