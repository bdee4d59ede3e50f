// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How well a policy tells foreign pictures from sound ones: episodes on doors of a split, by the
// policies themselves; at every few decisions the picture is replaced by what a camera may show
// instead, and its distance compared with the limit that the training's validation samples set.
//
//   foreign_pictures --doors full:test build/doors --opener O --handler H --grasper G

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/gain_critic.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_set.h"

#include "foreign_scenes.h"

namespace doorforge::benchmark {
namespace {

constexpr double kDegree = 3.141592653589793 / 180;
constexpr int kPoints = 4096;

struct Options {
  std::vector<std::string> doors;
  std::string opener;
  std::string handler;
  std::string grasper;
  int per_category = 10;
  int every = 4;
  double percentile = 99;
  std::uint64_t seed = 5;
};

/// What was found of one kind of picture.
struct Findings {
  std::vector<double> distances;
  std::vector<double> gains;
  int refused = 0;
};

/// A stage's policy, and what it found.
struct Judge {
  std::string stage;
  PolicyRecord record;
  Familiarity familiarity;
  std::vector<std::string> kinds;  // in the order in which they came
  std::map<std::string, Findings> findings;

  Judge(std::string stage_name, const std::string& folder)
      : stage(std::move(stage_name)), record(ReadPolicy(folder, stage)) {
    const NetworkFamily family = FamilyOf(stage);
    auto read = ReadFamiliarity(folder, record.provenance.dataset_sha256, family);
    Require(read.has_value(), ErrorCode::kMissing,
            folder + ": has no familiar.safetensors; run its training again with --resume");
    familiarity = std::move(*read);
  }

