// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Numbers by which copies of a shape are found whatever their size, place and triangles: the
/// extents of the bounding box over its diagonal (3), then the integrals over the volume of 1 (1),
/// x (3) and x x^T (6: xx, xy, xz, yy, yz, zz) in coordinates in which the box is a unit cube
/// around the origin, as magnitudes, so that a mirrored copy has the same numbers. No unit; each
/// rounded to 1e-6. Empty where the shape is not known: without triangles, and in records of
/// earlier versions.
using ShapeDescriptor = std::vector<double>;

/// Describes all meshes together; overlaps count twice. Deterministic.
ShapeDescriptor DescribeShape(std::span<const TriangleMesh> meshes);

/// Whether one is a copy of the other, at another size or mirrored: no number differs by more than
/// 0.0015. Copies that were repaired apart differ by up to 0.0008, different parts of the paper's
/// data set and of the catalogue by 0.0033 and more. An unknown shape is the same as none.
bool SameShape(const ShapeDescriptor& a, const ShapeDescriptor& b);

/// The member "shape" of a record, or an unknown shape if it has none. Throws Error(kFormat).
ShapeDescriptor ShapeOfRecord(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge
