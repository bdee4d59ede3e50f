// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/evaluate_opener.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/evaluate/run_trials.h"
#include "doorforge/evaluate/take_pictures.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/policy/whole_policy.h"
#include "doorforge/registry/run_policy_set.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/proprioception.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/stage_content.h"

#include "training_record.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTrainingPreviews = 12;
constexpr std::size_t kMostNamedDoors = 8;

PolicySetFactory FactoryOf(const EvaluationRequest& request) {
  return {request.registry, request.policies, request.config.Policies(),
          request.config.unlock_switch};
}

TrialPolicies ExpertPolicies() {
  return {[] { return PolicySet{std::make_unique<OpeningExpert>()}; }};
}

TrialPolicies PoliciesOf(const PolicySetFactory& factory, const EvaluationConfig& config) {
  if (factory.IsExpertAlone()) return ExpertPolicies();
  const RobotBase base = config.scene.physics.base;
  const auto robot = std::make_shared<const RobotModel>(LoadRobot({}, base));
  Require(
      HasProprioception(*robot), ErrorCode::kInvalidConfig,
      "config.scene.physics.base: a policy knows sliders, a fixed base or a flying hand, found " +
          std::string(NameOf(base)));
  return {[&factory] { return factory.Make(); },
          [&config, robot, remembered = factory.Remembered()](
              const Scene& scene, const DoorAsset& door, const PolicySet& set) {
            return CameraOf({scene, door, *robot, config.cloud}, remembered, set);
          }};
}

// The data sets are the policy's own, in the order in which it was trained from them.
void RequireSameData(const PolicyRecord& policy, std::span<const fs::path> data) {
  const std::string found = StageContentSha256(data, policy.provenance.stage);
  if (found != policy.provenance.dataset_sha256)
    throw Error(ErrorCode::kInvalidArgument,
                "--data " + data[0].string() + ": has the hash " + found.substr(0, 12) +
                    "..., but the policy was trained from " +
                    policy.provenance.dataset_sha256.substr(0, 12) +
                    "...; give its own data sets in their order, or none");
}

void RequireHeldOut(const EvaluationReport& report) {
  const auto seen = SeenDoors(report.doors, report.trained_on);
  if (seen.empty()) return;
  std::string names;
  for (std::size_t i = 0; i < std::min(seen.size(), kMostNamedDoors); ++i)
    names += "\n  " + seen[i];
  if (seen.size() > kMostNamedDoors)
    names += "\n  and " + std::to_string(seen.size() - kMostNamedDoors) + " more";
  throw Error(ErrorCode::kInvalidArgument,
              std::to_string(seen.size()) + " of " + std::to_string(report.doors.size()) +
                  " doors have a body or a handle that the policy was trained on; compose others, "
                  "or pass --allow-seen to evaluate them all the same:" +
                  names);
}

// The parts that it knows; from then on they are not held out.
void AddSeenParts(const PolicyRecord& policy, const fs::path& folder, bool allow_seen,
                  EvaluationReport& report) {
  Require(allow_seen || !policy.provenance.trained_on.empty(), ErrorCode::kInvalidArgument,
          folder.string() +
              ": a policy of an earlier build, whose record does not say which bodies and handles "
              "it was trained on; train it again, or pass --allow-seen to evaluate without that "
              "check");
  report.trained_on = Union(report.trained_on, policy.provenance.trained_on);
}

void AddTrainingDoors(std::span<const fs::path> data, EvaluationReport& report) {
  std::map<std::string, DoorIdentity> doors;  // each once, by id
  for (const fs::path& folder : data) {
    for (DoorIdentity& door : internal::TrainingDoors(folder)) doors[door.id] = std::move(door);
  }
  for (auto& [id, door] : doors) report.training_doors.push_back(std::move(door));
}

// What the record says of a policy that opened and of the data that it was trained from.
void AddOpener(const EvaluationRequest& request, const PolicyChoice& opener,
               EvaluationReport& report) {
  report.provenance.policy = opener.Name();
  if (opener.IsOwn()) {
    for (const fs::path& folder : request.data)
      report.trained_on = Union(report.trained_on, SeenPartsOfDataset(folder));
    AddTrainingDoors(request.data, report);
  } else if (opener.IsFolder()) {
    const PolicyRecord policy = ReadPolicy(opener.folder);
    report.provenance.policy_sha256 = policy.weights_sha256;
    report.provenance.dataset_sha256 = policy.provenance.dataset_sha256;
    report.losses = internal::TrainingLosses(opener.folder);
    AddSeenParts(policy, opener.folder, request.allow_seen, report);
    if (const auto pushed = PushedPolicyIn(opener.folder))
      AddSeenParts(ReadPolicy(*pushed), *pushed, request.allow_seen, report);
    if (!request.data.empty()) RequireSameData(policy, request.data);
    AddTrainingDoors(request.data, report);
  }
}

