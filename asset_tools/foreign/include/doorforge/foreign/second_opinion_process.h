// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace doorforge::foreign {

/// The body of doorforge-second-opinion: PROGRAM FILE PARENT [LIBRARY], where PROGRAM is
/// "urdfdom", "sdformat" or "mujoco". It gives up its rights (see confined_child.h) before it opens
/// the file, and answers "ok", "no" or "absent", the program's name with its version, and its
/// words, a line each.
int GiveOpinion(std::span<char* const> arguments);

}  // namespace doorforge::foreign
