// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "doorforge/schemas/door_identity.h"

namespace doorforge {

/// Draws at most `per_category` doors of each category, so that every handle and every body is
/// tried as evenly as that number allows. What is drawn of N doors is the beginning of what is
/// drawn of more.
///
/// Where every body of a category occurs with every handle, as in a catalogue, no handle is drawn
/// more than once more often than another, and no body: they are dealt in turn, and once all turns
/// meet again the handles are moved on by one, a Latin design. Handles are dealt so that the first
/// few are spread over mechanisms and families. Elsewhere each draw takes one of the handles that
/// were drawn least and are left, with the body that was drawn least.
///
/// @return Indices into `doors`, ascending. A function of the doors' identities; their order does
///     not matter, but for doors of one id, of which the first comes first.
std::vector<std::size_t> DrawDoors(std::span<const DoorIdentity> doors, std::size_t per_category);

}  // namespace doorforge
