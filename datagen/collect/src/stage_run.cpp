// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/stage_run.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/rollout/proprioception.h"

namespace doorforge {
namespace {

constexpr std::size_t kDoorsLookedAtFirst = 8;

RobotModel RobotFor(const StageConfig& config, const RobotMeshReader& read_mesh) {
  RobotModel robot = LoadRobot(config.scene.robot, config.scene.physics.base, read_mesh);
  Require(HasProprioception(robot), ErrorCode::kInvalidArgument,
          "config.scene: data are recorded for robots with two sliders or a fixed base, seven arm "
          "joints and two fingers, and for flying hands; let others open doors with `doorforge "
          "simulate`");
  return robot;
}

StageConfig Checked(const StageRequest& request) {
  CheckStageConfig(request.config);
  return request.config;
}

std::set<Mechanism> MechanismsFor(const StageConfig& config) {
  std::set<Mechanism> mechanisms;
  for (const std::string& name : config.collection.mechanisms) {
    const auto mechanism = MechanismNamed(name);
    Require(mechanism.has_value(), ErrorCode::kInvalidConfig,
            "config.collection.mechanisms: \"" + name +
                "\", expected none, lever, round, key, valve or flap");
    mechanisms.insert(*mechanism);
  }
  return mechanisms;
}

std::vector<FoundDoor> DoorsFor(const StageRequest& request) {
  DoorSet set = FindDoorSet(DoorSelectionOf(request.doors, "train"), request.threads);
  for (const std::string& note : set.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  std::vector<FoundDoor> doors = std::move(set.doors);
  const std::set<Mechanism> wanted = MechanismsFor(request.config);
  const std::size_t all = doors.size();
  std::erase_if(doors, [&](const FoundDoor& door) {
    return !wanted.empty() && !wanted.contains(door.identity.mechanism);
  });
  Require(!doors.empty(), ErrorCode::kInvalidArgument,
          "none of the " + std::to_string(all) +
              " doors has a mechanism of config.collection.mechanisms; compose such doors, or name "
              "others");
  if (request.config.stage != Stage::kHandle) return doors;
  // there is no handle to turn where there is no latch
  std::erase_if(doors,
                [](const FoundDoor& door) { return door.identity.mechanism == Mechanism::kNone; });
  Require(!doors.empty(), ErrorCode::kInvalidArgument,
          "none of the " + std::to_string(all) +
              " doors has a latch; the stage \"handle\" needs handles that turn");
  return doors;
}

// What the plan needs of the doors, in their order.
std::vector<DoorParts> PartsOf(const std::vector<FoundDoor>& doors) {
  std::vector<DoorParts> parts;
  for (const auto& [door, folder, is_indexed] : doors)
    parts.push_back({door.id, std::string(NameOf(door.category)),
                     std::string(NameOf(door.mechanism)), door.body, door.handle});
  return parts;
}

// Hash over all doors' ids and hashes.
std::string HashOf(const std::vector<FoundDoor>& doors) {
  Sha256 hash;
  for (const FoundDoor& door : doors)
    hash.Update(door.identity.id + "\n" + door.identity.sha256 + "\n");
  return hash.HexDigest();
}

}  // namespace

StageRun::StageRun(const StageRequest& request)
    : config_(Checked(request)),
      robot_(RobotFor(config_, request.robot_meshes)),
      policies_(std::make_unique<StagePolicies>(config_, request.policies, request.registry)),
      doors_(DoorsFor(request)),
      shelf_(doors_),
      plan_(MakePlan(PartsOf(doors_), config_.episodes, config_.seed, config_.collection)) {
  CheckPictures(config_.pictures, robot_);
  CheckPictureCameras();
}

// A camera within one door is within others, too: of the first episodes it is said before any work,
// and whatever episode comes upon it later ends the collection.
void StageRun::CheckPictureCameras() {
  if (!config_.pictures.IsOn()) return;
  const std::vector<PlannedEpisode>& episodes = plan_.shards.front().episodes;
  for (std::size_t i = 0; i < std::min(kDoorsLookedAtFirst, episodes.size()); ++i) {
    try {
      const IdentifiedDoor door = shelf_.Take(episodes[i].door);
      CheckPictures(config_.pictures,
                    SampleScene(door, config_.seed, episodes[i].number, config_.scene), *door);
    } catch (const Error& error) {
      // a door that cannot be simulated is a failed episode
      if (error.code() == ErrorCode::kInvalidConfig) throw;
    }
  }
}

// The effective config. A comment names what else decides the bytes, so that a run on other doors,
// with another build or another policy is noticed when it is resumed.
std::string StageRun::ConfigText() const {
  std::string text =
      "# doorforge datagen " + std::string(NameOf(config_.stage)) + ", " + CodeVersion() + "\n# " +
      std::to_string(doors_.size()) + " doors, sha256 " + HashOf(doors_) + "\n# robot " +
      (robot_.name().empty() ? "embedded" : robot_.name() + ", sha256 " + robot_.sha256()) +
      ", rays by " + RayCasterVersion() + "\n";
  return text + policies_->Text() + JsonText(ToJson(config_), 2) + "\n";
}

CollectRequest StageRun::Request() const {
  CollectRequest request;
  request.stage = NameOf(config_.stage);
  request.config_text = ConfigText();
  request.provenance.code_version = CodeVersion();
  request.provenance.compiler = __VERSION__;
  request.provenance.libraries = {{"ray_caster", RayCasterVersion()}};
  for (const TrainedPolicy& policy : policies_->Trained())
    request.provenance.policies.push_back(policy.identity);
  request.provenance.seed = config_.seed;
  for (const FoundDoor& door : doors_)
    request.provenance.doors.push_back(DatasetDoorOf(door.identity));
  return request;
}

CollectedEpisode StageRun::Run(const PlannedEpisode& planned) {
  return RunStageEpisode(planned, shelf_.Take(planned.door), robot_, config_, *policies_);
}

EpisodeFilm StageRun::Film(const PlannedEpisode& planned) {
  return FilmStageEpisode(planned, shelf_.Take(planned.door), robot_, config_, *policies_);
}

}  // namespace doorforge
