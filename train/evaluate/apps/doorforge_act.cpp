// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// From a real depth picture and a robot's state to the hand's next pose.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/core/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/evaluate/robot_sight.h"
#include "doorforge/learn/checkpoint.h"
#include "doorforge/learn/grasp_policy.h"
#include "doorforge/learn/stage_policy.h"
#include "doorforge/learn/turning_policy.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kDecisionSchemaVersion = 1;
constexpr std::uint64_t kMostPictureBytes = 512ULL << 20U;

/// What --set holds.
struct ActConfig {
  PolicyOptions policy;
  GraspOptions grasp;
  CloudConfig cloud;  ///< As in the data set that the policies were trained from.
  /// About the world's z, from the world's x to the way straight out of the closed leaf.
  double door_yaw_rad = 0;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("policy", self.policy);
    visit("grasp", self.grasp);
    visit("cloud", self.cloud);
    visit("door_yaw_rad", self.door_yaw_rad);
  }
};

struct Options {
  std::string depth;
  std::string state;
  std::string camera;
  std::string policy;
  std::string handler;
  std::string grasper;
  std::string handle;
  std::string stage = "auto";
  std::string base = "sliders";
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> candidates;
  bool stream = false;
};

void AddOptions(CLI::App& app, Options& options) {
  app.add_option("--depth", options.depth, "16-bit depth picture (PNG)");
  app.add_option("--state", options.state, "robot's state at that moment (YAML)");
  app.add_flag("--stream", options.stream,
               "instead of --depth and --state: a decision for every line of standard input, "
               "{\"depth\": FILE, \"state\": FILE} or {\"depth\": FILE, \"handle\": FILE}");
  app.add_option("--handle", options.handle,
                 "instead of --state, before the robot moves: which pixels show the handle (grey "
                 "PNG, not 0 where it is); says where and how to take hold");
  app.add_option("--camera", options.camera, "intrinsics and pose of the camera (YAML)")
      ->required();
  app.add_option("--policy", options.policy, "folder of a policy of `doorforge train open`");
  app.add_option("--handler", options.handler, "folder of a policy of `doorforge train handle`");
  app.add_option("--grasper", options.grasper, "folder of a policy of `doorforge train grasp`");
  app.add_option("--stage", options.stage,
                 "which of them acts: open, handle, or auto: as the state says (unlocked)")
      ->check(CLI::IsMember({"auto", "open", "handle"}))
      ->capture_default_str();
  app.add_option("--base", options.base, "what the robot stands on")
      ->check(CLI::IsMember({"sliders", "fixed"}))
      ->capture_default_str();
  app.add_option("--candidates", options.candidates,
                 "actions among which the critic chooses (config: policy.candidates, 1)");
  app.add_option("--config", options.config, "YAML file with settings")->check(CLI::ExistingFile);
  AddSettings(app, options.settings, "a.b=c overrides one setting, e.g. cloud.max_depth_m");
  app.footer(
      "Prints the hand's next pose as JSON. docs/act.md has the files of camera and state.\n\n"
      "examples:\n"
      "  doorforge act --depth d.png --camera camera.yaml --handle mask.png --grasper run/grasper\n"
      "  doorforge act --depth d.png --camera camera.yaml --state state.yaml --policy run/opener "
      "--stage open\n"
      "  doorforge act --stream --camera camera.yaml --policy run/opener --handler run/handler");
}

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("From a depth picture and the robot's state to the hand's next pose.",
               "doorforge act");
  AddOptions(app, options);
  ParseVerb(app, argc, argv);
  const bool one = !options.depth.empty() && options.state.empty() != options.handle.empty();
  const bool none = options.depth.empty() && options.state.empty() && options.handle.empty();
  if (options.stream ? !none : !one)
    throw Error(ErrorCode::kInvalidArgument,
                "--depth and either --state or --handle, or --stream in place of them, are "
                "required; see `doorforge act --help`");
  if (options.policy.empty() && options.handler.empty() && options.grasper.empty())
    throw Error(ErrorCode::kInvalidArgument,
                "--policy, --handler or --grasper is required; see `doorforge act --help`");
  return options;
}

ActConfig ConfigOf(const Options& options) {
  auto config = LoadConfig<ActConfig>(options.config, options.settings);
  if (options.candidates) config.policy.candidates = *options.candidates;
  Require(config.cloud.point_count == 4096, ErrorCode::kInvalidConfig,
          "cloud.point_count: policies read 4096 points");
  return config;
}

/// A policy of one stage, ready to act, and the hash of its weights.
struct Actor {
  std::unique_ptr<Policy> policy;
  std::string weights_sha256;
  const TurningPolicy* turning = nullptr;  // the same, where it says when the handle is turned
};

