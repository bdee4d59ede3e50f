// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode_arrays.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/npy.h"

namespace doorforge {
namespace {

// Arrays of all decisions, one after the other.
struct Columns {
  std::vector<float> cloud;
  std::vector<std::uint8_t> label;
  std::vector<float> proprio;
  std::vector<float> action;
  std::vector<float> executed;
  std::vector<float> joints;
  std::vector<float> score;
  std::vector<double> state;
};

Columns ColumnsOf(const Episode& episode) {
  Columns columns;
  for (const Decision& decision : episode.decisions) {
    const auto append = [](std::vector<float>& column, const auto& values) {
      column.insert(column.end(), values.begin(), values.end());
    };
    append(columns.cloud, decision.cloud.xyz);
    columns.label.insert(columns.label.end(), decision.cloud.label.begin(),
                         decision.cloud.label.end());
    append(columns.proprio, decision.proprioception);
    append(columns.action, decision.action);
    append(columns.executed, decision.executed);
    columns.joints.push_back(static_cast<float>(decision.hinge_rad));
    columns.joints.push_back(static_cast<float>(decision.handle_rad));
    columns.score.push_back(static_cast<float>(decision.score_rad));
    columns.state.insert(columns.state.end(), decision.state.begin(), decision.state.end());
  }
  return columns;
}

void CheckEpisode(const Episode& episode) {
  Require(!episode.decisions.empty(), ErrorCode::kInvalidArgument, "episode record: no decisions");
  const std::size_t points = episode.decisions[0].cloud.label.size();
  for (const Decision& decision : episode.decisions) {
    const LabelledCloud& cloud = decision.cloud;
    Require(points > 0 && cloud.label.size() == points && cloud.xyz.size() == 3 * points,
            ErrorCode::kInvalidArgument,
            "episode record: clouds are empty, differ in size, or lack labels");
  }
}

template <class T>
void CheckFinite(const std::vector<T>& column, const char* name) {
  const bool finite =
      std::all_of(column.begin(), column.end(), [](T value) { return std::isfinite(value); });
  Require(finite, ErrorCode::kInvalidArgument,
          std::string("episode record: a number in ") + name + " is not finite");
}

template <class T>
std::span<const T> ViewArray(const ShardReader& reader, std::size_t episode,
                             const std::string& name, const std::vector<std::size_t>& shape) {
  const std::string member = name + ".npy";
  const std::string where = reader.Describe(episode, member);
  const NpyView<T> view = ViewNpy<T>(reader.Read(episode, member), where);
  if (view.shape != shape)
    throw Error(ErrorCode::kFormat, where + ": its shape does not fit the episode");
  return view.values;
}

bool Has(const ShardReader& reader, std::size_t episode, std::string_view member) {
  const auto& members = reader.index().episodes[episode].members;
  return std::any_of(members.begin(), members.end(),
                     [&](const ShardMember& known) { return known.name == member; });
}

}  // namespace

const std::vector<EpisodeFeature>& EpisodeFeatures() {
  static const std::vector<EpisodeFeature> kFeatures = {
      {"action",
       "<f4",
       {9},
       "m, 1",
       "world",
       "asked-for hand position minus present one (stage grasp: contact point); first two rows of "
       "the target rotation"},
      {"cloud",
       "<f4",
       {0, 3},
       "m",
       "world",
       "visible points by farthest point sampling; point 0 is the nearest to the hand"},
      {"executed",
       "<f4",
       {9},
       "m, 1",
       "world",
       "what the robot was told to do, like action: with noise, or by a learner that action "
       "corrects"},
      {"joints", "<f4", {2}, "rad", "", "hinge and handle angle before the action"},
      {"label", "|u1", {0}, "", "", "0 body, 1 handle, 2 frame, 3 robot, 4 other"},
      {"proprio",
       "<f4",
       {32},
       "1, m/s, rad/s, m",
       "world",
       "11 joint positions in [-1, 1], 11 velocities, base xyz, hand xyz, hand quaternion xyzw"},
      {"score",
       "<f4",
       {1},
       "rad",
       "",
       "angle gained by what was executed, of the hinge (stage open) or the handle (stage handle); "
       "stage "
       "grasp: the door's final angle"},
      {"state",
       "<f8",
       {std::tuple_size_v<JointState>},
       "m, rad",
       "",
       "joints before the action: 11 of the robot, hinge, handle, bolt"}};
  return kFeatures;
}

std::vector<MemberBytes> EncodeEpisode(const Episode& episode, const nlohmann::ordered_json& meta,
                                       const std::string& preview_png) {
  CheckEpisode(episode);
  const Columns columns = ColumnsOf(episode);
  CheckFinite(columns.cloud, "cloud");
  CheckFinite(columns.proprio, "proprio");
  CheckFinite(columns.action, "action");
  CheckFinite(columns.executed, "executed");
  CheckFinite(columns.joints, "joints");
  CheckFinite(columns.score, "score");
  CheckFinite(columns.state, "state");
  const std::size_t count = episode.decisions.size();
  const std::size_t points = episode.decisions[0].cloud.label.size();
  const auto npy = [](const std::vector<float>& column, const std::vector<std::size_t>& shape) {
    return MakeNpy<float>(column, shape);
  };
  std::vector<MemberBytes> members = {
      {"action.npy", npy(columns.action, {count, 9})},
      {"cloud.npy", npy(columns.cloud, {count, points, 3})},
      {"executed.npy", npy(columns.executed, {count, 9})},
      {"joints.npy", npy(columns.joints, {count, 2})},
      {"label.npy", MakeNpy<std::uint8_t>(columns.label, {count, points})},
      {"meta.json", JsonText(meta, 1) + "\n"},
      {"proprio.npy", npy(columns.proprio, {count, 32})},
      {"score.npy", npy(columns.score, {count, 1})},
      {"state.npy", MakeNpy<double>(columns.state, {count, std::tuple_size_v<JointState>})}};
  if (!preview_png.empty()) members.push_back({"preview.png", preview_png});
  return members;
}

EpisodeArrays ViewEpisode(const ShardReader& reader, std::size_t episode) {
  const std::string where = reader.Describe(episode, "label.npy");
  const auto label = ViewNpy<std::uint8_t>(reader.Read(episode, "label.npy"), where);
  if (label.shape.size() != 2 || label.shape[0] == 0 || label.shape[1] == 0)
    throw Error(ErrorCode::kFormat, where + ": its shape is not decisions x points");
  EpisodeArrays arrays;
  arrays.decisions = label.shape[0];
  arrays.points = label.shape[1];
  arrays.label = label.values;
  const std::size_t count = arrays.decisions;
  arrays.cloud = ViewArray<float>(reader, episode, "cloud", {count, arrays.points, 3});
  arrays.proprio = ViewArray<float>(reader, episode, "proprio", {count, 32});
  arrays.action = ViewArray<float>(reader, episode, "action", {count, 9});
  arrays.joints = ViewArray<float>(reader, episode, "joints", {count, 2});
  arrays.score = ViewArray<float>(reader, episode, "score", {count, 1});
  if (Has(reader, episode, "executed.npy"))
    arrays.executed = ViewArray<float>(reader, episode, "executed", {count, 9});
  if (Has(reader, episode, "state.npy"))
    arrays.state =
        ViewArray<double>(reader, episode, "state", {count, std::tuple_size_v<JointState>});
  return arrays;
}

nlohmann::ordered_json ReadEpisodeMeta(const ShardReader& reader, std::size_t episode) {
  // A copy, whole as it is taken: what is parsed can no longer be cut by another program.
  const std::span<const std::byte> bytes = reader.Read(episode, "meta.json");
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  reader.RequireWhole();
  return ParseJson(text, reader.Describe(episode, "meta.json"));
}

}  // namespace doorforge
