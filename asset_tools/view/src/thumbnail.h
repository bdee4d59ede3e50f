// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/schemas/part.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge::internal {

/// What is drawn in one thumbnail: doors of one body have one for it.
struct Subject {
  std::string key;  ///< Equal for what looks alike.
  std::vector<VisibleMesh> meshes;
  bool stands = true;  ///< On the floor.
};

Subject SubjectOf(const Part& part);

/// A JPEG file, `width` pixels wide and three quarters as high.
std::string DrawSubject(const Subject& subject, int width);

}  // namespace doorforge::internal
