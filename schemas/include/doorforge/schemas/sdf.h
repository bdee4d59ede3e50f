// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// Parses the one model of an SDF (http://sdformat.org/spec, 1.7 and later) into the value that a
/// URDF gives, with the limits of ReadUrdf() and faults as there.
///
/// A link's frame is that of the joint that moves it. Poses are resolved along `relative_to` and
/// `attached_to`, axes along `expressed_in`. A joint whose parent is the world is left out where
/// its child is the root. Boxes, cylinders, spheres and meshes are read, other shapes are left out
/// with a fault of kind kUnstated. <include>, nested models, several models and joints other than
/// fixed, revolute, continuous and prismatic are kUnusable. Mesh names keep their "model://".
UrdfModel ParseSdf(const std::string& text, const std::string& name,
                   std::vector<UrdfFault>& faults);
UrdfModel ReadSdf(const std::filesystem::path& path, std::vector<UrdfFault>& faults);

}  // namespace doorforge
