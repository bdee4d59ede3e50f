// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/schemas/part.h"

namespace doorforge {

/// Why a drawn part may not enter the catalogue, empty if it may: its size, its reach and its
/// leaf's mass must lie in the ranges of docs/catalogue.md, each piece needs 32 hulls at most, and
/// a handle must be held at its grasp frame with the space behind it free.
std::string FaultOf(const Part& part);

/// Returns the fault that takes longer to find: hulls that leave the surface uncovered or stand out
/// of it, and a leaf that does not swing free of its frame.
std::string SlowFaultOf(const Part& part);

}  // namespace doorforge
