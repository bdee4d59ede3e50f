// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/color_source.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Colours as TakePictures() renders those of the policies' camera, with `samples` rays a pixel:
/// for policies that read the colours of clouds. A pure function of the scene, the snapshot and the
/// number of the look. `door` and `robot` must outlive the sources.
ColorSources SceneColors(const DoorAsset& door, const RobotModel& robot, int samples);

}  // namespace doorforge
