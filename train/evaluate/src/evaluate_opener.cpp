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
#include "doorforge/evaluate/trained_grasp.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/turning_policy.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/random_grasp.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/stage_content.h"

#include "training_record.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTrainingPreviews = 12;
constexpr std::size_t kMostNamedDoors = 8;

bool IsOwn(const EvaluationRequest& request) { return request.own.make_open != nullptr; }

bool IsExpert(const EvaluationRequest& request) {
  return !IsOwn(request) && request.policy == "expert";
}

Contender Expert() {
  return {[] { return Players{std::make_unique<OpeningExpert>()}; }, nullptr};
}

// Whether nothing that is to be evaluated is trained or sampled.
bool IsExpertAlone(const EvaluationRequest& request) {
  return IsExpert(request) && !request.own.make_handle && request.handler.empty() &&
         request.grasper.empty();
}

bool IsRandomGrasper(const EvaluationRequest& request) { return request.grasper == "random"; }

std::unique_ptr<GraspChooser> MakeRandomGrasp(const EvaluationConfig& config, const Scene& scene,
                                              const DoorAsset& door, const RobotModel& robot) {
  const auto camera = std::make_shared<CameraObserver>(scene, door, robot, config.cloud,
                                                       /*sees_robot=*/false);
  return std::make_unique<RandomGrasp>(
      scene, door, robot, config.random_grasp, CloudExtent{config.cloud.point_count},
      [camera](const SceneSnapshot& snapshot) { return camera->Look(snapshot).visible; });
}

void AddGrasper(const EvaluationRequest& request, Players& players) {
  const EvaluationConfig& config = request.config;
  if (IsRandomGrasper(request)) {
    players.make_grasp = [&config](const Scene& scene, const DoorAsset& door,
                                   const RobotModel& robot) {
      return MakeRandomGrasp(config, scene, door, robot);
    };
  } else if (!request.grasper.empty()) {
    const auto make = [&config, policy = std::shared_ptr<GraspPolicy>(
                                    LoadGraspPolicy(request.grasper, config.grasp))](
                          const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
      return std::make_unique<TrainedGrasp>(SceneOf({.finer = config.grasp_look_finer}, scene),
                                            door, robot, config.cloud, policy);
    };
    players.make_grasp = make;
    players.explain_grasp = [make](const Scene& scene, const DoorAsset& door,
                                   const RobotModel& robot, const SceneSnapshot& snapshot) {
      return make(scene, door, robot)->Consider(snapshot);
    };
  }
}

bool IsSwitchPredicted(const EvaluationRequest& request) {
  return request.config.unlock_switch == "predicted" && !request.handler.empty();
}

void CheckSwitch(const EvaluationRequest& request) {
  const std::string& name = request.config.unlock_switch;
  Require(!request.own.make_handle || request.handler.empty(), ErrorCode::kInvalidArgument,
          "two policies are to turn the handle: one's own and --handler; leave one out");
  Require(name == "privileged" || name == "predicted", ErrorCode::kInvalidConfig,
          "config.switch: \"" + name + "\", expected \"privileged\" or \"predicted\"");
}

void AddHandler(const EvaluationRequest& request, Players& players) {
  if (request.own.make_handle) players.handle = request.own.make_handle();
  if (request.handler.empty()) return;
  if (!IsSwitchPredicted(request)) {
    players.handle = LoadPolicy(request.handler, request.config.policy, "handle");
    return;
  }
  auto handler = LoadTurningPolicy(request.handler, request.config.policy);
  players.predicted_turned = [policy = handler.get()] { return policy->Turned(); };
  players.handle = std::move(handler);
}

// What the policy that turns the handle remembers, by its record.
RememberedViewConfig RememberedBy(const EvaluationRequest& request) {
  if (request.handler.empty()) return {.finer = 0};
  const NetworkView& view = ReadPolicy(request.handler, "handle").networks.normalisation.view;
  return {view.remembered_finer, static_cast<double>(view.cloud_within_m)};
}

Contender ContenderOf(const EvaluationRequest& request) {
  if (IsExpertAlone(request)) return Expert();
  const std::string& base = request.config.scene.physics.base;
  const auto robot = std::make_shared<const RobotModel>(LoadRobot({}, RobotBaseNamed(base)));
  Require(HasProprioception(*robot), ErrorCode::kInvalidConfig,
          "config.scene.physics.base: a policy knows sliders or a fixed base, found " + base);
  return {[&request] {
            Players players;
            if (IsOwn(request))
              players.open = request.own.make_open();
            else if (IsExpert(request))
              players.open = std::make_unique<OpeningExpert>();
            else
              players.open = LoadPolicy(request.policy, request.config.policy);
            AddHandler(request, players);
            AddGrasper(request, players);
            return players;
          },
          [&request, robot, remembered = RememberedBy(request)](const Scene& scene,
                                                                const DoorAsset& door) {
            const CloudConfig& cloud = request.config.cloud;
            auto camera = std::make_unique<CameraObserver>(scene, door, *robot, cloud);
            if (remembered.IsOn()) camera->Remember({scene, door, *robot, cloud, remembered});
            return camera;
          }};
}

