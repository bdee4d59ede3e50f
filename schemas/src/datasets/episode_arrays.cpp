// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode_arrays.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/npy.h"
#include "doorforge/schemas/picture_streams.h"

namespace doorforge {
namespace {

// One array of the record, in numbers of type T.
template <class T>
struct TypedColumn {
  EpisodeFeature feature;
  void (*append)(const Decision& decision, std::vector<T>& numbers);
  std::span<const T> EpisodeArrays::*view;
  bool since_the_first_build = true;  // else it may be missing in shards of before

  using Number = T;
};
using Column = std::variant<TypedColumn<float>, TypedColumn<std::uint8_t>, TypedColumn<double>>;

template <class T, class Values>
void AppendAll(const Values& values, std::vector<T>& numbers) {
  numbers.insert(numbers.end(), values.begin(), values.end());
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
void CheckFinite(const std::vector<T>& column, const std::string& name) {
  const bool finite =
      std::all_of(column.begin(), column.end(), [](T value) { return std::isfinite(value); });
  Require(finite, ErrorCode::kInvalidArgument,
          "episode record: a number in " + name + " is not finite");
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

// The arrays, a row each, sorted by name: writer, reader and description follow from it.
const std::vector<Column>& Columns() {
  static const std::vector<Column> kColumns = {
      TypedColumn<float>{
          {"action",
           "<f4",
           {9},
           "m, 1",
           "world",
           "asked-for hand position minus present one (stage grasp: contact point); first two rows "
           "of the target rotation"},
          [](const Decision& decision, auto& numbers) { AppendAll(decision.action, numbers); },
          &EpisodeArrays::action},
      TypedColumn<float>{
          {"cloud",
           "<f4",
           {0, 3},
           "m",
           "world",
           "visible points by farthest point sampling; point 0 is the nearest to the hand"},
          [](const Decision& decision, auto& numbers) { AppendAll(decision.cloud.xyz, numbers); },
          &EpisodeArrays::cloud},
      TypedColumn<float>{
          {"executed",
           "<f4",
           {9},
           "m, 1",
           "world",
           "what the robot was told to do, like action: with noise, or by a learner that action "
           "corrects"},
          [](const Decision& decision, auto& numbers) { AppendAll(decision.executed, numbers); },
          &EpisodeArrays::executed,
          false},
      TypedColumn<float>{
          {"joints", "<f4", {2}, "rad", "", "hinge and handle angle before the action"},
          [](const Decision& decision, auto& numbers) {
            numbers.push_back(static_cast<float>(decision.hinge_rad));
            numbers.push_back(static_cast<float>(decision.handle_rad));
          },
          &EpisodeArrays::joints},
      TypedColumn<std::uint8_t>{
          {"label", "|u1", {0}, "", "", "0 body, 1 handle, 2 frame, 3 robot, 4 other"},
          [](const Decision& decision, auto& numbers) { AppendAll(decision.cloud.label, numbers); },
          &EpisodeArrays::label},
      TypedColumn<float>{
          {"proprio",
           "<f4",
           {32},
           "1, m/s, rad/s, m",
           "world",
           "11 joint positions in [-1, 1], 11 velocities, base xyz, hand xyz, hand quaternion "
           "xyzw"},
          [](const Decision& decision, auto& numbers) {
            AppendAll(decision.proprioception, numbers);
          },
          &EpisodeArrays::proprio},
      TypedColumn<float>{
          {"score",
           "<f4",
           {1},
           "rad",
           "",
           "angle gained by what was executed, of the hinge (stage open) or the handle (stage "
           "handle); stage grasp: the door's final angle"},
          [](const Decision& decision, auto& numbers) {
            numbers.push_back(static_cast<float>(decision.angle_gain_rad));
          },
          &EpisodeArrays::score},
      TypedColumn<double>{
          {"state",
           "<f8",
           {std::tuple_size_v<JointState>},
           "m, rad",
           "",
           "joints before the action: 11 of the robot, hinge, handle, bolt"},
          [](const Decision& decision, auto& numbers) { AppendAll(decision.state, numbers); },
          &EpisodeArrays::state,
          false}};
  return kColumns;
}

// The members hold `decisions` decisions with clouds of `points` points.
std::vector<std::size_t> ShapeOf(const EpisodeFeature& feature, std::size_t decisions,
                                 std::size_t points) {
  std::vector<std::size_t> shape = {decisions};
  for (const std::size_t size : feature.shape) shape.push_back(size == 0 ? points : size);
  return shape;
}

template <class T>
MemberBytes Encoded(const TypedColumn<T>& column, const Episode& episode) {
  std::vector<T> numbers;
  for (const Decision& decision : episode.decisions) column.append(decision, numbers);
  CheckFinite(numbers, column.feature.name);
  const std::size_t points = episode.decisions[0].cloud.label.size();
  return {column.feature.name + ".npy",
          MakeNpy<T>(numbers, ShapeOf(column.feature, episode.decisions.size(), points))};
}

}  // namespace

const std::vector<EpisodeFeature>& EpisodeFeatures() {
  static const std::vector<EpisodeFeature> kFeatures = [] {
    std::vector<EpisodeFeature> features;
    for (const Column& column : Columns())
      features.push_back(std::visit([](const auto& typed) { return typed.feature; }, column));
    return features;
  }();
  return kFeatures;
}

std::vector<MemberBytes> EncodeEpisode(const Episode& episode, const nlohmann::ordered_json& meta,
                                       const std::string& preview_png) {
  CheckEpisode(episode);
  std::vector<MemberBytes> members = {{"meta.json", JsonText(meta, 1) + "\n"}};
  for (const Column& column : Columns())
    members.push_back(
        std::visit([&](const auto& typed) { return Encoded(typed, episode); }, column));
  std::ranges::sort(members, {}, &MemberBytes::name);
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
  for (const Column& column : Columns()) {
    std::visit(
        [&](const auto& typed) {
          using Number = typename std::decay_t<decltype(typed)>::Number;
          const std::string& name = typed.feature.name;
          if (!typed.since_the_first_build && !Has(reader, episode, name + ".npy")) return;
          arrays.*typed.view = ViewArray<Number>(
              reader, episode, name, ShapeOf(typed.feature, arrays.decisions, arrays.points));
        },
        column);
  }
  return arrays;
}

std::span<const std::uint8_t> ViewCloudColors(const ShardReader& reader, std::size_t episode) {
  const std::string name(kCloudColors);
  if (!Has(reader, episode, name + ".npy")) return {};
  const EpisodeArrays arrays = ViewEpisode(reader, episode);
  return ViewArray<std::uint8_t>(reader, episode, name, {arrays.decisions, arrays.points, 3});
}

nlohmann::ordered_json ReadEpisodeMeta(const ShardReader& reader, std::size_t episode) {
  // A copy, whole as it is taken: what is parsed can no longer be cut by another program.
  const std::span<const std::byte> bytes = reader.Read(episode, "meta.json");
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  reader.RequireWhole();
  return ParseJson(text, reader.Describe(episode, "meta.json"));
}

}  // namespace doorforge
