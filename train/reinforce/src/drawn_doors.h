// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "doorforge/physics/robot_model.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/schemas/door_set.h"

namespace doorforge::internal {

/// A door and a scene with it.
struct DrawnDoor {
  IdentifiedDoor door;
  Scene scene;
};

/// Doors from which episodes draw, with the hand that flies. Immutable but for the cache, which may
/// be used by several threads.
class DrawnDoors {
 public:
  /// @param stream Episode n draws from "<stream>/<n>" of the seed.
  /// @throws Error(kInvalidArgument) without doors; Error(kInvalidConfig) on a robot that is not
  ///     the built-in one, naming `stream` up to its first slash.
  DrawnDoors(const std::vector<FoundDoor>& doors, const SceneConfig& scene, std::uint64_t seed,
             std::string stream);

  /// Draws a category, then one of its doors, and samples the scene of this episode.
  DrawnDoor At(std::uint64_t episode);
  IdentifiedDoor First() { return cache_.Take(0); }
  const RobotModel& robot() const { return robot_; }

 private:
  std::size_t Draw(std::uint64_t episode) const;

  SceneConfig scene_;
  std::uint64_t seed_;
  std::string stream_;
  RobotModel robot_;
  DoorCache cache_;
  std::vector<std::vector<std::size_t>> by_category_;
};

}  // namespace doorforge::internal