  Findings& Of(const std::string& kind) {
    if (findings.count(kind) == 0) kinds.push_back(kind);
    return findings[kind];
  }
};

// The chance that a foreign picture is farther than a sound one.
double AreaUnderCurve(const std::vector<double>& sound, const std::vector<double>& foreign) {
  double wins = 0;
  for (const double f : foreign) {
    for (const double s : sound) wins += f > s ? 1 : (f == s ? 0.5 : 0);
  }
  return wins / static_cast<double>(sound.size() * foreign.size());
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void Print(const Judge& judge, double percentile) {
  const double limit = judge.familiarity.DistanceAt(percentile);
  std::printf("\n%s: limit %.2f (%g %% of %zu validation samples are nearer)\n",
              judge.stage.c_str(), limit, percentile, judge.familiarity.distances.size());
  std::printf("%-32s %6s %8s %7s %7s %9s %10s\n", "picture", "n", "refused", "held", "AUC",
              "distance", "gain [deg]");
  const auto sound = judge.findings.find("sound");
  if (sound == judge.findings.end()) return;
  for (const std::string& kind : judge.kinds) {
    const Findings& found = judge.findings.at(kind);
    const std::size_t count = found.distances.size();
    std::printf("%-32s %6zu %8d ", kind.c_str(), count + static_cast<std::size_t>(found.refused),
                found.refused);
    if (count == 0) {
      std::printf("%7s %7s\n", "-", "-");
      continue;
    }
    const auto held = std::ranges::count_if(found.distances, [&](double d) { return d > limit; });
    std::printf("%5.1f %% %7.3f %9.2f %10.2f\n",
                100 * static_cast<double>(held) / static_cast<double>(count),
                AreaUnderCurve(sound->second.distances, found.distances), Median(found.distances),
                Median(found.gains) / kDegree);
  }
}

/// Keeps the picture that a decision is made from.
class Photographer : public Observer {
 public:
  Photographer(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
      : camera_(scene, door, robot) {}
  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    CameraFrame frame = camera_.Render(snapshot);
    depth = std::move(frame.depth);
    tcp = snapshot.robot.world_from_tcp.translation();
    return frame.sampled.cloud;
  }

  DepthImage depth;
  Eigen::Vector3d tcp = Eigen::Vector3d::Zero();

 private:
  CameraObserver camera_;
};

/// Acts as a policy, and shows other pictures to its judge at every few decisions.
class Shown : public Policy {
 public:
  Shown(Judge& judge, const Photographer& photographer, const PinholeView& view,
        const Options& options, std::uint64_t episode)
      : judge_(judge),
        photographer_(photographer),
        view_(view),
        every_(static_cast<std::uint64_t>(options.every)),
        rng_(options.seed, "foreign/" + judge.stage + "/" + std::to_string(episode)),
        count_(episode),
        policy_(MakePolicy(judge.record.networks)),
        critic_(judge.record.networks) {}

  Action Act(const Observation& observation) override {
    if (count_++ % every_ == 0) {
      for (const Shot& shot : ForeignShots(photographer_.depth, view_, rng_))
        Judged(shot, observation.proprioception);
    }
    return policy_->Act(observation);
  }

 private:
  void Judged(const Shot& shot, const Proprioception& proprioception) {
    Findings& found = judge_.Of(shot.kind);
    const LabelledCloud visible = CropCloud(shot.depth, shot.view);
    if (visible.label.empty()) {  // fewer than 4096 points are filled up as the recorder does
      ++found.refused;
      return;
    }
    Observation seen;
    seen.cloud = SampleCloud(visible, photographer_.tcp, {}).cloud;
    seen.proprioception = proprioception;
    found.distances.push_back(judge_.familiarity.DistanceOf(SightNumbersOf(
        {seen.cloud.xyz, seen.cloud.label}, proprioception, NetworkFamily::kMotion)));
    found.gains.push_back(critic_.GainOf(seen, policy_->Act(seen)));
  }

  Judge& judge_;
  const Photographer& photographer_;
  PinholeView view_;
  std::uint64_t every_;
  Rng rng_;
  std::uint64_t count_;
  std::unique_ptr<Policy> policy_;
  GainCritic critic_;
};

/// ShownGrasp shows the judge foreign pictures where the grasp is chosen.
class ShownGrasp : public SnapshotGraspPolicy {
 public:
  ShownGrasp(Judge& judge, CameraObserver& camera, const PinholeView& view, Rng rng)
      : judge_(judge),
        camera_(camera),
        view_(view),
        rng_(std::move(rng)),
        policy_(MakeGraspPolicy(judge.record.networks)) {}

  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    const DepthImage depth = camera_.Render(snapshot).depth;
    const Eigen::Vector3d approach = -snapshot.door[kHandleLink].linear().col(0);
    std::optional<GraspAction> grasp;
    for (const Shot& shot : ForeignLooks(depth, view_, rng_)) {
      const std::optional<GraspAction> choice = Judged(shot, approach);
      if (choice && shot.kind == "sound")
        grasp = GraspAction{choice->cloud, choice->contact_m, choice->world_from_hand_rotation};
    }
    return grasp;
  }

 private:
  std::optional<GraspAction> Judged(const Shot& shot, const Eigen::Vector3d& approach) {
    Findings& found = judge_.Of(shot.kind);
    GraspObservation view;
    view.visible = CropCloud(shot.depth, shot.view);
    view.approach = approach;
    view.sample = [&](const Eigen::Vector3d& start, double crop_radius_m) {
      return SampleCloud(view.visible, start, {kPoints, crop_radius_m}).cloud;
    };
    std::optional<GraspAction> choice;
    if (!view.visible.label.empty()) choice = policy_->Choose(view);
    if (!choice) {
      ++found.refused;
      return choice;
    }
    found.distances.push_back(judge_.familiarity.DistanceOf(
        SightNumbersOf({choice->cloud.xyz, choice->cloud.label}, {}, NetworkFamily::kGrasp)));
    found.gains.push_back(choice->explanation->expected_opening_rad);
    return choice;
  }

  Judge& judge_;
  CameraObserver& camera_;
  PinholeView view_;
  Rng rng_;
  std::unique_ptr<GraspPolicy> policy_;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("How well policies tell foreign pictures from sound ones.", "foreign_pictures");
  app.add_option("--doors", options.doors, "folders of doors, and a split")->required();
  app.add_option("--opener", options.opener, "folder of a policy")->required();
  app.add_option("--handler", options.handler, "folder of a policy")->required();
  app.add_option("--grasper", options.grasper, "folder of a policy")->required();
  app.add_option("-n,--per-category", options.per_category, "doors")->capture_default_str();
  app.add_option("--every", options.every, "decisions between two")->capture_default_str();
  app.add_option("--percentile", options.percentile, "the limit")->capture_default_str();
  app.add_option("--seed", options.seed, "of the episodes")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return options;
}

int Run(const Options& options) {
  Judge grasper("grasp", options.grasper);
  Judge handler("handle", options.handler);
  Judge opener("open", options.opener);
  DoorSelection selection = DoorSelectionOf(options.doors, "train");
  selection.per_category = options.per_category;
  const std::vector<FoundDoor> doors = FindDoorSet(selection, 1).doors;
  DoorCache shelf(doors);
  const RobotModel robot = LoadRobot({}, RobotBase::kSliders);
  for (std::size_t d = 0; d < doors.size() && StopRequested() == 0; ++d) {
    const auto door = shelf.Take(d);
    const Scene scene = PlaceRobotBase(robot, SampleScene(door, options.seed, 0), *door);
    const Scene close_up = SceneOf(GraspCameraConfig{}, scene);
    CameraObserver look(close_up, *door, robot, {}, /*sees_robot=*/false);
    Photographer photographer(scene, *door, robot);
    ShownGrasp grasp(grasper, look, ViewOf(close_up.camera),
                     Rng(options.seed, "foreign/grasp/" + std::to_string(d)));
    Shown turn(handler, photographer, ViewOf(scene.camera), options, d);
    Shown open(opener, photographer, ViewOf(scene.camera), options, d);
    RunStages(scene, *door, robot, {.grasp = &grasp, .handle = &turn, .open = &open},
              &photographer);
    std::fprintf(stderr, "\r%zu of %zu doors ", d + 1, doors.size());
  }
  for (const Judge* judge : {&grasper, &handler, &opener}) Print(*judge, options.percentile);
  return 0;
}

}  // namespace
}  // namespace doorforge::benchmark

int main(int argc, char** argv) {
  return doorforge::RunProgram(
      [&] { return doorforge::benchmark::Run(doorforge::benchmark::Parse(argc, argv)); });
}
