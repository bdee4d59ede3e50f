// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/scene.h"

#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"
#include "doorforge/core/json_file.h"

#include "doors/latch_json.h"

namespace doorforge {
namespace {

void Scale(MassProperties& mass, double factor) {
  mass.mass_kg *= factor;
  mass.inertia_kg_m2 *= factor;
}

// Records of before do not have these, and those that follow the defaults shall not change.
nlohmann::ordered_json PhysicsToJson(const PhysicsConfig& physics) {
  const PhysicsConfig standard;
  nlohmann::ordered_json json = ToJson(physics);
  if (physics.max_handle_actions == standard.max_handle_actions) json.erase("max_handle_actions");
  if (physics.base == standard.base) json.erase("base");
  if (physics.controller == standard.controller) json.erase("controller");
  if (physics.operational_space == standard.operational_space) json.erase("operational_space");
  if (physics.hand_force_n == standard.hand_force_n) json.erase("hand_force_n");
  return json;
}

}  // namespace

DoorAsset ApplyVariation(const DoorAsset& door, const DoorVariation& variation) {
  DoorAsset varied = door;
  Scale(varied.links[kLeafLink].mass, variation.leaf_mass);
  Scale(varied.links[kHandleLink].mass, variation.handle_mass);
  varied.hinge.damping_nm_s *= variation.hinge_damping;
  varied.handle_joint.damping_nm_s *= variation.handle_damping;
  return varied;
}

nlohmann::ordered_json SceneToJson(const Scene& scene) {
  nlohmann::ordered_json json = {
      {"door_id", scene.door_id},
      {"door_sha256", scene.door_sha256},
      {"seed", scene.seed},
      {"episode", scene.episode},
      {"world_from_door", TransformToJson(scene.world_from_door)},
      {"world_from_robot_base", TransformToJson(scene.world_from_robot_base)},
      {"latch", internal::LatchToJson(scene.latch)},
      {"variation", ToJson(scene.variation)},
      {"arm_start_offset_rad", scene.arm_start_offset_rad},
      {"grasp_from_noisy_grasp", TransformToJson(scene.grasp_from_noisy_grasp)},
      {"physics", PhysicsToJson(scene.physics)},
      {"camera", CameraToJson(scene.camera)}};
  if (scene.appearance != SceneAppearance::kOff) json["appearance"] = NameOf(scene.appearance);
  if (scene.limits != EpisodeLimits{}) json["episode_limits"] = ToJson(scene.limits);
  if (scene.robot != RobotIdentity{})
    json["robot"] = {{"name", scene.robot.name}, {"sha256", scene.robot.sha256}};
  return json;
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
  if (json.contains("robot")) {
    const auto& robot = json["robot"];
    scene.robot = {ValueOf<std::string>(robot, "name", path + ".robot"),
                   ValueOf<std::string>(robot, "sha256", path + ".robot")};
  }
  scene.latch = internal::LatchFromJson(MemberOf(json, "latch", path), path + ".latch");
  if (json.contains("variation")) {  // scenes of before had none
    Assign(json["variation"], scene.variation, path + ".variation");
    Assign(MemberOf(json, "arm_start_offset_rad", path), scene.arm_start_offset_rad,
           path + ".arm_start_offset_rad");
  }
  scene.grasp_from_noisy_grasp = transform("grasp_from_noisy_grasp");
  Assign(MemberOf(json, "physics", path), scene.physics, path + ".physics");
  if (json.contains("appearance"))
    Assign(json["appearance"], scene.appearance, path + ".appearance");
  if (json.contains("episode_limits"))
    Assign(json["episode_limits"], scene.limits, path + ".episode_limits");
  scene.camera = CameraFromJson(MemberOf(json, "camera", path), path + ".camera");
  return scene;
}

}  // namespace doorforge
