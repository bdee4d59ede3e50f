// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/parts/grasp.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"
#include "doorforge/validate/validate_door.h"

namespace doorforge::internal {

using Findings = std::vector<Finding>;

const ValidationRule& RuleOf(std::string_view code);
double LimitOf(std::string_view code);

/// Four significant digits.
std::string Number(double value);

/// The rule's `allowed` with its limit in place.
std::string AllowedBy(const ValidationRule& rule);

/// A finding of a rule: severity, allowed and fix are the rule's.
Finding Found(std::string_view code, const std::string& where, const std::string& measured);

/// MSH005 to MSH007 and COL: one piece. `where` of the findings begins after the piece's name.
struct CheckedPiece {
  const TriangleMesh& mesh;
  const std::vector<const TriangleMesh*>& hulls;
  bool is_handle = false;
};
Findings CheckPiece(const CheckedPiece& piece);

/// INR: `bounds` and volume are those of the link's meshes, in the frame of `mass`.
struct CheckedMass {
  std::string where;
  const MassProperties& mass;
  Eigen::AlignedBox3d bounds = {};  ///< Empty where no mesh could be read.
  double volume_m3 = 0;             ///< Signed.
};
Findings CheckMass(const CheckedMass& checked);

/// MEC.
Findings CheckMechanics(const DoorAsset& door);
/// MEC001 to MEC003 for the joint of a part.
Findings CheckPartJoint(const Part& part);

/// URD: model.urdf in the folder against the door.
Findings CheckUrdf(const DoorAsset& door, const DoorFiles& files,
                   const std::filesystem::path& folder);

/// HND. Both need meshes; what is empty is left out. `leaf` is the leaf's without the handle; `fit`
/// measures the door's grasp and is asked where the rules need it, its tip clearance counts for
/// nothing.
struct LeafLines;
using GraspMeasure = std::function<GraspFit()>;
Findings CheckHandle(const DoorAsset& door, const LeafLines& leaf, const GraspMeasure& fit);
Findings CheckPartGrasp(const Part& part);

/// LIC.
Findings CheckLicense(const std::string& license, const std::string& where);

}  // namespace doorforge::internal
