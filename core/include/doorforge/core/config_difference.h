// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace doorforge {

/// In what two configs differ, for a message: a line a setting, and a pair of lines a comment.
///
///       epochs: recorded 4, given 6
///       cloud.point_count: recorded 1024, given none
///
/// @param recorded, given Configs as programs write them: YAML or JSON, with comments before it
/// that
///     say what else decides the result. What is no YAML counts as its lines.
/// @returns Each line begins with a line break and two blanks; at most 20, then how many there are
///     beyond. Empty if the configs say the same.
std::string ConfigDifference(const std::string& recorded, const std::string& given);

}  // namespace doorforge
