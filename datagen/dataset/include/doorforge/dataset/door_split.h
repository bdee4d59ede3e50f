// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "doorforge/schemas/part_identity.h"

namespace doorforge {

/// What decides on which side of a split a door lies. Parts are told apart as by
/// PartIdentity::SameAs().
struct DoorParts {
  std::string door_id;
  std::string category;
  std::string mechanism;
  PartIdentity body;
  PartIdentity handle;
};

enum class DoorSide { kTrain, kVal };

/// Divides doors so that no body and no handle is on both sides.
///
/// Doors that share a part, directly or through others, form a group that stays together. In random
/// order, groups move to the validation side while it holds less than `val_fraction` of the doors
/// of their category and mechanism, and while the training side keeps at least half of these. A
/// catalogue in which every body meets every handle is one group: then all doors train, and the
/// validation side is empty.
///
/// @param val_fraction Wanted share of the validation side, in [0, 0.5].
/// @return One side a door. A pure function of the arguments; the order of the doors does not
///     matter.
/// @throws Error(kInvalidArgument) if val_fraction is out of range or an id occurs twice.
std::vector<DoorSide> SplitDoors(std::span<const DoorParts> doors, double val_fraction,
                                 std::uint64_t seed);

}  // namespace doorforge
