// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/episode_page.h"

#include <algorithm>
#include <map>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/rollout/proprioception.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode_arrays.h"

#include "door_finder.h"
#include "episode_writer.h"
#include "expert_film.h"
#include "film_forces.h"
#include "html_page.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::EpisodeWriter;
using internal::Film;
using internal::FilmFrame;
using internal::PageContent;
using Json = PageContent::Json;

struct Stored {
  Film film;
  Scene scene;
  std::vector<JointState> states;  // one a frame
};

Scene SceneOf(const Json& meta, const std::string& where) {
  return SceneFromJson(MemberOf(meta, "scene", where), where + ".scene");
}

// What was hidden at a decision, where it is recorded.
std::string HiddenText(const Json& meta) {
  const auto hidden = meta.find("hidden");
  if (hidden == meta.end() || !hidden->is_object()) return {};
  std::string text;
  for (const auto& [name, shares] : hidden->items()) {
    if (!shares.is_array()) continue;
    double most = 0;
    for (const Json& share : shares)
      most = std::max(most, share.is_number() ? share.get<double>() : 0);
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    text += (text.empty() ? "" : ", ") + words + " up to " +
            std::to_string(static_cast<int>(std::lround(100 * most))) + " %";
  }
  return text;
}

// What is hidden, over time.
std::vector<std::pair<std::string, std::vector<double>>> HiddenShares(const Json& meta,
                                                                      std::size_t decisions) {
  std::vector<std::pair<std::string, std::vector<double>>> hidden;
  const auto found = meta.find("hidden");
  if (found == meta.end() || !found->is_object()) return hidden;
  for (const auto& [name, shares] : found->items()) {
    if (!shares.is_array() || shares.size() != decisions) continue;
    std::vector<double> numbers;
    for (const Json& share : shares) numbers.push_back(share.is_number() ? share.get<double>() : 0);
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    hidden.emplace_back(words, std::move(numbers));
  }
  return hidden;
}

FilmFrame FrameOf(const EpisodeArrays& arrays, std::size_t t, const Scene& scene,
                  const RobotModel& robot) {
  const std::span<const double> state = arrays.state.subspan(t * std::tuple_size_v<JointState>);
  FilmFrame frame;
  frame.hinge_rad = state[kStateHinge];
  frame.handle_rad = state[kStateHandle];
  frame.bolt_m = state[kStateBolt];
  const ProprioceptionPlaces places = ProprioceptionPlacesOf(robot);
  JointVector position = JointVector::Zero(robot.joint_count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places.at(i) >= 0) position[places.at(i)] = state[i];
  }
  const RobotPose pose = robot.PoseAt(position, scene.world_from_robot_base);
  frame.hand_m = pose.world_from_hand.translation();
  const std::span<const float> action = arrays.action.subspan(9 * t, 3);
  frame.asked_m = Eigen::Vector3d(action[0], action[1], action[2]) + frame.hand_m;
  const std::size_t points = arrays.points;
  const auto cloud = arrays.cloud.subspan(3 * points * t, 3 * points);
  const auto label = arrays.label.subspan(points * t, points);
  frame.cloud = {{cloud.begin(), cloud.end()}, {label.begin(), label.end()}};
  frame.poses = internal::PosesOf({}, pose);
  return frame;
}

// The door's poses are filled in when its joints are known. `robot` is loaded, on its base, for the
// first episode, and the others are of it.
Stored ReadStored(const ShardReader& shard, std::size_t episode, const ShownRobot& source,
                  std::optional<RobotModel>& shown) {
  const Json meta = ReadEpisodeMeta(shard, episode);
  const std::string where = shard.Describe(episode, "meta.json");
  const Scene scene = SceneOf(meta, where);
  if (!shown) shown = LoadRobot(source.urdf, scene.physics.base, source.read_mesh);
  const RobotModel& robot = *shown;
  const EpisodeArrays arrays = ViewEpisode(shard, episode);
  if (arrays.state.empty())
    throw Error(ErrorCode::kFormat,
                shard.Describe(episode, "state.npy") +
                    ": the episode has no states, as builds of before wrote it");
  if (scene.robot.name != robot.name() || scene.robot.sha256 != robot.sha256())
    throw Error(ErrorCode::kInvalidArgument,
                where + ": the robot is " +
                    (scene.robot.name.empty() ? "the built-in one" : scene.robot.name) +
                    (scene.robot.name == robot.name() ? ", which has changed since"
                                                      : "; --robot names its URDF"));
  if (scene.physics.base != robot.base())
    throw Error(ErrorCode::kInvalidArgument,
                where + ": its robot stands on another base than that of the first episode");
  const std::string& key = shard.index().episodes[episode].key;
  const std::string stage = shard.index().header.stage;
  const std::string outcome = ValueOf<std::string>(meta, "outcome", where);
  Stored stored{{.title = stage + " " + key + ", " + scene.door_id,
                 .opened = outcome == "opened",
                 .facts = {{"Episode", key + " of " + stage + "/" + shard.index().header.split},
                           {"Door", scene.door_id},
                           {"Outcome", outcome},
                           {"Detail", ValueOf<std::string>(meta, "detail", where)},
                           {"Seed, number",
                            std::to_string(scene.seed) + ", " + std::to_string(scene.episode)}},
                 .frames = {}},
                scene,
                {}};
  if (const std::string hidden = HiddenText(meta); !hidden.empty())
    stored.film.facts.emplace_back("Hidden", hidden);
  stored.film.hidden = HiddenShares(meta, arrays.decisions);
  const Json& times = MemberOf(meta, "decision_time_s", where);
  for (std::size_t t = 0; t < arrays.decisions; ++t) {
    stored.film.frames.push_back(FrameOf(arrays, t, scene, robot));
    const auto state = arrays.state.subspan(t * std::tuple_size_v<JointState>);
    std::ranges::copy_n(state.begin(), std::tuple_size_v<JointState>,
                        stored.states.emplace_back().begin());
    FilmFrame& frame = stored.film.frames.back();
    frame.phase = stage;
    frame.time_s = t < times.size() && times[t].is_number() ? times[t].get<double>() : 0;
    if (stage == "grasp")
      frame.asked_m = *frame.asked_m - frame.hand_m;  // the contact point itself
    frame.poses[kBaseLink] = scene.world_from_door;
  }
  shard.RequireWhole();
  return stored;
}

