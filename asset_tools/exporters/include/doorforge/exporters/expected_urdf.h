// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge::internal {

/// The model.urdf that belongs beside a door.json; meshes of `door` are not looked at.
UrdfModel ExpectedUrdf(const DoorAsset& door, const DoorFiles& files);

}  // namespace doorforge::internal