std::optional<Actor> LoadActor(const std::string& folder, Stage stage,
                               const PolicyOptions& options) {
  if (folder.empty()) return std::nullopt;
  PolicyRecord record = ReadPolicy(folder, NameOf(stage));
  Actor actor{MakePolicy(std::move(record.networks), options), record.weights_sha256};
  actor.policy->Reset();
  return actor;
}

std::optional<Actor> LoadHandler(const std::string& folder, const PolicyOptions& options) {
  std::optional<Actor> actor = LoadActor(folder, Stage::kHandle, options);
  if (!actor) return actor;
  const auto classifier = ReadTurnedClassifier(
      folder, ReadPolicy(folder, NameOf(Stage::kHandle)).provenance.dataset_sha256);
  if (!classifier) return actor;
  auto turning = std::make_unique<TurningPolicy>(std::move(actor->policy), *classifier);
  actor->turning = turning.get();
  actor->policy = std::move(turning);
  return actor;
}

struct Grasper {
  std::unique_ptr<GraspPolicy> policy;
  std::string weights_sha256;
};

std::optional<Grasper> LoadGrasper(const std::string& folder, const GraspOptions& options) {
  if (folder.empty()) return std::nullopt;
  PolicyRecord record = ReadPolicy(folder, NameOf(Stage::kGrasp));
  return Grasper{MakeGraspPolicy(std::move(record.networks), options), record.weights_sha256};
}

// What of a picture does not fit its camera or another picture is said of these files.
template <class Look>
auto NamingFiles(const std::string& files, const Look& look) {
  try {
    return look();
  } catch (const Error& error) {
    throw Error(error.code(), files + ": " + error.what());
  }
}

/// Decides picture by picture, as one episode: what has been unlocked stays unlocked.
class Decider {
 public:
  explicit Decider(const Options& options)
      : stage_(options.stage),
        camera_name_(options.camera),
        stream_(options.stream),
        config_(ConfigOf(options)),
        robot_(LoadRobot({}, RobotBaseNamed(options.base))),
        camera_(ReadCalibratedCamera(options.camera)),
        opener_(LoadActor(options.policy, Stage::kOpen, config_.policy)),
        handler_(LoadHandler(options.handler, config_.policy)),
        grasper_(LoadGrasper(options.grasper, config_.grasp)) {}