void PoseDoor(const DoorAsset& door, Film& film) {
  for (FilmFrame& frame : film.frames) {
    const RigidTransform world_from_door = frame.poses[kBaseLink];
    const auto links = DoorFromLinks(door, frame.hinge_rad, frame.handle_rad);
    for (std::size_t i = 0; i < links.size(); ++i) frame.poses[i] = world_from_door * links[i];
  }
}

std::vector<fs::path> ShardsOf(const DatasetEpisodes& chosen) {
  std::vector<fs::path> shards;
  for (const DatasetPart& part : ReadDataset(chosen.dataset).parts) {
    if (!chosen.stage.empty() && part.stage != chosen.stage) continue;
    for (std::uint64_t i = 0; i < part.shards; ++i)
      shards.push_back(chosen.dataset / part.stage / part.split /
                       (ShardStem(static_cast<int>(i)) + ".index.json"));
  }
  return shards;
}

std::vector<Stored> ReadEpisodes(const DatasetEpisodes& chosen, std::optional<RobotModel>& robot,
                                 std::vector<std::string>& faults) {
  std::vector<Stored> episodes;
  for (const fs::path& path : ShardsOf(chosen)) {
    const ShardReader shard(path);
    for (std::size_t i = 0; i < shard.index().episodes.size(); ++i) {
      if (episodes.size() >= static_cast<std::size_t>(chosen.most)) return episodes;
      if (!chosen.key.empty() && shard.index().episodes[i].key != chosen.key) continue;
      try {
        episodes.push_back(ReadStored(shard, i, chosen.robot, robot));
      } catch (const Error& error) {
        if (error.code() != ErrorCode::kInvalidArgument) throw;
        faults.emplace_back(error.what());
      }
    }
  }
  return episodes;
}

}  // namespace

ViewPage MakeDatasetPage(const DatasetEpisodes& chosen) {
  Require(chosen.most >= 1 && chosen.points >= 0, ErrorCode::kInvalidArgument,
          "view: at least one episode, and no negative number of points");
  std::optional<RobotModel> robot;
  ViewPage page;
  std::vector<Stored> episodes = ReadEpisodes(chosen, robot, page.faults);
  if (episodes.empty())
    throw Error(ErrorCode::kMissing, page.faults.empty()
                                         ? chosen.dataset.string() + ": no such episode"
                                         : page.faults.front());
  internal::DoorFinder doors(chosen.doors, chosen.threads);
  EpisodeWriter writer(*robot, chosen.points);
  std::optional<internal::FilmForces> forces;
  if (!chosen.films.empty()) forces.emplace(chosen.films, *robot);
  for (Stored& episode : episodes) {
    const auto door = doors.Find(episode.scene.door_sha256);
    if (!door) {
      page.faults.push_back(
          episode.film.title +
          ": its door is not in the folders given with --doors, or has changed since");
      continue;
    }
    PoseDoor(**door, episode.film);
    if (forces) {
      std::string fault = forces->AddTo(episode.film, episode.scene, episode.states);
      if (!fault.empty()) page.faults.push_back(std::move(fault));
    }
    writer.Add(**door, episode.scene.door_sha256, episode.film);
  }
  if (writer.size() == 0) throw Error(ErrorCode::kMissing, page.faults.front());
  page.shown = writer.size();
  page.html = internal::HtmlPage(
      "Episodes of " + chosen.dataset.filename().string() + " - doorforge", writer.content());
  return page;
}

ViewPage MakeExpertPage(std::span<const fs::path> doors, const ExpertEpisodes& config) {
  const RobotModel robot =
      LoadRobot(config.robot.urdf, RobotBase::kSliders, config.robot.read_mesh);
  struct Made {
    DoorAsset door;
    Film film;
    std::string fault;
  };
  std::vector<Made> made(doors.size());
  Progress progress("opening", doors.size());
  ParallelFor(doors.size(), config.threads, [&](std::size_t i) {
    try {
      made[i].door = ReadDoor(doors[i]);
      made[i].film = internal::FilmOfExpert(made[i].door, robot, config.seed, config.points > 0);
    } catch (const Error& error) {
      made[i].fault = error.what();
    }
    progress.Advance();
  });
  EpisodeWriter writer(robot, config.points);
  ViewPage page;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (made[i].fault.empty())
      writer.Add(made[i].door, doors[i].string(), made[i].film);
    else
      page.faults.push_back(made[i].fault);
  }
  if (writer.size() == 0)
    throw Error(ErrorCode::kInvalidArgument,
                page.faults.empty() ? "view: no door to open" : page.faults.front());
  page.shown = writer.size();
  page.html = internal::HtmlPage("The expert opens doors - doorforge", writer.content());
  return page;
}

}  // namespace doorforge
