// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "drawn_doors.h"

#include <map>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/rollout/base_placement.h"

namespace doorforge::internal {
namespace {

// Nothing is loaded for a request that is wrong.
const SceneConfig& CheckedScene(const SceneConfig& scene, std::size_t doors,
                                const std::string& stream) {
  const std::string name = stream.substr(0, stream.find('/'));
  Require(doors > 0, ErrorCode::kInvalidArgument, name + ": there are no doors to learn on");
  Require(scene.robot.empty(), ErrorCode::kInvalidConfig,
          "config.scene.robot: " + name + " knows the built-in robot's hand, found \"" +
              scene.robot + '"');
  return scene;
}

}  // namespace

DrawnDoors::DrawnDoors(const std::vector<FoundDoor>& doors, const SceneConfig& scene,
                       std::uint64_t seed, std::string stream)
    : scene_(CheckedScene(scene, doors.size(), stream)),
      seed_(seed),
      stream_(std::move(stream)),
      robot_(LoadRobot({}, scene.physics.base)),
      cache_(doors) {
  std::map<Category, std::vector<std::size_t>> sorted;
  for (std::size_t i = 0; i < doors.size(); ++i) sorted[doors[i].identity.category].push_back(i);
  for (auto& [category, of_it] : sorted) by_category_.push_back(std::move(of_it));
}

std::size_t DrawnDoors::Draw(std::uint64_t episode) const {
  Rng rng(seed_, stream_ + "/" + std::to_string(episode));
  const auto& category = by_category_[rng.Index(static_cast<std::uint32_t>(by_category_.size()))];
  return category[rng.Index(static_cast<std::uint32_t>(category.size()))];
}

DrawnDoor DrawnDoors::At(std::uint64_t episode) {
  IdentifiedDoor door = cache_.Take(Draw(episode));
  Scene scene = PlaceRobotBase(robot_, SampleScene(door, seed_, episode, scene_), *door);
  return {std::move(door), std::move(scene)};
}

}  // namespace doorforge::internal