  // Where and how to take hold of the handle that a mask shows.
  Json DecideGrasp(const fs::path& depth_path, const fs::path& handle_path) {
    if (!grasper_)
      throw Error(ErrorCode::kInvalidArgument,
                  "a grasp is to be chosen, and --grasper, which chooses it, was not given");
    const double yaw = config_.door_yaw_rad;
    const DepthImage depth = ReadDepth(depth_path);
    const PixelMask handle =
        DecodeMaskPng(ReadFile(handle_path, kMostPictureBytes), handle_path.string());
    const HandleSight sight = NamingFiles(
        depth_path.string() + ", " + handle_path.string() + " and " + camera_name_, [&] {
          return ObserveHandle(depth, handle, camera_,
                               -Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0), config_.cloud);
        });
    return Record(*grasper_->policy->Choose(sight.view), sight);
  }

  Json Decide(const fs::path& depth_path, const fs::path& state_path) {
    const RobotState state = ReadRobotState(state_path, robot_);
    const DepthImage depth = ReadDepth(depth_path);
    const Stage stage = StageOf(state, state_path.string());
    const RobotSight sight = NamingFiles(depth_path.string() + " and " + camera_name_, [&] {
      return ObserveDepth(depth, camera_, state, config_.cloud);
    });
    Actor& actor = ActorOf(stage);
    return Record(stage, actor, state, sight, actor.policy->Act(sight.observation));
  }

 private:
  DepthImage ReadDepth(const fs::path& path) const {
    return DecodeDepthPng(ReadFile(path, kMostPictureBytes), camera_.metres_per_unit,
                          path.string());
  }

  Json Record(const GraspChoice& choice, const HandleSight& sight) const {
    RigidTransform world_from_tcp = RigidTransform::Identity();
    world_from_tcp.linear() = choice.world_from_hand_rotation * robot_.hand_from_tcp().linear();
    world_from_tcp.translation() =
        choice.contact_m + kGraspInsertion * choice.world_from_hand_rotation.col(2);
    return {{"schema", "doorforge.decision"},
            {"schema_version", kDecisionSchemaVersion},
            {"stage", NameOf(Stage::kGrasp)},
            {"world_from_hand", TransformToJson(world_from_tcp * robot_.hand_from_tcp().inverse())},
            {"contact_m", Vector3ToJson(choice.contact_m)},
            {"expected_door_angle_rad", choice.score_rad},
            {"candidates", config_.grasp.points * config_.grasp.orientations},
            {"visible_points", sight.visible_count},
            {"handle_points", sight.handle_count},
            {"weights_sha256", grasper_->weights_sha256}};
  }

  Stage StageOf(const RobotState& state, const std::string& path) {
    if (stage_ != "auto") return *StageNamed(stage_);
    if (!state.unlocked && !unlocked_ && !Predicts())
      throw Error(ErrorCode::kInvalidConfig,
                  path +
                      ": the key \"unlocked\" is missing, which says whether the handle has "
                      "been turned; pass --stage, or use --stream with a --handler that says it "
                      "itself (it has a turned.safetensors)");
    unlocked_ = unlocked_ || (state.unlocked ? *state.unlocked : handler_->turning->Turned());
    return unlocked_ ? Stage::kOpen : Stage::kHandle;
  }

  // Whether the handle policy can say when the handle is turned: it has seen the episode so far.
  bool Predicts() const { return stream_ && handler_ && handler_->turning != nullptr; }

  Actor& ActorOf(Stage stage) {
    std::optional<Actor>& actor = stage == Stage::kOpen ? opener_ : handler_;
    if (!actor)
      throw Error(ErrorCode::kInvalidArgument,
                  stage == Stage::kOpen
                      ? "the door is to be opened, and --policy, which opens, was not given"
                      : "the handle is to be turned (unlocked: false), and --handler, which turns "
                        "it, was not given; pass it, or --stage open");
    return *actor;
  }

  Json Record(Stage stage, const Actor& actor, const RobotState& state, const RobotSight& sight,
              const Action& action) const {
    RigidTransform target = RigidTransform::Identity();
    target.linear() = action.world_from_hand_rotation;
    target.translation() = state.world_from_hand.translation() + action.position_delta_m;
    Json record = {{"schema", "doorforge.decision"},
                   {"schema_version", kDecisionSchemaVersion},
                   {"stage", NameOf(stage)},
                   {"world_from_hand", TransformToJson(target)},
                   {"position_delta_m", Vector3ToJson(action.position_delta_m)},
                   {"candidates", config_.policy.candidates},
                   {"visible_points", sight.visible_count},
                   {"weights_sha256", actor.weights_sha256}};
    if (stage == Stage::kHandle && Predicts()) record["turned"] = handler_->turning->Turned();
    return record;
  }

  std::string stage_;
  std::string camera_name_;
  bool stream_;
  ActConfig config_;
  RobotModel robot_;
  CalibratedCamera camera_;
  std::optional<Actor> opener_;
  std::optional<Actor> handler_;
  std::optional<Grasper> grasper_;
  bool unlocked_ = false;
};

Json DecideLine(Decider& decider, const std::string& line) {
  const Json request = ParseJson(line, "line");
  if (!request.is_object())
    throw Error(ErrorCode::kFormat, "expected a line {\"depth\": FILE, \"state\": FILE}");
  if (request.contains("handle"))
    return decider.DecideGrasp(ValueOf<std::string>(request, "depth", "line"),
                               ValueOf<std::string>(request, "handle", "line"));
  return decider.Decide(ValueOf<std::string>(request, "depth", "line"),
                        ValueOf<std::string>(request, "state", "line"));
}

// A picture that cannot be used is answered and the loop goes on: the robot holds still meanwhile.
int Stream(Decider& decider) {
  int failures = 0;
  for (std::string line; StopRequested() == 0 && std::getline(std::cin, line);) {
    if (line.empty()) continue;
    Json answer;
    try {
      answer = DecideLine(decider, line);
    } catch (const Error& error) {
      ++failures;
      answer = {{"schema", "doorforge.decision"},
                {"schema_version", kDecisionSchemaVersion},
                {"error", error.what()}};
    }
    std::cout << JsonText(answer) << std::endl;  // flushed: a robot waits for it
  }
  if (StopRequested() != 0) return 128 + StopRequested();
  return failures == 0 ? 0 : 1;
}

int Act(const Options& options) {
  Decider decider(options);
  if (options.stream) return Stream(decider);
  const Json decision = options.handle.empty() ? decider.Decide(options.depth, options.state)
                                               : decider.DecideGrasp(options.depth, options.handle);
  std::cout << JsonText(decision, 2) << "\n";
  return 0;
}

// `doorforge act ...` starts this program with the verb as first argument
int Run(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "act") {
    --argc;
    ++argv;
  }
  const Options options = Parse(argc, argv);
  return NamingConfig(options.config, [&] { return Act(options); });
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
