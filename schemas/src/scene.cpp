// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/scene.h"

#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"
#include "doorforge/core/json_file.h"

#include "latch_json.h"

namespace doorforge {

nlohmann::ordered_json SceneToJson(const Scene& scene) {
  return {{"door_id", scene.door_id},
          {"door_sha256", scene.door_sha256},
          {"seed", scene.seed},
          {"episode", scene.episode},
          {"world_from_door", TransformToJson(scene.world_from_door)},
          {"world_from_robot_base", TransformToJson(scene.world_from_robot_base)},
          {"latch", internal::LatchToJson(scene.latch)},
          {"grasp_from_noisy_grasp", TransformToJson(scene.grasp_from_noisy_grasp)},
          {"physics", ToJson(scene.physics)},
          {"camera", CameraToJson(scene.camera)}};
}

Scene SceneFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  const auto transform = [&](const char* key) {
    return TransformFromJson(MemberOf(json, key, path), path + "." + key);
  };
  Scene scene;
  scene.door_id = ValueOf<std::string>(json, "door_id", path);
  scene.door_sha256 = ValueOf<std::string>(json, "door_sha256", path);
  scene.seed = ValueOf<std::uint64_t>(json, "seed", path);
  scene.episode = ValueOf<std::uint64_t>(json, "episode", path);
  scene.world_from_door = transform("world_from_door");
  scene.world_from_robot_base = transform("world_from_robot_base");
  scene.latch = internal::LatchFromJson(MemberOf(json, "latch", path), path + ".latch");
  scene.grasp_from_noisy_grasp = transform("grasp_from_noisy_grasp");
  Assign(MemberOf(json, "physics", path), scene.physics, path + ".physics");
  scene.camera = CameraFromJson(MemberOf(json, "camera", path), path + ".camera");
  return scene;
}

}  // namespace doorforge