std::string NameOfPolicy(const EvaluationRequest& request) {
  if (IsOwn(request)) return request.own.name;
  if (IsExpert(request)) return "expert";
  const fs::path folder = fs::absolute(request.policy).lexically_normal();
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
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

// fills in what the policies' and the data sets' records say
void AddTraining(const EvaluationRequest& request, EvaluationReport& report) {
  if (IsOwn(request)) {
    for (const fs::path& folder : request.data)
      report.trained_on = Union(report.trained_on, SeenPartsOfDataset(folder));
    AddTrainingDoors(request.data, report);
  } else if (!IsExpert(request)) {
    const PolicyRecord policy = ReadPolicy(request.policy);
    report.provenance.policy_sha256 = policy.weights_sha256;
    report.provenance.dataset_sha256 = policy.provenance.dataset_sha256;
    report.losses = internal::TrainingLosses(request.policy);
    AddSeenParts(policy, request.policy, request.allow_seen, report);
    if (!request.data.empty()) RequireSameData(policy, request.data);
    AddTrainingDoors(request.data, report);
  }
  if (request.own.make_handle) report.provenance.handler_sha256 = kOwnPolicy;
  if (!request.handler.empty()) {
    const PolicyRecord handler = ReadPolicy(request.handler, "handle");
    report.provenance.handler_sha256 = handler.weights_sha256;
    AddSeenParts(handler, request.handler, request.allow_seen, report);
  }
  if (IsRandomGrasper(request)) report.provenance.grasper_sha256 = "random";
  if (!request.grasper.empty() && !IsRandomGrasper(request)) {
    const PolicyRecord grasper = ReadPolicy(request.grasper, "grasp");
    report.provenance.grasper_sha256 = grasper.weights_sha256;
    AddSeenParts(grasper, request.grasper, request.allow_seen, report);
  }
  if (!request.allow_seen) RequireHeldOut(report);
}

std::vector<EvaluatedEpisode> RunWithProgress(const std::string& title, const TrialPlan& trials,
                                              const Contender& contender, int threads) {
  Progress progress(title, trials.size());
  std::atomic<int> opened = 0;
  std::atomic<int> done = 0;
  return RunTrials(trials, contender,
                   {.threads = threads, .done = [&](const EvaluatedEpisode& row) {
                      opened += row.outcome == EpisodeOutcome::kOpened ? 1 : 0;
                      const int percent = 100 * opened / ++done;
                      progress.Advance(1, "opened " + std::to_string(percent) + " %");
                    }});
}

EvaluationReport NewReport(const EvaluationRequest& request, const std::vector<FoundDoor>& doors) {
  EvaluationReport report;
  report.provenance.policy = NameOfPolicy(request);
  report.provenance.code_version = CodeVersion();
  report.provenance.command = request.command;
  report.provenance.config = ToJson(request.config);
  for (const FoundDoor& door : doors) report.doors.push_back(door.identity);
  return report;
}

}  // namespace

Evaluation EvaluateOpener(const EvaluationRequest& request) {
  CheckSwitch(request);
  const DoorSet set = FindDoorSet(request.doors, request.threads);
  const std::vector<FoundDoor>& doors = set.doors;
  DoorShelf shelf(doors);
  const TrialPlan trials([&](std::size_t door) { return shelf.Take(door); }, doors.size(),
                         request.config);
  Evaluation evaluation;
  EvaluationReport& report = evaluation.report;
  report = NewReport(request, doors);
  evaluation.notes = set.notes;
  AddTraining(request, report);

  const Contender contender = ContenderOf(request);
  report.episodes = RunWithProgress("evaluate", trials, contender, request.threads);
  if (!IsExpertAlone(request) && request.config.expert_reference)
    report.reference = RunWithProgress("expert", trials, Expert(), request.threads);

  evaluation.pictures = TakePictures({trials, report.episodes}, contender, request.threads);
  for (const fs::path& data : request.data)
    evaluation.pictures.doors.merge(internal::TrainingPreviews(data, kTrainingPreviews));
  return evaluation;
}

}  // namespace doorforge
