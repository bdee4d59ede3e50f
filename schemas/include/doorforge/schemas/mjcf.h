// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// Parses a MuJoCo model (MJCF, https://mujoco.readthedocs.io/en/stable/XMLreference.html) into the
/// value that a URDF gives, with the limits of ReadUrdf() and faults as there.
///
/// A link is a body, its frame at the body's last joint. A body of several joints gives links
/// between them. The root is the one body without a joint that the world holds, or else "world".
/// Geoms that touch nothing (contype and conaffinity 0) are visuals, all others collisions; boxes,
/// cylinders, spheres and meshes from files are read, other geoms are left out with a fault of
/// kind kUnstated. Defaults, classes, angles in degrees and every way of orientation are resolved.
/// Equalities between joints become mimics. <include>, <attach>, <replicate>, ball joints and
/// meshes that move their own frame (refpos, refquat) are kUnusable. MJCF names no effort and no
/// velocity limits.
UrdfModel ParseMjcf(const std::string& text, const std::string& name,
                    std::vector<UrdfFault>& faults);
UrdfModel ReadMjcf(const std::filesystem::path& path, std::vector<UrdfFault>& faults);

}  // namespace doorforge
