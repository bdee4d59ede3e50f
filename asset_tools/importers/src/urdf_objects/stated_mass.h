// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/mass_properties.h"

#include "urdf_objects/hinged_object.h"
#include "urdf_objects/joint_tree.h"

namespace doorforge::internal {

/// What a source says that a piece weighs.
struct StatedMass {
  std::optional<MassProperties> mass;  ///< In the piece's frame.
  std::string problem;                 ///< Why it is not taken; empty where nothing is stated.
};

/// The links that a piece consists of, as a source states them.
struct StatedLinks {
  std::vector<std::size_t> links;                                 ///< Into UrdfModel::links.
  std::vector<bool> has_shape;                                    ///< By link.
  Eigen::Affine3d piece_from_base = Eigen::Affine3d::Identity();  ///< Without scale.
  Eigen::AlignedBox3d bounds;                                     ///< Of the piece's meshes.
};

/// The masses of the links as one, if every link with a shape states one and they can be meant: a
/// mass above 0 that makes 0.05 to 20,000 kg/m3 of the box, a centre at most 0.1 m outside it,
/// moments above 0 that no more than sum to each other, and a radius of gyration of 0.001 to 2
/// times the diagonal: the limits of INR001 to INR009.
StatedMass StatedMassOf(const HingedObject& object, const std::vector<TreeLink>& tree,
                        const StatedLinks& links);

}  // namespace doorforge::internal