// What the record says instead of a hash, or the hash of the weights.
std::string RecordedAs(const PolicyChoice& choice, Stage stage, bool allow_seen,
                       EvaluationReport& report) {
  if (choice.IsExpert()) return "";
  if (choice.IsOwn()) return kOwnPolicy;
  if (!choice.IsFolder()) return choice.word;
  const PolicyRecord policy = ReadPolicy(choice.folder, NameOf(stage));
  AddSeenParts(policy, choice.folder, allow_seen, report);
  return policy.weights_sha256;
}

// Who finds the handle, where a trained grasper is not told it.
void AddFinder(const EvaluationRequest& request, const PolicyChoice& grasper,
               EvaluationReport& report) {
  const std::string& folder = request.config.grasp.finder;
  if (folder.empty() || !grasper.IsFolder()) return;
  const PolicyRecord finder = ReadPolicy(folder, kFindStage);
  AddSeenParts(finder, folder, request.allow_seen, report);
  report.provenance.finder_sha256 = finder.weights_sha256;
}

// One that does all of it turned the handle and took hold as well.
void AddWhole(const fs::path& folder, EvaluationReport& report) {
  const WholePolicy policy = ReadWholePolicy(folder);
  report.provenance.policy = (folder / "").parent_path().filename().string();
  for (std::string ReportProvenance::*actor :
       {&ReportProvenance::policy_sha256, &ReportProvenance::handler_sha256,
        &ReportProvenance::grasper_sha256})
    report.provenance.*actor = policy.weights_sha256;
  report.provenance.privileges = policy.privileges;
  report.trained_on = Union(report.trained_on, policy.provenance.trained_on);
}

// Fills in what the policies' and the data sets' records say.
void AddTraining(const EvaluationRequest& request, const PolicySetFactory& factory,
                 EvaluationReport& report) {
  const bool seen = request.allow_seen;
  if (!factory.whole().empty()) {
    AddWhole(factory.whole(), report);
    if (!seen) RequireHeldOut(report);
    return;
  }
  AddOpener(request, factory.opener(), report);
  report.provenance.handler_sha256 = RecordedAs(factory.handler(), Stage::kHandle, seen, report);
  report.provenance.grasper_sha256 = RecordedAs(factory.grasper(), Stage::kGrasp, seen, report);
  AddFinder(request, factory.grasper(), report);
  if (!seen) RequireHeldOut(report);
}

std::vector<EvaluatedEpisode> RunWithProgress(const std::string& title, const TrialPlan& trials,
                                              const TrialPolicies& policies, RunHooks hooks) {
  Progress progress(title, trials.size());
  std::atomic<int> opened = 0;
  std::atomic<int> done = 0;
  hooks.done = [&](const EvaluatedEpisode& row) {
    opened += row.outcome == EpisodeOutcome::kOpened ? 1 : 0;
    const int percent = 100 * opened / ++done;
    progress.Advance(1, "opened " + std::to_string(percent) + " %");
  };
  return RunTrials(trials, policies, hooks);
}

EvaluationReport NewReport(const EvaluationRequest& request, const std::vector<FoundDoor>& doors) {
  EvaluationReport report;
  report.provenance.code_version = CodeVersion();
  report.provenance.command = request.command;
  report.provenance.config = ToJson(request.config);
  for (const FoundDoor& door : doors) report.doors.push_back(door.identity);
  return report;
}

}  // namespace

Evaluation EvaluateOpener(const EvaluationRequest& request) {
  RequireSimulator(request.config.scene.physics.simulator);
  const PolicySetFactory factory = FactoryOf(request);
  const DoorSet set = FindDoorSet(request.doors, request.threads);
  const std::vector<FoundDoor>& doors = set.doors;
  DoorCache shelf(doors);
  const TrialPlan trials([&](std::size_t door) { return shelf.Take(door); }, doors.size(),
                         request.config);
  Evaluation evaluation;
  EvaluationReport& report = evaluation.report;
  report = NewReport(request, doors);
  evaluation.notes = set.notes;
  AddTraining(request, factory, report);

  const TrialPolicies policies = PoliciesOf(factory, request.config);
  const RunHooks hooks{.threads = request.threads, .done = nullptr, .doors = report.doors};
  report.episodes = RunWithProgress("evaluate", trials, policies, hooks);
  if (!factory.IsExpertAlone() && request.config.expert_reference)
    report.reference = RunWithProgress("expert", trials, ExpertPolicies(), hooks);

  if (request.pictures)
    evaluation.pictures = TakePictures({trials, report.episodes}, policies, request.threads);
  if (request.films)
    evaluation.films = TakeFilms({trials, report.episodes}, policies, request.threads);
  for (const EpisodeFilm& film : evaluation.films)
    evaluation.pictures.filmed.insert(FilmAddress(film.scene));
  if (!request.pictures) return evaluation;
  for (const fs::path& data : request.data)
    evaluation.pictures.doors.merge(internal::TrainingPreviews(data, kTrainingPreviews));
  return evaluation;
}

}  // namespace doorforge
