// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Parts of an episode's meta.json beside EpisodeMetaToJson().
nlohmann::ordered_json CameraRecord(const CameraModel& camera);
nlohmann::ordered_json DoorRecord(const DoorAsset& door);

/// Poses of door and robot as matrices, which read back bit by bit; quaternions do not.
nlohmann::ordered_json PosesRecord(const Scene& scene);
/// Puts the poses of meta.json's "poses" into the scene. Throws Error(kFormat).
void ReadPoses(const nlohmann::ordered_json& meta, const std::string& path, Scene& scene);

}  // namespace doorforge
